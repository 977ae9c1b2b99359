#!/usr/bin/env python3
"""Every verb with 1 and 3 threads: the same bytes in every file, times of the clock aside.

    same_bytes.py SNARE [OTHER] [--only VERB] [--without VERB]

OTHER: another build of the same source, whose bytes must be the same as well. Exits 1 where they differ, or a verb of the command is
not in the list.
"""

import argparse
import csv
import io
import json
import os
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
    ["reproduce", None, "abiko"],
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
    ["simulate", DATA / "scenarios/air_table.toml", "duration_s=0.02"],
    ["arm show", DATA / "arms/jemrms_like.toml"],
    ["benchmark", None, "--case", "push_middle"],
    ["benchmark", None, "--case", "impact_middle"],
    ["new", "capture"],
    ["export", ROOT / "tests/ranges/wire.toml"],  # of the law that is distilled of it
    ["validate", None],
]
CLOCK = {"wall_s", "real_time_factor", "seconds", "seconds_per_evaluation"}
CLOCK_COLUMNS = {"scores.csv": {"wall_s"}}


def timeless(value):
    if isinstance(value, dict):
        return {k: timeless(v) for k, v in value.items() if k not in CLOCK}
    return [timeless(v) for v in value] if isinstance(value, list) else value


def timeless_rows(name, text):
    """A table without its columns of times."""
    rows = list(csv.reader(io.StringIO(text)))
    kept = [k for k, column in enumerate(rows[0]) if column not in CLOCK_COLUMNS[name]]
    return json.dumps([[row[k] for k in kept] for row in rows])


def files(folder):
    """Name and content of each; of pages, which print times, only that they are there."""
    result = {}
    for file in sorted(folder.rglob("*")):
        if file.suffix == ".json":
            result[file.name] = json.dumps(timeless(json.loads(file.read_text())))
        elif file.name in CLOCK_COLUMNS:
            result[file.name] = timeless_rows(file.name, file.read_text())
        elif file.is_file() and file.suffix != ".journal":  # of a sweep: cases as they end, with their times
            result[file.name] = "" if file.suffix == ".html" else file.read_bytes()
    return result


def run(snare, verb, threads):
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out"
        line = [snare, *verb[0].split(), *([str(verb[1])] if verb[1] else [])]
        if verb[0] == "export":
            law = pathlib.Path(folder) / "law"
            subprocess.run([snare, "distil", str(verb[1]), "--out", str(law), "--quiet"], check=True)
            line[-1:] = [str(law / "law.json"), "--mujoco", str(ROOT / "examples/air_table.xml"), "--body", "target", "--quiet"]
        elif verb[0] not in ("arm show", "new"):
            line += ["--quiet", "--threads", str(threads)]
        line += ["--json"] if verb[0] == "arm show" else ["--out", str(out)]
        for setting in verb[2:]:
            line += [setting] if setting.startswith("--") or "=" not in setting else ["--set", setting]
        environment = dict(os.environ, OMP_NUM_THREADS=str(threads))  # of the verbs that have no option for them
        done = subprocess.run(line, capture_output=True, text=True, check=False, env=environment)
        if done.returncode != 0:
            return {"status": f"{done.returncode}: {done.stderr[-300:]}"}
        if verb[0] == "arm show":
            return {"standard output": done.stdout}
        # No result names its own folder.
        return {name: re.sub(re.escape(folder), "", text) if isinstance(text, str) else text
                for name, text in files(out).items()}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("commands", nargs="+", metavar="SNARE")
    parser.add_argument("--only", help="the verb that is run, and no other")
    parser.add_argument("--without", help="a verb that is left out")
    options = parser.parse_args()
    help_text = subprocess.run([options.commands[0], "--help"], capture_output=True, text=True, check=True).stdout
    verbs = re.findall(r"^  (\w+)  +\S", help_text.split("Subcommands:")[1], re.M)
    wrong = 0
    for verb in sorted(set(verbs) - {v[0].split()[0] for v in VERBS}):
        wrong += 1
        print(f"{verb}: is not among the verbs that are looked at")
    for verb in VERBS:
        if options.only not in (None, verb[0]) or options.without == verb[0]:
            continue
        name = f"{verb[0]} {verb[1].name if isinstance(verb[1], pathlib.Path) else verb[1] or ' '.join(verb[2:])}".strip()
        first = run(options.commands[0], verb, 1)
        others = [(options.commands[0], 3), *((c, 2) for c in options.commands[1:])]
        for command, threads in others:
            other = run(command, verb, threads)
            for file in sorted(first.keys() | other.keys()):
                if first.get(file) != other.get(file):
                    wrong += 1
                    print(f"{name}: {file} differs with {threads} threads of {command}")
        print(name, ", ".join(first) if "status" not in first else first["status"], flush=True)
        wrong += "status" in first
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
