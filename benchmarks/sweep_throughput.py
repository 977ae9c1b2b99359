#!/usr/bin/env python3
"""How many captures a sweep makes a second, by threads: data/sweeps/capture_odds.toml, 30 s a capture, strings for wires.

usage: sweep_throughput.py SNARE [--cases N] [--threads N ...] [--out RESULT.json]

The efficiency is that of the first number of threads times its own over it: seconds of one thread over N times those of N. On a machine that is
shared it says little.
"""

import argparse
import json
import os
import pathlib
import subprocess
import tempfile
import time

SWEEP = pathlib.Path(__file__).parents[1] / "data/sweeps/capture_odds.toml"


def seconds_of(snare, cases, threads):
    """Wall time [s] of a whole sweep."""
    with tempfile.TemporaryDirectory() as folder:
        begin = time.monotonic()
        subprocess.run([snare, "sweep", SWEEP, "--out", folder, "--threads", str(threads), "--set", f"cases={cases}", "--quiet"], check=True)
        return time.monotonic() - begin


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("snare")
    parser.add_argument("--cases", type=int, default=200)
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--out", type=pathlib.Path)
    options = parser.parse_args()
    rows = []
    for threads in options.threads:
        seconds = seconds_of(options.snare, options.cases, threads)
        first = rows[0] if rows else {"threads": threads, "seconds": seconds}
        rows.append({"threads": threads, "seconds": seconds, "seconds_2000": seconds * 2000 / options.cases,
                     "efficiency": first["seconds"] * first["threads"] / (seconds * threads)})
        print("{threads} threads: {seconds:.1f} s for {cases} captures, {seconds_2000:.0f} s for 2000, efficiency {efficiency:.3f}".format(
            cases=options.cases, **rows[-1]), flush=True)
    if options.out:
        options.out.write_text(json.dumps({"sweep": SWEEP.name, "cases": options.cases, "load": os.getloadavg()[0], "runs": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
