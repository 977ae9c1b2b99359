#!/usr/bin/env python3
"""What Python costs: Law.force beside the same loop in C++, a push beside the command, an interrupt.

usage: PYTHONPATH=build/release/python /usr/bin/python3 benchmarks/python_overhead.py build/release [RESULTS.json]

The loop in C++ is `law_benchmark`, on the same points of the same law.json. All times are medians of runs that take turns, and every
pair is reported with its quartiles: the machine is shared.
"""

import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np
import snare

SOURCE = pathlib.Path(__file__).parents[1]
POINTS = 1_000_000


def quartiles(times: list) -> dict:
    low, middle, high = statistics.quantiles(times, n=4)
    return {"median_s": middle, "lower_quartile_s": low, "upper_quartile_s": high, "runs": len(times)}


def law_force(build: pathlib.Path, folder: pathlib.Path) -> dict:
    """A million points drawn from the whole range, by either."""
    subprocess.run([build / "snare", "distil", SOURCE / "data/wires/traced_published.toml", "--out", folder, "--quiet"], check=True)
    law = snare.Law(folder / "law.json")
    random = np.random.default_rng(1)
    points = np.stack([random.uniform(*range_, POINTS) for range_ in (law.travel, law.position, law.slack)])
    points.tofile(folder / "points.bin")
    theirs, ours = [], []
    for _ in range(9):
        run = subprocess.run([build / "benchmarks/law_benchmark", folder / "law.json", folder / "points.bin"], check=True,
                             capture_output=True, text=True)
        answer = json.loads(run.stdout)
        theirs.append(answer["seconds"])
        begin = time.perf_counter()
        force = law.force(*points)
        ours.append(time.perf_counter() - begin)
        assert abs(force.sum() - answer["sum_N"]) <= 1e-9 * abs(force.sum()), "both compute the same"
    return {"points": POINTS, "cpp": quartiles(theirs), "python": quartiles(ours),
            "ratio_of_medians": statistics.median(ours) / statistics.median(theirs)}


def push(build: pathlib.Path, folder: pathlib.Path) -> dict:
    """One push of some seconds, whole processes: both read the file, compute, and give the curves."""
    text = (SOURCE / "examples/push.toml").read_text().split("[[series]]")[0]
    text += ('[solver]\nelements = 4096\n[[series]]\nname = "quarter"\ncontact_position_mm = 45.0\ntravel_mm = 3.0\npoints = 400\n')
    file = folder / "push.toml"
    file.write_text(text)
    theirs, ours, processes = [], [], []
    program = f"import snare; snare.push({str(file)!r}, threads=1)"
    for _ in range(7):
        begin = time.perf_counter()
        subprocess.run([build / "snare", "push", file, "--out", folder / "push", "--quiet", "--threads", "1"], check=True)
        theirs.append(time.perf_counter() - begin)
        begin = time.perf_counter()
        snare.push(file, threads=1)
        ours.append(time.perf_counter() - begin)
        begin = time.perf_counter()
        subprocess.run([sys.executable, "-c", program], check=True)
        processes.append(time.perf_counter() - begin)
    return {"command": quartiles(theirs), "call": quartiles(ours), "process_with_import": quartiles(processes),
            "call_over_command": statistics.median(ours) / statistics.median(theirs),
            "process_over_command": statistics.median(processes) / statistics.median(theirs)}


def main() -> int:
    if len(sys.argv) not in (2, 3):
        print(__doc__, file=sys.stderr)
        return 2
    build = pathlib.Path(sys.argv[1])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        result = {"version": snare.__version__, "law_force": law_force(build, folder), "push": push(build, folder)}
    text = json.dumps(result, indent=1) + "\n"
    print(text, end="")
    if len(sys.argv) == 3:
        pathlib.Path(sys.argv[2]).write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
