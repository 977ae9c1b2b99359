#!/usr/bin/env python3
"""Checks that clang-format, with the settings of .clang-format, would change no source of the repository, and that no line is longer
than its limit, comments included. Text in other languages (raw strings) may be.

usage: formatting.py REPOSITORY [--fix]

Prints one line per place, `file:line: ...`, and exits 1 if there is any. --fix: formats the files instead.
"""

import pathlib
import re
import subprocess
import sys

FOLDERS = ("base", "numerics", "wire", "multibody", "coupling", "scenario", "reduction", "identification", "validation",
           "results", "papers", "study", "app", "python", "benchmarks", "examples", "tests", "cmake")
COLUMNS = 110
PLACE = re.compile(r"^(.*?):(\d+):\d+: error: code should be clang-formatted")


def sources(root: pathlib.Path) -> list[pathlib.Path]:
    return sorted(path for folder in FOLDERS for path in (root / folder).rglob("*") if path.suffix in {".hpp", ".cpp"})


def long_lines(path: pathlib.Path) -> list[str]:
    """Lines beyond the limit, of which clang-format breaks those of code only."""
    text = re.sub(r'R"(\w*)\(.*?\)\1"', lambda raw: re.sub("[^\n]", "", raw[0]), path.read_text(encoding="utf-8"), flags=re.DOTALL)
    return [f"{path}:{number}: {len(line)} columns, at most {COLUMNS}"
            for number, line in enumerate(text.splitlines(), 1) if len(line) > COLUMNS]


def main() -> int:
    if len(sys.argv) not in (2, 3) or sys.argv[2:] not in ([], ["--fix"]):
        print(__doc__, file=sys.stderr)
        return 2
    files = sources(pathlib.Path(sys.argv[1]).resolve())
    if sys.argv[2:]:
        subprocess.run(["clang-format", "-i", *map(str, files)], check=True)
        return 0
    done = subprocess.run(["clang-format", "--dry-run", "-Werror", *map(str, files)], capture_output=True, text=True,
                          check=False)
    for line in done.stderr.splitlines():
        place = PLACE.match(line)
        if place:
            print(f"{place[1]}:{place[2]}: not as clang-format writes it; tests/architecture/formatting.py . --fix")
    beyond = [place for path in files for place in long_lines(path)]
    print(*beyond, sep="\n", end="\n" if beyond else "")
    return 1 if done.returncode or beyond else 0


if __name__ == "__main__":
    sys.exit(main())
