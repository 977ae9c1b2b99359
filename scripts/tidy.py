#!/usr/bin/env python3
"""Runs clang-tidy over the sources, by the checks of .clang-tidy (apt-get install clang-tidy).

usage: tidy.py [--build DIR]... [--jobs N] [--alone] [--all] [--checks=CHECKS] [FOLDER or FILE]...

Flags come from the compile_commands.json of the builds (default: build/dev and build/release; configured is enough).
Almost all the time goes into headers of libraries, so sources of one folder with the same flags are joined into one
text of up to twenty, as far as their names do not collide; findings are reported at their own file and line.
--alone takes every file by itself: some three times slower, and finds besides a `using` or an #include that only the file
behind it makes use of.  What was found clean is noted in build/tidy.json, by a hash of the source, the project's headers
behind it and .clang-tidy, and passed over until one of them changes; --all takes all.  --checks="-*,performance-*": these checks
alone, which takes less time and notes nothing.

Prints the findings; status 1 if there are any, or if a file cannot be read by clang.
"""

import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import threading

REPOSITORY = pathlib.Path(__file__).resolve().parent.parent
CLEAN = REPOSITORY / "build" / "tidy.json"
INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)
PLACE = re.compile(r"^([^\s:][^:]*):(\d+):(\d+): (.*)$")
JOINED = 20  # sources in a text: more gain little


def flags_of(command: str) -> tuple[str, ...]:
    """What clang needs of a line of gcc: definitions, folders, the standard."""
    flags, words = [], shlex.split(command)
    for word, after in zip(words, words[1:] + [""]):
        if word.startswith(("-D", "-I", "-std=", "-fopenmp")):
            flags.append(word)
        elif word == "-isystem":
            flags += [word, after]
    return tuple(flags)


def sources(builds: list[pathlib.Path]) -> dict[pathlib.Path, tuple[str, ...]]:
    found: dict[pathlib.Path, tuple[str, ...]] = {}
    for build in builds:
        database = build / "compile_commands.json"
        if not database.exists():
            sys.exit(f"{database} is missing: cmake --preset {build.name}")
        for entry in json.loads(database.read_text()):
            file = pathlib.Path(entry["file"])
            if file.name.startswith("unity_"):
                sys.exit(f"{build} joins sources: cmake --preset {build.name} -DCMAKE_UNITY_BUILD=OFF")
            if file.suffix == ".cpp" and file.is_relative_to(REPOSITORY) and not file.is_relative_to(REPOSITORY / "build"):
                found.setdefault(file.relative_to(REPOSITORY), flags_of(entry["command"]))
    return found


def headers_behind(file: pathlib.Path, seen: set[pathlib.Path]) -> set[pathlib.Path]:
    """The project's headers that `file` includes, and those that they include."""
    for name in INCLUDE.findall((REPOSITORY / file).read_text()):
        header = pathlib.Path(name)
        if header not in seen and (REPOSITORY / header).exists():
            seen.add(header)
            headers_behind(header, seen)
    return seen


def fingerprint(file: pathlib.Path) -> str:
    behind = sorted(headers_behind(file, set()))
    texts = [(REPOSITORY / name).read_bytes() for name in [file, *behind, pathlib.Path(".clang-tidy")]]
    return hashlib.sha256(b"\0".join(texts)).hexdigest()


class Joined:
    """Several sources as one text; lines of it find their way back."""

    def __init__(self, files: list[pathlib.Path]):
        self.files, self.first_lines, lines = files, [], []
        included: set[str] = set()  # by the files before: once is enough
        for file in files:
            self.first_lines.append(len(lines) + 1)
            own = (REPOSITORY / file).read_text().splitlines()
            lines += ["" if row in included else row for row in own]
            included |= {row for row in own if row.startswith("#include")}
        self.folder = ["-iquote", str(REPOSITORY / files[0].parent)]  # where the compiler looks first
        folder = REPOSITORY / "build" / "tidy"
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile("w", suffix=".cpp", dir=folder, delete=False) as out:
            out.write("\n".join(lines) + "\n")
        self.path = pathlib.Path(out.name)

    def owner(self, line: int) -> tuple[pathlib.Path, int]:
        index = max(i for i, first in enumerate(self.first_lines) if first <= line)
        return self.files[index], line - self.first_lines[index] + 1

    def messages(self, output: str) -> list[tuple[str, str]]:
        """(place, message) of every line of the output that names a place; places inside the text are the file's own."""
        found = []
        for row in output.splitlines():
            match = PLACE.match(row)
            if not match:
                continue
            name, line, column, text = match[1], int(match[2]), match[3], match[4]
            if pathlib.Path(name) == self.path:
                file, line = self.owner(line)
                name = str(file)
            elif pathlib.Path(name).is_relative_to(REPOSITORY / "build"):  # generated
                continue
            found.append((f"{name.removeprefix(str(REPOSITORY) + '/')}:{line}:{column}", text))
        return found


def run(words: list[str]) -> str:
    done = subprocess.run(words, capture_output=True, text=True, cwd=REPOSITORY)
    return done.stdout + done.stderr


def fitting_together(files: list[pathlib.Path], flags: tuple[str, ...]) -> tuple[list[pathlib.Path], list[pathlib.Path]]:
    """Those of `files` that clang takes as one text, and the others. One alone is not tried."""
    others: list[pathlib.Path] = []
    while len(files) > 1:
        text = Joined(files)
        try:
            messages = text.messages(run(["clang++", "-fsyntax-only", "-w", "-ferror-limit=0", *flags, *text.folder, str(text.path)]))
        finally:
            text.path.unlink()
        bad = {place.split(":")[0] for place, message in messages if "error: " in message}
        collide = [file for file in files if str(file) in bad]
        if not bad:
            break
        if not collide or len(collide) == len(files):
            collide = files[1:]
        others += collide
        files = [file for file in files if file not in collide]
    return files, others


def findings(files: list[pathlib.Path], flags: tuple[str, ...], checks: str) -> list[tuple[str, str]]:
    text = Joined(files)
    words = ["clang-tidy", "--quiet", f"--config-file={REPOSITORY / '.clang-tidy'}", *([f"--checks={checks}"] if checks else [])]
    try:
        return text.messages(run([*words, str(text.path), "--", "-w", *flags, *text.folder]))
    finally:
        text.path.unlink()


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("places", nargs="*")
    parser.add_argument("--build", action="append")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--alone", action="store_true")
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--checks", default="")
    options = parser.parse_args()
    builds = [pathlib.Path(b) for b in options.build or [REPOSITORY / "build/dev", REPOSITORY / "build/release"]]
    places = [pathlib.Path(p).resolve().relative_to(REPOSITORY) for p in options.places]

    clean = json.loads(CLEAN.read_text()) if CLEAN.exists() else {}
    groups: dict[tuple, list[pathlib.Path]] = {}
    known = 0
    for file, flags in sorted(sources(builds).items()):
        if places and not any(file.is_relative_to(place) for place in places):
            continue
        known += 1
        if options.all or clean.get(str(file)) != fingerprint(file):
            groups.setdefault((file.parent, flags), []).append(file)
    left = sum(len(files) for files in groups.values())
    print(f"{left} of {known} sources to look at", flush=True)

    lock, seen, dirty = threading.Lock(), set(), set()

    def take(flags: tuple[str, ...], files: list[pathlib.Path]) -> None:
        nonlocal left
        while files:
            now, files = ([files[0]], files[1:]) if options.alone else fitting_together(files, flags)
            before = {file: fingerprint(file) for file in now}
            found = findings(now, flags, options.checks)
            with lock:
                for place, message in found:
                    if (place, message) not in seen:
                        seen.add((place, message))
                        print(f"{place}: {message}", flush=True)
                bad = {place.split(":")[0] for place, message in found if not message.startswith("note: ")}
                if not options.checks and bad <= {str(file) for file in now}:  # a finding in a header leaves all behind it open
                    clean.update({str(file): before[file] for file in now if str(file) not in bad})
                dirty.update(bad)
                left -= len(now)
                CLEAN.write_text(json.dumps(clean, indent=0, sort_keys=True))
                print(f"# {left} left, after {', '.join(map(str, now))}", file=sys.stderr, flush=True)

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        parts = [pool.submit(take, key[1], files[i : i + JOINED]) for key, files in groups.items() for i in range(0, len(files), JOINED)]
        for part in parts:
            part.result()
    sys.exit(1 if dirty else 0)


if __name__ == "__main__":
    main()
