#!/usr/bin/env python3
"""Runs the commands that README.md shows, against a given build.

usage: readme_commands.py REPOSITORY SNARE

A marker on a line of its own says what is done with the fenced block that follows it:
    <!-- test: run -->           the lines of the ```sh block are run one by one and must succeed
    <!-- test: file NAME -->     the block is written to the file NAME first
Other blocks are left alone; one marked `same as FILE` is compared by tests/docs. The commands run in an empty
folder that looks like the repository: `./run` and `build/release/snare` both start SNARE, `data` is the
repository's.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

MARKER = re.compile(r"^<!-- test: (run|file (\S+)) -->$")


def marked_blocks(text):
    """Yields (line number of the block's first line, file name or None, text of the block)."""
    lines = text.splitlines()
    number = 0
    while number < len(lines):
        match = MARKER.match(lines[number])
        number += 1
        if not match:
            continue
        if number >= len(lines) or not lines[number].startswith("```"):
            raise ValueError(f"README.md:{number}: a test marker must be followed by a fenced block")
        start = number + 1
        end = start
        while end < len(lines) and lines[end] != "```":
            end += 1
        if end == len(lines):
            raise ValueError(f"README.md:{start}: the fenced block is not closed")
        yield start + 1, match.group(2), "\n".join(lines[start:end]) + "\n"
        number = end + 1


def commands(block):
    """The command lines of a block: comments and empty lines left out, `\\` continues a line."""
    joined = block.replace("\\\n", " ")
    return [line.strip() for line in joined.splitlines() if line.strip() and not line.strip().startswith("#")]


def prepare(folder, repository, snare):
    (folder / "build" / "release").mkdir(parents=True)
    (folder / "build" / "release" / "snare").symlink_to(snare)
    (folder / "data").symlink_to(repository / "data")
    run = folder / "run"
    run.write_text('#!/bin/sh\n[ $# -gt 0 ] || set -- reproduce --out out/reproduce\n'
                   'exec build/release/snare "$@"\n', encoding="utf-8")
    run.chmod(0o755)


def main():
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    repository = pathlib.Path(sys.argv[1]).resolve()
    blocks = list(marked_blocks((repository / "README.md").read_text(encoding="utf-8")))
    if not any(name is None for _, name, _ in blocks):
        print("README.md: no block is marked to be run")
        return 1
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        prepare(folder, repository, pathlib.Path(sys.argv[2]).resolve())
        for _, file, text in blocks:
            if file is not None:
                path = folder / file
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8")
        for line, file, text in blocks:
            for command in commands(text) if file is None else []:
                print(f"README.md:{line}: {command}", flush=True)
                status = subprocess.run(["bash", "-c", command], cwd=folder, env=os.environ).returncode
                if status != 0:
                    print(f"README.md:{line}: `{command}` ended with status {status}")
                    return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
