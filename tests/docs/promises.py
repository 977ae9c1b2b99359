#!/usr/bin/env python3
"""Checks docs/promises.md: every row of its first table names the tests that hold it, and they are there.

    promises.py TOP [FILE]

In the column "held by" stand files, `tests/a_test.cpp` or `tests/a.py`, and single tests, `Suite.Name`. A file must exist and have a test, a
script must be run by a CMakeLists.txt or carry "before a release" in its row, and a test must be declared somewhere in tests/. Scripts that
a slow test runs are marked with *. The tables must be what tests/promises/promise_table.py writes. Prints what is wrong; exits 1 where
something is.
"""

import pathlib
import re
import sys

TEST = re.compile(r"^(?:TEST|TEST_F|TEST_P|TYPED_TEST)\((\w+),\s*(\w+)\)", re.M)


def rows(text):
    """Lines of the first table: what is promised, by what it is held."""
    lines = iter(text.splitlines())
    for line in lines:
        if line.startswith("| promise"):
            break
    next(lines, None)
    for line in lines:
        if not line.startswith("|"):
            return
        cells = [c.strip() for c in line.strip("|").split(" | ")]
        yield cells[0].lstrip("| "), " | ".join(cells[1:]).rstrip("| ")


def problems(top, text):
    tests = set()
    for file in (top / "tests").rglob("*_test.cpp"):
        tests |= {f"{suite}.{name}" for suite, name in TEST.findall(file.read_text())}
    lists = {f.parent: f.read_text() for f in (top / "tests").rglob("CMakeLists.txt")}
    found = list(rows(text))
    if not found:
        yield "has no table of promises"
    for promise, held in found:
        where = f"\"{promise[:60]}...\""
        named = re.findall(r"`([^`]+)`(\*?)", held)
        holding = [(n, star) for n, star in named if n.startswith("tests/") or n in tests or re.fullmatch(r"[A-Z]\w+\.[A-Z]\w+", n)]
        if not holding:
            yield f"{where}: no test is named"
        for name, star in holding:
            if not name.startswith("tests/"):
                if name not in tests:
                    yield f"{where}: there is no test {name}"
                continue
            path = top / name
            if not path.is_file():
                yield f"{where}: there is no file {name}"
            elif path.suffix == ".cpp":
                own = TEST.findall(path.read_text())
                if not own:
                    yield f"{where}: {name} has no test"
                elif star and not any(suite.startswith("Slow") for suite, _ in own):
                    yield f"{where}: {name} has no slow test"
            else:
                short = f"{path.parent.name}/{path.name}"
                own_list = lists.get(path.parent, "")
                globbed = path.name.endswith("_test.py") and "*_test.py" in own_list
                run = globbed or path.name in own_list or any(short in body for body in lists.values())
                if star and not run:
                    yield f"{where}: {name} is not run by a test"
                if not star and not run and "before a release" not in promise + held:
                    yield f"{where}: {name} is run by no test and not said to be run before a release"


def main():
    top = pathlib.Path(sys.argv[1])
    file = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else top / "docs/promises.md"
    wrong = list(problems(top, file.read_text()))
    if len(sys.argv) <= 2:
        sys.path.insert(0, str(top / "tests/promises"))
        import promise_table
        wrong += promise_table.faults()
    for line in wrong:
        print(f"{file.name}: {line}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
