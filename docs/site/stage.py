#!/usr/bin/env python3
"""Builds the documentation's site: lays the pages of the repository out for Sphinx, and calls Doxygen and Sphinx.

usage: stage.py REPOSITORY OUTPUT [--python FOLDER]

The pages are those of the repository as they are, README.md, CHANGELOG.md, docs/ and so on, under the same names, so that their links hold.
Links to files that are no pages lead to copies of these, links to folders become plain text. OUTPUT/html/index.html is the site: it opens
from the disk and asks no network for anything. Where Doxygen is installed it has the library's reference; with --python, a folder in which
`import snare` finds the built module, Python's. A warning of Sphinx is an error.
"""

import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys

PAGES = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "benchmarks/README.md"]
MATHJAX = pathlib.Path("/usr/share/javascript/mathjax")
MATHJAX_PARTS = ["MathJax.js", "config/TeX-AMS_SVG.js", "extensions", "jax/element", "jax/input/TeX", "jax/output/SVG"]
HEADERS = ["base", "numerics", "study", "wire", "multibody", "coupling", "scenario", "reduction", "identification", "validation", "results", "papers"]
LINK = re.compile(r"(!?\[[^\]]*\])\(([^)\s#]+)(#[^)\s]*)?\)")
INDEX = """# snare

```{toctree}
:maxdepth: 1
:caption: Begin

README
docs/tutorial
docs/README
```

```{toctree}
:maxdepth: 1
:caption: How to
:glob:

docs/how_to/*
```

```{toctree}
:maxdepth: 1
:caption: Files that are read

docs/experiment_file
docs/wire_file
docs/scenario_file
docs/arm_files
docs/record_file
docs/ringdown_file
docs/sweep_file
```

```{toctree}
:maxdepth: 1
:caption: Results

docs/curves_csv
docs/trace_json
docs/reproduce_json
docs/law_json
docs/table_csv
docs/summary_json
docs/result_fields
docs/other_programs
docs/effects
```

```{toctree}
:maxdepth: 1
:caption: Programs

docs/examples
docs/python
library
python_reference
```

```{toctree}
:maxdepth: 1
:caption: What is computed

docs/theory
```

```{toctree}
:maxdepth: 1
:hidden:
:glob:

docs/theory/*
```

```{toctree}
:maxdepth: 1
:caption: About
:glob:

docs/promises
CONTRIBUTING
CHANGELOG
benchmarks/README
docs/decisions/*
OTHERS
```
"""
LIBRARY = """# Library

[The reference of all headers](HTML) is made by Doxygen from their comments: every room is a folder. [CONTRIBUTING](CONTRIBUTING.md) has the map
of the rooms, [README](README.md) a first program.
"""
NO_LIBRARY = "# Library\n\nDoxygen was not there when this site was built; the comments stand in the headers.\n"
PYTHON = """# Python reference

```{eval-rst}
.. automodule:: snare
   :members:
   :imported-members:

.. automodule:: snare.plot
   :members:
```
"""
NO_PYTHON = "# Python reference\n\nThe module was not built when this site was. [Python](docs/python.md) says how it is, and `help(snare)` has all of it.\n"
DOXYFILE = """PROJECT_NAME = snare
INPUT = {inputs}
RECURSIVE = YES
FILE_PATTERNS = *.hpp
STRIP_FROM_PATH = {root}
OUTPUT_DIRECTORY = {out}
HTML_OUTPUT = library
GENERATE_LATEX = NO
GENERATE_HTML = YES
EXTRACT_ALL = YES
MARKDOWN_SUPPORT = NO
SEARCHENGINE = NO
QUIET = YES
WARNINGS = NO
HAVE_DOT = NO
DISABLE_INDEX = NO
FULL_SIDEBAR = NO
BUILTIN_STL_SUPPORT = YES
"""


def pages_of(root):
    return [root / p for p in PAGES] + sorted((root / "docs").rglob("*.md"))


def staged(page, root, stage, pages):
    """The text of a page as Sphinx reads it; what its links lead to is copied beside."""
    def link(match):
        text, target, anchor = match.group(1), match.group(2), match.group(3) or ""
        if re.match(r"[a-z]+:", target):
            return match.group(0)
        path = (page.parent / target).resolve()
        if path.is_dir():
            index = path / "README.md"
            if index in pages:
                return f"{text}({os.path.relpath(index, page.parent)})"
            return text[1:-1] if not text.startswith("!") else match.group(0)
        if path.suffix == ".md" or not path.is_file():
            return match.group(0)
        inside = path.relative_to(root)
        if text.startswith("!"):
            copy(path, stage / inside)
            return match.group(0)
        copy(path, stage / "extra" / "files" / inside)
        depth = "../" * len(page.relative_to(root).parent.parts)
        # As HTML: to Sphinx the copy is no page.
        return f'<a href="{depth}files/{inside.as_posix()}{anchor}">{text[1:-1].replace("`", "")}</a>'

    lines, fenced = [], False
    for one in page.read_text(encoding="utf-8").splitlines():
        if one.lstrip().startswith("```"):
            fenced = not fenced
        lines.append(one if fenced else LINK.sub(link, one))
    return "\n".join(lines) + "\n"


def copy(source, target):
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source, target)


def lay_out(root, stage, python):
    shutil.rmtree(stage, ignore_errors=True)
    pages = pages_of(root)
    for page in pages:
        target = stage / page.relative_to(root)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(staged(page, root, stage, pages), encoding="utf-8")
    (stage / "extra").mkdir(exist_ok=True)
    for part in MATHJAX_PARTS:
        source, target = MATHJAX / part, stage / "_static/mathjax" / part
        if source.is_dir():
            shutil.copytree(source, target)
        else:
            copy(source, target)
    others = [p for p in pages if p.parent == root / "docs" and f"docs/{p.stem}" not in INDEX]
    (stage / "index.md").write_text(INDEX.replace("OTHERS", "\n".join(f"docs/{p.stem}" for p in others)), encoding="utf-8")
    (stage / "python_reference.md").write_text(PYTHON if python else NO_PYTHON, encoding="utf-8")
    copy(root / "docs/site/conf.py", stage / "conf.py")


def library_reference(root, stage, work):
    """Doxygen's pages in the site, and the page that leads to them."""
    if not shutil.which("doxygen"):
        (stage / "library.md").write_text(NO_LIBRARY, encoding="utf-8")
        return
    work.mkdir(parents=True, exist_ok=True)
    (work / "Doxyfile").write_text(DOXYFILE.format(inputs=" ".join(str(root / h) for h in HEADERS), root=root, out=stage / "extra"), encoding="utf-8")
    subprocess.run(["doxygen", str(work / "Doxyfile")], check=True)
    text = LIBRARY.replace("[The reference of all headers](HTML)", '<a href="library/index.html">The reference of all headers</a>')
    (stage / "library.md").write_text(text, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("repository", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--python", type=pathlib.Path)
    arguments = parser.parse_args()
    root, output = arguments.repository.resolve(), arguments.output.resolve()
    if not MATHJAX.is_dir():
        print("docs: MathJax is not there; on Debian: apt-get install libjs-mathjax", file=sys.stderr)
        return 1
    stage = output / "stage"
    lay_out(root, stage, arguments.python)
    library_reference(root, stage, output / "doxygen")
    environment = dict(os.environ)
    if arguments.python:
        environment.update(SNARE_PYTHON_REFERENCE="1", PYTHONPATH=str(arguments.python.resolve()))
    shutil.rmtree(output / "html", ignore_errors=True)
    # Debian's Python, whatever comes first on PATH: the one that has Debian's Sphinx.
    return subprocess.run(["/usr/bin/python3", "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html", "-d", str(output / "doctrees"),
                           str(stage), str(output / "html")], env=environment).returncode


if __name__ == "__main__":
    sys.exit(main())
