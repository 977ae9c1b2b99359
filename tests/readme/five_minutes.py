#!/usr/bin/env python3
"""Follows the documentation to the letter, and times it: from nothing, once built, to a result of one's own in less than five minutes.

usage: five_minutes.py REPOSITORY SNARE

Takes the marked blocks of a page in their order, in a folder that looks like the repository's (see readme_commands.py):
    <!-- test: run -->                    the commands of the block
    <!-- test: file NAME -->              the file as it stands
    <!-- test: from TEXT on NAME -->      NAME has the block in place of everything from the line that begins with TEXT
First README.md's commands to the trace of the starter files, then docs/tutorial.md from its first block, the published tests, to the trace of one's
own wire; last the trace of docs/examples.md from Python, where the module was built. What counts is processor time, which does not depend on other work
of the machine; wall-clock time is printed as well.
"""

import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time

from readme_commands import commands, marked_blocks, prepare

LIMIT = 300.0  # [s]
MARKER = re.compile(r"^<!-- test: (?:(run)|file (\S+)|from (.+?) on (\S+)) -->\n```\w*\n(.*?)^```$", re.M | re.S)


def clocks():
    """Processors' time of what was run, and the clock's [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime, time.monotonic()


def since(begin):
    return tuple(now - then for now, then in zip(clocks(), begin))


def run(command, folder, page):
    begin = clocks()
    print(f"{page}: {command}", flush=True)
    done = subprocess.run(["bash", "-c", command], cwd=folder, env=os.environ, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{page}: `{command}` ended with status {done.returncode}: {done.stderr}")
    print("    {:.1f} s, {:.1f} s by the clock".format(*since(begin)), flush=True)


def follow(page, name, folder):
    """Runs a page; returns the time to the first result of a file that the user has written."""
    begin, own, first = clocks(), False, None
    if len(MARKER.findall(page)) != page.count("<!-- test: "):
        raise SystemExit(f"{name}: a marker does not stand before a block, or is unknown")
    for runs, file, text, edited, block in MARKER.findall(page):
        if runs:
            for command in commands(block):
                run(command, folder, name)
                if own and first is None:
                    first = since(begin)
        elif file:
            (folder / file).write_text(block, encoding="utf-8")
            own = True
        else:
            whole = (folder / edited).read_text(encoding="utf-8")
            if f"\n{text}" not in whole:
                raise SystemExit(f"{name}: {edited} has no line that begins with {text}")
            (folder / edited).write_text(whole.split(f"\n{text}", 1)[0] + "\n" + block, encoding="utf-8")
    if first is None:
        raise SystemExit(f"{name}: no command runs a file of one's own")
    return first


def starter(repository, folder):
    """README's commands in their order, up to the first that runs a file which `snare new` has written and the user may edit."""
    begin, written = clocks(), False
    for _, name, text in marked_blocks((repository / "README.md").read_text(encoding="utf-8")):
        for command in commands(text) if name is None else []:
            run(command, folder, "README.md")
            if written:
                return since(begin)
            written = command.startswith("./run new ")
    raise SystemExit("README.md: no command runs the files of `./run new`")


def main():
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    repository, snare = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    if not snare.is_file():
        print(f"skipped: {snare} was not built; ./run builds it")
        return 77
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        prepare(folder, repository, snare)
        times = {"README.md": starter(repository, folder)}
        times["docs/tutorial.md"] = follow((repository / "docs/tutorial.md").read_text(encoding="utf-8"), "docs/tutorial.md", folder)
        for result in ("out/reproduce/report.html", "out/my_wire/report.html", "out/my_trace/trace.json"):
            if not (folder / result).is_file():
                raise SystemExit(f"{result} was not written")
        if list((repository / "build/release/python/snare").glob("_core*.so")):
            (folder / "build/release/python").symlink_to(repository / "build/release/python")
            shutil.copytree(repository / "examples", folder / "examples")
            python = re.search(r"^PYTHONPATH=.*trace_csv.*$", (repository / "docs/examples.md").read_text(encoding="utf-8"), re.M).group(0)
            run(f"MPLBACKEND=agg {python}", folder, "docs/examples.md")
            if not (folder / "picture.png").is_file():
                raise SystemExit("docs/examples.md: its lines of Python have drawn no picture")
    for page, took in times.items():
        print("{}: {:.1f} s, {:.1f} s by the clock, to the first result of one's own".format(page, *took))
    return 0 if max(took for took, _ in times.values()) < LIMIT else 1


if __name__ == "__main__":
    sys.exit(main())
