#!/usr/bin/env python3
"""Checks that clang-format, with the settings of .clang-format, would change no source of the repository.

usage: formatting.py REPOSITORY [--fix]

Prints one line per place, `file:line: ...`, and exits 1 if there is any. --fix: formats the files instead.
"""

import pathlib
import re
import subprocess
import sys

FOLDERS = ("base", "numerics", "wire", "multibody", "coupling", "scenario", "reduction", "identification", "validation",
           "results", "papers", "study", "app", "python", "benchmarks", "examples", "tests", "cmake")
PLACE = re.compile(r"^(.*?):(\d+):\d+: error: code should be clang-formatted")


def sources(root: pathlib.Path) -> list[pathlib.Path]:
    return sorted(path for folder in FOLDERS for path in (root / folder).rglob("*") if path.suffix in {".hpp", ".cpp"})


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
    return 1 if done.returncode else 0


if __name__ == "__main__":
    sys.exit(main())
