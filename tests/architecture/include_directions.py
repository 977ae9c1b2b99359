#!/usr/bin/env python3
"""Checks that the includes of the module folders follow the one-way dependencies.

usage: include_directions.py REPOSITORY

Prints one line per violation, `file:line: ...`, and exits 1 if there is any.
"""

import pathlib
import re
import sys

# Every module with the modules it may include beside itself.
BELOW = {
    "numerics": set(),
    "wire": {"numerics"},
    "multibody": {"numerics"},
    "coupling": {"numerics", "wire", "multibody"},
    "reduction": {"numerics", "wire", "multibody", "coupling"},
    "identification": {"numerics", "wire", "multibody", "coupling", "reduction"},
}
LIBRARY = set(BELOW)
BELOW["validation"] = LIBRARY
BELOW["app"] = LIBRARY | {"validation"}
BELOW["benchmarks"] = LIBRARY | {"validation"}
BELOW["python"] = LIBRARY
FOLDERS = set(BELOW) | {"tests"}  # what an include of ours may begin with

SUFFIXES = {".hpp", ".h", ".cpp", ".cc", ".ipp"}
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]')


def violations(root: pathlib.Path) -> list[str]:
    found = []
    for module in sorted(BELOW):
        for path in sorted((root / module).rglob("*")):
            if path.suffix in SUFFIXES and path.is_file():
                found += violations_of_file(root, module, path)
    return found


def violations_of_file(root: pathlib.Path, module: str, path: pathlib.Path) -> list[str]:
    found = []
    lines = path.read_text(encoding="utf-8").splitlines()
    for number, line in enumerate(lines, start=1):
        match = INCLUDE.match(line)
        if not match:
            continue
        bracket, name = match.groups()
        where = f"{path.relative_to(root)}:{number}"
        folder = name.split("/")[0] if "/" in name else ""
        if folder in FOLDERS:
            if folder != module and folder not in BELOW[module]:
                allowed = ", ".join(sorted(BELOW[module])) or "no other module"
                found.append(f'{where}: {module} must not include "{name}"; it may include {allowed}')
        elif bracket == '"':
            found.append(f'{where}: include "{name}" is not rooted at the top: write "{module}/..." '
                         "or use <> for a library")
    return found


def main() -> int:
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    found = violations(pathlib.Path(sys.argv[1]).resolve())
    for line in found:
        print(line)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
