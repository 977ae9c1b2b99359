#!/usr/bin/env python3
"""Every verb with 1, 2 and 4 threads: the same bytes in every file, times of the clock aside.

    same_bytes.py SNARE [OTHER]

OTHER: another build of the same source, whose bytes must be the same as well. Exits 1 where they differ.
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
DATA = ROOT / "data"
SMALL = ["solver.elements=16", "series[s40].points=12", "series[s65].points=12", "series[s90].points=12"]
VERBS = [
    ["push", DATA / "experiments/published_static.toml"],
    ["fit", DATA / "experiments/published_static.toml", *SMALL],
    ["trace", DATA / "experiments/published_static.toml", *SMALL],
    ["reproduce", DATA / "experiments/published_static.toml", *SMALL],
    ["distil", ROOT / "tests/ranges/wire.toml"],
    ["compare", DATA / "experiments/published_static.toml", *SMALL],
    ["ringdown", DATA / "experiments/ringdown.toml"],
    ["simulate", DATA / "scenarios/grapple_shaft.toml", "duration_s=0.02", "wires[lower].elements=12",
     "wires[right].elements=12", "wires[left].elements=12"],
    ["simulate", DATA / "scenarios/jemrms_step.toml", "duration_s=2.0"],
    ["simulate", ROOT / "tests/ranges/composed.toml", "duration_s=0.01"],
    ["compare", DATA / "scenarios/snare_on_pin.toml", "duration_s=0.02", "snares[snare].wire.elements=12", "phases[close].at_s=0"],
    ["sweep", ROOT / "tests/ranges/sweep.toml", "cases=24"],
    ["fit", ROOT / "tests/ranges/record.toml"],
    ["trace", ROOT / "tests/ranges/record.toml", "fit.most_effects=1"],
]
CLOCK = {"wall_s", "real_time_factor", "seconds", "seconds_per_evaluation"}


def timeless(value):
    if isinstance(value, dict):
        return {k: timeless(v) for k, v in value.items() if k not in CLOCK}
    return [timeless(v) for v in value] if isinstance(value, list) else value


def files(folder):
    """Name and content of each; of pages, which print times, only that they are there."""
    result = {}
    for file in sorted(folder.rglob("*")):
        if file.suffix == ".json":
            result[file.name] = json.dumps(timeless(json.loads(file.read_text())))
        elif file.is_file() and file.suffix != ".journal":  # of a sweep: cases as they end, with their times
            result[file.name] = "" if file.suffix == ".html" else file.read_bytes()
    return result


def run(snare, verb, threads):
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out"
        line = [snare, verb[0], str(verb[1]), "--out", str(out), "--quiet", "--threads", str(threads)]
        for setting in verb[2:]:
            line += ["--set", setting]
        done = subprocess.run(line, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            return {"status": f"{done.returncode}: {done.stderr[-300:]}"}
        # No result names its own folder.
        return {name: re.sub(re.escape(folder), "", text) if isinstance(text, str) else text
                for name, text in files(out).items()}


def main():
    commands = sys.argv[1:]
    wrong = 0
    for verb in VERBS:
        first = run(commands[0], verb, 1)
        others = [(commands[0], 2), (commands[0], 4), *((c, 2) for c in commands[1:])]
        for command, threads in others:
            other = run(command, verb, threads)
            for name in sorted(first.keys() | other.keys()):
                if first.get(name) != other.get(name):
                    wrong += 1
                    print(f"{verb[0]} {verb[1].name}: {name} differs with {threads} threads of {command}")
        print(verb[0], verb[1].name, ", ".join(first) if "status" not in first else first["status"], flush=True)
        wrong += "status" in first
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
