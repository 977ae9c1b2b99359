#!/usr/bin/env python3
"""Runs a program and compares what it prints with what is known.

usage: example_output.py PROGRAM [ARGUMENT...] -- CHECK...

A check is `NAME=VALUE+-LIMIT`: one line of the output must begin with `NAME: ` and a number within LIMIT of
VALUE; or `NAME=WORD`: one line must be `NAME: WORD`. Exits 1 and says what is wrong where a check fails.
"""

import re
import subprocess
import sys

NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


def problems(output: str, checks: list[str]) -> list[str]:
    """One line for every check that the output does not pass."""
    found = []
    for check in checks:
        name, _, expected = check.partition("=")
        said = [line[len(name) + 2:] for line in output.splitlines() if line.startswith(name + ": ")]
        if len(said) != 1:
            found.append(f'"{name}" is printed {len(said)} times, must be once')
        elif "+-" not in expected:
            if said[0] != expected:
                found.append(f'"{name}" is {said[0]}, must be {expected}')
        else:
            value, limit = (float(text) for text in expected.split("+-"))
            number = NUMBER.match(said[0])
            # `not <=` so that a NaN fails too
            if number is None or not abs(float(number.group()) - value) <= limit:
                found.append(f'"{name}" is {said[0]}, must be within {limit:g} of {value:g}')
    return found


def main() -> int:
    if "--" not in sys.argv[2:-1]:
        print(__doc__, file=sys.stderr)
        return 2
    split = sys.argv.index("--", 2)
    run = subprocess.run(sys.argv[1:split], stdout=subprocess.PIPE, text=True, check=False)
    print(run.stdout, end="")
    if run.returncode == 77:  # a package is missing
        return 77
    if run.returncode != 0:
        print(f"{sys.argv[1]} ended with status {run.returncode}")
        return 1
    found = problems(run.stdout, sys.argv[split + 1:])
    for line in found:
        print(line)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
