#!/usr/bin/env python3
"""Checks that the includes of the module folders follow the one-way dependencies.

usage: include_directions.py REPOSITORY

Prints one line per violation, `file:line: ...`, and exits 1 if there is any.
"""

import pathlib
import re
import sys

# Every room with the rooms it may include beside itself and what these include: the lowest first. The room of a file is
# the longest of these paths that leads to it.
USES = {
    "base": [],
    "numerics": ["base"],
    "study": ["base"],
    "study/mpi": ["study"],
    "wire": ["numerics"],
    "wire/statics": ["wire"],
    "wire/motion": ["wire/statics"],
    "multibody": ["numerics"],
    "multibody/arm": ["multibody"],
    "coupling/contact": ["wire/motion", "multibody"],
    "coupling/statics": ["coupling/contact"],
    "coupling/dynamics/model": ["coupling/contact", "multibody/arm"],
    "coupling/dynamics/joints": ["coupling/dynamics/model"],
    "coupling/dynamics/contact": ["coupling/dynamics/joints"],
    "coupling/dynamics/laws": ["coupling/dynamics/contact"],
    "coupling/dynamics/run": ["coupling/dynamics/laws"],
    "scenario": ["coupling/statics", "coupling/dynamics/run"],
    "reduction": ["scenario"],
    "identification/fitting": ["scenario"],
    "identification/effects": ["identification/fitting"],
    "identification/tracing": ["identification/effects"],
    "identification/published": ["identification/effects"],
    "identification/ring_down": ["identification/fitting"],
    "identification/records": ["identification/tracing"],
    "identification/motion_effects": ["identification/records"],
    "identification/motion_tracing": ["identification/motion_effects"],
    "validation": ["reduction", "identification/tracing", "identification/published", "identification/ring_down", "identification/motion_tracing"],
    "results": ["validation", "study"],
    "papers": ["results"],
    "app/report": ["papers"],
    "app": ["app/report"],
    "benchmarks": ["results"],
    "examples": ["results"],
    "python": ["results"],
}
# Folders that hold rooms and no files of their own.
FOLDERS = {path.split("/")[0] for path in USES} | {"tests"}  # what an include of ours may begin with


def below(room: str) -> set[str]:
    """All rooms that a room may include beside itself."""
    found = set()
    for one in USES[room]:
        found |= {one} | below(one)
    return found


BELOW = {room: below(room) for room in USES}


def room_of(path: str) -> str:
    """The room of a file, or "" where it is in none."""
    folder = path.rpartition("/")[0]
    while folder and folder not in USES:
        folder = folder.rpartition("/")[0]
    return folder


SUFFIXES = {".hpp", ".h", ".cpp", ".cc", ".ipp"}
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]')


def violations(root: pathlib.Path) -> list[str]:
    found = []
    files = {}  # every file of a room with those of ours that it includes
    for folder in sorted(FOLDERS - {"tests"}):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in SUFFIXES and path.is_file():
                name = path.relative_to(root).as_posix()
                if not room_of(name):
                    found.append(f"{name}:1: {folder}/ holds rooms and no files of its own")
                    continue
                found += violations_of_file(path, name, files)
    return found + circles(files)


def violations_of_file(path: pathlib.Path, file: str, files: dict[str, list[str]]) -> list[str]:
    found = []
    room = room_of(file)
    files[file] = []
    lines = path.read_text(encoding="utf-8").splitlines()
    for number, line in enumerate(lines, start=1):
        match = INCLUDE.match(line)
        if not match:
            continue
        bracket, name = match[1], match[2].removeprefix("snare/")  # as users write it
        where = f"{file}:{number}"
        if name.split("/")[0] in FOLDERS and "/" in name:
            files[file].append(name)
            other = room_of(name)
            if other != room and other not in BELOW[room]:
                allowed = ", ".join(sorted(BELOW[room])) or "no other room"
                found.append(f'{where}: {room} must not include "{name}"; it may include {allowed}')
        elif bracket == '"':
            found.append(f'{where}: include "{name}" is not rooted at the top: write "{room}/..." '
                         "or use <> for a library")
    return found


def circles(files: dict[str, list[str]]) -> list[str]:
    """One line for every circle of subjects: a header with its source counts as one."""
    def subject(file: str) -> str:
        return file.rpartition(".")[0]

    uses = {}
    for file, included in files.items():
        uses.setdefault(subject(file), set()).update(subject(name) for name in included)
    found, done, way = [], set(), []

    def visit(one: str) -> None:
        if one in way:
            found.append(f"{one}: includes itself by way of " + ", ".join(way[way.index(one) + 1:]))
            return
        if one in done:
            return
        way.append(one)
        for other in sorted(uses.get(one, set()) - {one}):
            visit(other)
        way.pop()
        done.add(one)

    for one in sorted(uses):
        visit(one)
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
