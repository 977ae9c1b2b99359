#!/usr/bin/env python3
"""Builds the command again from a copy of the source in another folder, without ccache: results must not know where or when they
were computed.

    second_build.py FOLDER [--only ROOM... | --as-it-is] [--jobs N]

Copies what git has of this tree to FOLDER/source. Without --only configures and builds it in FOLDER/build, which takes as long as a
build does. With --only compiles the sources of these rooms (`coupling/dynamics`) alone, with the flags of build/release, and links
them with its other libraries. With --as-it-is compiles nothing: of a whole build in FOLDER that was left before its end, links the
libraries that are there with the others of build/release, and says which are whose. Prints the path of the second command, which tests/promises/same_bytes.py and
scripts/compare_results.py take.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def copied(folder):
    source = folder / "source"
    files = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True).stdout.decode().split("\0")
    for name in filter(None, files):
        if (ROOT / name).is_file():
            (source / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, source / name)
    return source


def whole(source, build, jobs):
    environment = {**os.environ, "CCACHE_DISABLE": "1"}
    subprocess.run(["cmake", "-S", source, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release"], check=True, env=environment,
                   stdout=sys.stderr)
    subprocess.run(["ninja", "-C", build, "-j", str(jobs), "snare"], check=True, env=environment, stdout=sys.stderr)
    return build / "snare"


def some(source, build, rooms, jobs):
    first = ROOT / "build/release"
    build.mkdir(parents=True, exist_ok=True)
    commands = []
    for entry in json.loads((first / "compile_commands.json").read_text()):
        name = pathlib.Path(entry["file"]).relative_to(ROOT)
        if name.name.startswith("unity_"):
            sys.exit("build/release joins sources: cmake --preset release -DCMAKE_UNITY_BUILD=OFF")
        if not any(name.is_relative_to(room) for room in rooms):
            continue
        line = [a.replace(f"-I{ROOT}", f"-I{source}") for a in shlex.split(entry["command"])]
        line = line[1:] if pathlib.Path(line[0]).name == "ccache" else line
        drop = {"-include": 1, "-o": 1, "-Winvalid-pch": 0}
        kept, skip = [], 0
        for word in line:
            if skip:
                skip -= 1
            elif word in drop:
                skip = drop[word]
            else:
                kept.append(word)
        made = build / (str(name).replace("/", "_") + ".o")
        commands.append(([str(source / name) if a == entry["file"] else a for a in kept] + ["-o", str(made)], made))
    environment = {**os.environ, "CCACHE_DISABLE": "1"}
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        list(pool.map(lambda c: subprocess.run(c[0], cwd=source, check=True, env=environment), commands))
    return linked(build / "snare", [str(made) for _, made in commands], libraries())


def libraries():
    """Of the first build, as it links its command."""
    ninja = (ROOT / "build/release/build.ninja").read_text()
    return re.search(r"LINK_LIBRARIES = (app/libsnare_app\.a .*)", ninja).group(1).replace("$:", ":").split()


def linked(command, objects, libraries):
    first = ROOT / "build/release"
    main = next(first.glob("app/CMakeFiles/snare.dir/main.cpp.o"), None) or next(first.rglob("main.cpp.o"))
    subprocess.run(["g++", "-fopenmp", str(main), *objects, *libraries, "-rdynamic", "-o", str(command)], cwd=first, check=True)
    return command


def as_it_is(build):
    own = [str(build / name) if (build / name).is_file() else name for name in libraries()]
    for name in own:
        if name.endswith(".a") and "snare" in name:
            print("second" if name.startswith(str(build)) else "first", pathlib.Path(name).name, file=sys.stderr)
    return linked(build / "snare_as_it_is", [], own)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder")
    parser.add_argument("--only", nargs="+", default=[])
    parser.add_argument("--as-it-is", action="store_true")
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    folder = pathlib.Path(options.folder).resolve()
    if options.as_it_is:
        print(as_it_is(folder / "build"))
        return
    source = copied(folder)
    command = some(source, folder / "build", options.only, options.jobs) if options.only else whole(source, folder / "build", options.jobs)
    print(command)


if __name__ == "__main__":
    main()
