#!/usr/bin/env python3
"""Every picture in docs/ has a script that makes it or is drawn by hand without numbers, and stands on a page.

usage: pictures_test.py REPOSITORY
"""

import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1]).resolve()
sys.path.insert(0, str(root / "scripts"))

import shipped  # noqa: E402
from results_pages import Stored, pictures  # noqa: E402


def main():
    stored = {str(p.relative_to(root)) for p in (root / "docs").rglob("*") if p.suffix in (".png", ".svg", ".jpg", ".gif")}
    effects = {name for name in stored if name.startswith("docs/drawings/effects/")}  # scripts/effect_glossary.py --check
    made = {path for maker in shipped.MAKERS.values() for path in maker.files if path.startswith("docs/")}
    made |= set(pictures(Stored(root / "benchmarks/results"))) | shipped.DRAWN_BY_HAND
    pages = [root / "README.md", *(root / "docs").rglob("*.md")]
    shown = {str((page.parent / target).resolve().relative_to(root)) for page in pages
             for target in re.findall(r"!\[[^\]]*\]\(([^):]+)\)", page.read_text(encoding="utf-8"))}
    found = [f"{path}: no script makes it; scripts/shipped.py has the makers" for path in sorted(stored - effects - made)]
    found += [f"{path}: is made and not stored" for path in sorted(made - stored)]
    found += [f"{path}: stands on no page" for path in sorted(stored - shown)]
    tested = (root / "tests/shipped/CMakeLists.txt").read_text(encoding="utf-8")
    found += [f"{name}: tests/shipped/CMakeLists.txt does not run it" for name, maker in shipped.MAKERS.items()
              if not maker.long and not re.search(rf"\b{name}\b", tested)]
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
