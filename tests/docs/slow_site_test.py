#!/usr/bin/env python3
"""Builds the site, a warning being an error, and looks through it: every link and anchor leads somewhere, nothing is asked of a network.

usage: slow_site_test.py REPOSITORY

Needs Debian's python3-sphinx, python3-myst-parser, python3-sphinx-rtd-theme and libjs-mathjax; skipped, saying so, where they are absent. With
chromium the formulas of a page are drawn too.
"""

import html.parser
import importlib.util
import pathlib
import shutil
import subprocess
import sys
import tempfile
import urllib.parse

SKIPPED = 77
NEEDED = ["sphinx", "myst_parser", "sphinx_rtd_theme"]


class Page(html.parser.HTMLParser):
    """Links, names and what is loaded, of a page."""

    def __init__(self, path):
        super().__init__()
        self.links, self.names, self.loaded = [], set(), []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        has = dict(attrs)
        self.names.update(has[k] for k in ("id", "name") if has.get(k))
        if tag == "a" and has.get("href"):
            self.links.append(has["href"])
        if tag in ("script", "img", "iframe", "source") and has.get("src"):
            self.loaded.append(has["src"])
        if tag == "link" and has.get("href") and "stylesheet" in has.get("rel", ""):
            self.loaded.append(has["href"])


def problems_of(site):
    pages = {path: Page(path) for path in site.rglob("*.html") if "_static" not in path.parts and "library" not in path.relative_to(site).parts}
    for path, page in pages.items():
        where = path.relative_to(site)
        for target in page.loaded:
            if urllib.parse.urlsplit(target).netloc:
                yield f"{where}: asks the network for {target}"
            elif not target.startswith("data:") and not (path.parent / urllib.parse.unquote(target.split("?")[0])).is_file():
                yield f"{where}: {target} is missing"
        for target in page.links:
            parts = urllib.parse.urlsplit(target)
            if parts.scheme or parts.netloc:
                continue
            to = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            if not to.exists():
                yield f"{where}: {target} leads nowhere"
            elif parts.fragment and to in pages and urllib.parse.unquote(parts.fragment) not in pages[to].names:
                yield f"{where}: {target} has no such place"
    reached, ahead = set(), [site / "index.html"]
    while ahead:
        path = ahead.pop()
        if path in reached or path not in pages:
            continue
        reached.add(path)
        ahead += [(path.parent / urllib.parse.unquote(t.split("#")[0])).resolve() for t in pages[path].links if t.split("#")[0] and ":" not in t]
    made = {site / name for name in ("genindex.html", "py-modindex.html", "search.html")}  # by Sphinx: reached by the search field
    for path in set(pages) - reached - made:
        yield f"{path.relative_to(site)}: cannot be reached from index.html"


def undrawn(site):
    """Whether the formulas of a page are left as they were written; None without a browser."""
    if not shutil.which("chromium"):
        return None
    shown = subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=30000", "--dump-dom",
                            (site / "docs/theory/studies.html").as_uri()], capture_output=True, text=True, timeout=300)
    return shown.stdout.count('class="MathJax_SVG"') < 5


def main():
    absent = [name for name in NEEDED if importlib.util.find_spec(name) is None]
    if absent or not pathlib.Path("/usr/share/javascript/mathjax").is_dir():
        print(f"skipped: not installed: {', '.join(absent) or 'libjs-mathjax'}; apt-get install python3-sphinx python3-myst-parser "
              "python3-sphinx-rtd-theme libjs-mathjax doxygen")
        return SKIPPED
    root = pathlib.Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-B", str(root / "docs/site/stage.py"), str(root), folder]
        module = root / "build/release/python"
        if list(module.glob("snare/_core*.so")):
            command += ["--python", str(module)]
        if subprocess.run(command).returncode != 0:
            return 1
        site = pathlib.Path(folder).resolve() / "html"
        problems = sorted(set(problems_of(site)))
        if undrawn(site):
            problems.append("docs/theory/studies.html: formulas are not drawn")
        for problem in problems:
            print(problem)
        return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
