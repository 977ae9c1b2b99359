#!/usr/bin/env python3
"""Checks that README.md stays a front page.

usage: front_page.py REPOSITORY

- At most 900 words outside code blocks.
- Numbers stand only in regions that scripts/results_pages.py writes from stored results, in code blocks and in inline code.
  Names that have a digit (NAMES) are no numbers.
- The regions of README.md and docs/results/ are what the stored results give.
- CITATION.cff has the version of the project.

Prints one line per problem and exits 1 if there is any.
"""

import pathlib
import re
import subprocess
import sys

MOST_WORDS = 900
NAMES = ("Debian 12", "x86-64", "version 3")
CODE = re.compile(r"^```.*?^```$", re.M | re.S)
REGION = re.compile(r"<!-- numbers: [a-z_]+ -->.*?<!-- end of numbers -->", re.S)


def words(text):
    return len(CODE.sub("", text).split())


def loose_numbers(text):
    """Numbers outside regions, code and the targets of links."""
    prose = re.sub(r"\]\([^)]*\)|`[^`]*`|<!--.*?-->", "", REGION.sub("", CODE.sub("", text)))
    for name in NAMES:
        prose = prose.replace(name, "")
    return re.findall(r"\d+(?:[.,]\d+)*", prose)


def problems(root):
    text = (root / "README.md").read_text(encoding="utf-8")
    found = []
    if words(text) > MOST_WORDS:
        found.append(f"README.md: {words(text)} words, must be at most {MOST_WORDS}")
    found += [f"README.md: the number {n} comes from no stored result" for n in loose_numbers(text)]
    stale = subprocess.run([sys.executable, "-B", root / "scripts/results_pages.py", "--check", root], capture_output=True, text=True)
    if stale.returncode != 0:
        found.append(stale.stdout + stale.stderr + "scripts/results_pages.py writes it again")
    version = re.search(r"project\(snare VERSION ([\d.]+)", (root / "CMakeLists.txt").read_text(encoding="utf-8")).group(1)
    if f"\nversion: {version}\n" not in (root / "CITATION.cff").read_text(encoding="utf-8"):
        found.append(f"CITATION.cff: the version must be {version}")
    return found


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    found = problems(pathlib.Path(sys.argv[1]).resolve())
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
