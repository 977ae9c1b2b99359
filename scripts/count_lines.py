#!/usr/bin/env python3
"""Counts the lines of C++ by room, and lists long functions.

    count_lines.py [REPOSITORY] [--json] [--functions N]

Counts every line of the .hpp and .cpp files under version control, comments and empty lines included; tests, benchmarks, examples and generated
files are not the product and are summed by themselves. A room is a folder with sources. --functions: lists functions of more than N lines, from
the line of the opening brace to that of the closing one.
"""

import argparse
import collections
import json
import pathlib
import re
import subprocess

BESIDE = ("tests", "benchmarks", "examples")


def sources(root):
    listed = subprocess.run(["git", "-C", str(root), "ls-files", "*.hpp", "*.cpp"], capture_output=True, text=True, check=True)
    return [pathlib.Path(name) for name in listed.stdout.splitlines() if (root / name).is_file()]


def functions(text):
    """Yields name and number of lines of the outermost bodies behind a parameter list."""
    lines = text.splitlines()
    k = 0
    while k < len(lines):
        head = re.match(r"^( {0,2})\S.*\)[\w ]*(?:-> [\w:<>]+ )?\{$|^( {0,2})\s*: .*\{$", lines[k])
        if not head or re.match(r"\s*(if|for|while|switch|else|namespace|struct|class|enum)\b", lines[k]):
            k += 1
            continue
        indent = re.match(r" *", lines[k])[0][:2]
        end = next((i for i in range(k + 1, len(lines)) if lines[i].rstrip() in (indent + "}", "}")), None)
        if end is None:
            return
        name = re.search(r"([\w:~]+)\(", " ".join(lines[max(0, k - 3):k + 1]))
        yield (name[1] if name else lines[k].strip()), end - k + 1, k + 1
        k = end


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("repository", nargs="?", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[1])
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--functions", type=int, metavar="N")
    options = parser.parse_args()
    rooms, beside = collections.Counter(), collections.Counter()
    for name in sources(options.repository):
        text = (options.repository / name).read_text(encoding="utf-8")
        counter = beside if name.parts[0] in BESIDE else rooms
        counter[name.parts[0] if counter is beside else str(name.parent)] += text.count("\n")
        if options.functions is not None and counter is rooms:
            for function, count, line in functions(text):
                if count > options.functions:
                    print(f"{name}:{line}: {function}: {count} lines")
    if options.functions is not None:
        return
    if options.json:
        print(json.dumps({"rooms": rooms, "product": sum(rooms.values()), "beside": beside}, indent=1, sort_keys=True))
        return
    for room in sorted(rooms):
        print(f"{rooms[room]:7} {room}")
    print(f"{sum(rooms.values()):7} product")
    for folder in sorted(beside):
        print(f"{beside[folder]:7} {folder}")


if __name__ == "__main__":
    main()
