#!/usr/bin/env python3
"""Runs some cases of the long sweeps in benchmarks/results again, each by itself, and compares them with their stored rows.

usage: rows.py SNARE [--rows N] [--seed S]

--rows: of every sweep so many cases that were computed or refused, drawn with the seed (6). Prints what differs; status 1 if anything does.
"""

import argparse
import csv
import json
import pathlib
import random
import re
import subprocess
import sys
import tempfile
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))

import shipped  # noqa: E402

SWEEPS = ("htv_envelope", "htv_envelope_wires", "htv_order")


def collected(summary, rule):
    """What a rule of [collect], `[count|max] path` with `[*]` for every member, gives of a summary."""
    how, path = rule.split(" ", 1) if rule.startswith(("count ", "max ")) else ("", rule)
    values = [summary]
    for name, member in re.findall(r"([^.\[\]]+)(?:\[([^\]]+)\])?(?:\.|$)", path):
        values = [v[name] for v in values]
        if member == "*":
            values = [one for v in values for one in (v.values() if isinstance(v, dict) else v)]
        elif member:
            values = [v[member] for v in values]
    numbers = [v for v in values if v is not None]
    if how == "count":
        return len(numbers)
    return max(numbers) if how == "max" and numbers else (numbers[0] if not how and numbers else None)


def run_case(snare, sweep, number, folder):
    """The summary of a case; none where it is refused."""
    done = subprocess.run([snare, "sweep", f"data/sweeps/{sweep}.toml", "--case", str(number), "--out", folder, "--quiet"], cwd=ROOT,
                          capture_output=True, text=True)
    if done.returncode == 2:
        return None
    if done.returncode != 0:
        raise SystemExit(f"case {number} of {sweep} ended with status {done.returncode}: {done.stderr}")
    return json.loads((pathlib.Path(folder) / f"case_{number}" / "summary.json").read_text(encoding="utf-8"))


def differs(column, cell, value, maker):
    """Whether a number or truth differs from a cell of the stored table."""
    if cell == "" or value is None:
        return (cell == "") != (value is None)
    return not shipped.close(float(cell), float(value), *maker.tolerance(column))


def compare(snare, name, rows, seed):
    """Lines: cells that differ."""
    stored = list(csv.DictReader((ROOT / shipped.results(f"{name}.csv")).open(encoding="utf-8")))
    rules = tomllib.loads((ROOT / f"data/sweeps/{name}.toml").read_text(encoding="utf-8"))["collect"]
    alone = [row for row in stored if row["status"] in ("done", "refused")]
    for row in random.Random(f"{name} {seed}").sample(alone, min(rows, len(alone))):
        with tempfile.TemporaryDirectory() as folder:
            summary = run_case(snare, name, row["case"], folder)
        if (summary is None) != (row["status"] == "refused"):
            yield f"case {row['case']} is stored as {row['status']}"
        elif summary is not None:
            for column, rule in rules.items():
                value = collected(summary, rule)
                if differs(column, row[column], value, shipped.MAKERS[name]):
                    yield f"case {row['case']}, {column}: stored {row[column]}, made {value}"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("snare")
    parser.add_argument("--rows", type=int, default=6)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    found = False
    for name in SWEEPS:
        for line in compare(options.snare, name, options.rows, options.seed):
            print(f"{name}: {line}")
            found = True
        print(f"{name}: {options.rows} rows compared", flush=True)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
