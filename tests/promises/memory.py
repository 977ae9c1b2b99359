#!/usr/bin/env python3
"""Memory and time of large inputs: a fit of a million readings within 1 GB, a push of 1000 series within 2 GB, the time of a fit at
most linear in its readings.

    memory.py SNARE [--small] [--results FILE]

Fits ten thousand, a hundred thousand and a million readings; with `--small` the first two, the second within a tenth of the memory
beside what the program itself needs. Prints figures; exits 1 where a bound is passed.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

from wire_text import experiment

HEAD = experiment("large", 175.49, "bending_stiffness_Nm2 = 0.0094\naxial_stiffness_N = 19300.0\n") + """[solver]
elements = 32
"""


def measured(snare, verb, folder):
    """Status, seconds, largest memory [MB] of a run."""
    begin = time.monotonic()
    child = subprocess.Popen([snare, verb, "x.toml", "--out", "out", "--quiet"], cwd=folder, stderr=subprocess.PIPE)
    said = child.stderr.read().decode()
    _, status, usage = os.wait4(child.pid, 0)
    return os.waitstatus_to_exitcode(status), time.monotonic() - begin, usage.ru_maxrss / 1024.0, said


def fit(snare, readings):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder)
        (path / "x.toml").write_text(HEAD + '[[series]]\nname = "s"\ncontact_position_mm = 60.0\nfile = "r.csv"\n')
        with open(path / "r.csv", "w", encoding="utf-8") as file:
            file.write("displacement_mm,force_N\n")
            for i in range(readings):
                d = 3.0 * i / (readings - 1)
                noise = ((i * 7919) % 1009) / 1009.0 - 0.5
                file.write(f"{d:.7f},{0.9 * d * d + 0.05 * d + 0.02 * noise:.5f}\n")
        # The timing of two threads changes the peak by some megabytes, so the smaller peak of two runs counts.
        return min((measured(snare, "fit", folder) for _ in range(2 if readings <= 100_000 else 1)), key=lambda run: run[2])


def push(snare, series):
    with tempfile.TemporaryDirectory() as folder:
        text = HEAD
        for k in range(series):
            text += f'[[series]]\nname = "s{k}"\ncontact_position_mm = {40 + 95 * k / series:.3f}\ntravel_mm = 3.0\npoints = 21\n'
        (pathlib.Path(folder) / "x.toml").write_text(text)
        return measured(snare, "push", folder)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("snare")
    parser.add_argument("--small", action="store_true")
    parser.add_argument("--results")
    options = parser.parse_args()
    snare = str(pathlib.Path(options.snare).resolve())
    sizes = [10_000, 100_000] if options.small else [10_000, 100_000, 1_000_000]
    runs = {f"fit of {n:,} readings": fit(snare, n) for n in sizes} | {"push of 1000 series": push(snare, 1000)}
    for name, (status, seconds, memory, said) in runs.items():
        print(f"{name}: status {status}, {seconds:.1f} s, {memory:.0f} MB {said[-200:]}", flush=True)
    wrong = [name for name, (status, *_) in runs.items() if status != 0]
    for n in sizes:
        itself = 30.0  # [MB] of the program without readings
        if runs[f"fit of {n:,} readings"][2] > itself + (1024.0 - itself) * n / 1e6 + (10.0 if n < 1_000_000 else 0.0):
            wrong.append(f"memory of {n:,} readings")
    if runs["push of 1000 series"][2] > 2048:
        wrong.append("memory of 1000 series")
    # Ten times the readings, at most ten times the time, and what a loaded machine adds.
    for few, many in zip(sizes, sizes[1:]):
        if runs[f"fit of {many:,} readings"][1] > 15.0 * runs[f"fit of {few:,} readings"][1] + 5.0:
            wrong.append(f"time of {many:,} readings")
    if options.results:
        with open(options.results, "w", encoding="utf-8") as file:
            json.dump({name: {"seconds": round(s, 1), "memory_MB": round(m)} for name, (_, s, m, _) in runs.items()}, file, indent=1)
            file.write("\n")
    print("; ".join(wrong) or "within the bounds")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
