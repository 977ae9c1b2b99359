#!/usr/bin/env python3
"""Runs the benchmarks and stores what they measured: benchmarks/record.py BUILD_DIRECTORY RESULT.json [--load LIMIT] [PROGRAM...]

BUILD_DIRECTORY is that of the release preset. Each benchmark runs five times and its median is stored, with processor,
compiler and commit; names of the machine and of its folders are left out. Refuses a busy machine.
"""

import argparse
import json
import os
import pathlib
import platform
import re
import subprocess
import sys
import tempfile
import time

REPETITIONS = 5
PROGRAMS = ("push_benchmark", "linear_solver_benchmark")
# What Google Benchmark says about the machine that is not about its speed.
PRIVATE = ("host_name", "executable", "load_avg", "library_build_type")


def processor():
    text = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8")
    match = re.search(r"^model name\s*:\s*(.*)$", text, re.MULTILINE)
    return match.group(1) if match else platform.machine()


def first_line(*command, cwd=None):
    return subprocess.run(command, cwd=cwd, check=True, capture_output=True, text=True).stdout.splitlines()[0]


def commit(source):
    name = first_line("git", "rev-parse", "--short=12", "HEAD", cwd=source)
    changed = subprocess.run(
        ["git", "status", "--porcelain", "--", "*.cpp", "*.hpp", "*CMakeLists.txt"],
        cwd=source, check=True, capture_output=True, text=True,
    ).stdout
    return name + (" with changes" if changed.strip() else "")


def wait_for_rest(limit):
    """Waits up to ten minutes for the load of the last minute to fall below the limit."""
    for _ in range(60):
        if os.getloadavg()[0] <= limit:
            return
        time.sleep(10)
    sys.exit(f"the machine is busy (load {os.getloadavg()[0]:.2f}, limit {limit})")


def run(program, directory):
    with tempfile.TemporaryDirectory() as scratch:
        out = pathlib.Path(scratch) / "result.json"
        subprocess.run(
            [directory / "benchmarks" / program, f"--benchmark_repetitions={REPETITIONS}",
             "--benchmark_report_aggregates_only=true", f"--benchmark_out={out}", "--benchmark_out_format=json"],
            check=True, stdout=subprocess.DEVNULL,
        )
        return json.loads(out.read_text(encoding="utf-8"))


def kept(entry):
    """The median of a benchmark, and its scatter; nothing of the other aggregates."""
    # A counter that every run has alike has no scatter worth a line.
    dropped = {"family_index", "per_family_instance_index", "repetition_index", "threads", "run_type", "run_name",
               "aggregate_unit", "repetitions"}
    return {key: value for key, value in entry.items() if key not in dropped}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("result", type=pathlib.Path)
    parser.add_argument("--programs", nargs="+", default=PROGRAMS, help="benchmarks to run")
    parser.add_argument("--load", type=float, default=0.7, help="highest load of the machine at the start")
    arguments = parser.parse_args()
    source = pathlib.Path(__file__).resolve().parent.parent

    wait_for_rest(arguments.load)
    load = os.getloadavg()[0]
    context = None
    entries = []
    for program in arguments.programs:
        result = run(program, arguments.build)
        context = context or {key: value for key, value in result["context"].items() if key not in PRIVATE}
        for entry in result["benchmarks"]:
            if entry.get("error_occurred"):
                sys.exit(f"{entry['name']}: {entry['error_message']}")
            if entry.get("aggregate_name") in ("median", "BigO", "cv"):
                entries.append({"program": program, **kept(entry)})

    cache = (arguments.build / "CMakeCache.txt").read_text(encoding="utf-8")
    compiler = re.search(r"^CMAKE_CXX_COMPILER:\w+=(.*)$", cache, re.MULTILINE).group(1)
    flags = re.search(r"^CMAKE_CXX_FLAGS_RELEASE:\w+=(.*)$", cache, re.MULTILINE).group(1)
    context.update(
        processor=processor(), compiler=first_line(compiler, "--version"), flags=flags, commit=commit(source),
        repetitions=REPETITIONS, load_at_the_start=round(load, 2),
    )
    arguments.result.parent.mkdir(parents=True, exist_ok=True)
    text = json.dumps({"context": context, "benchmarks": entries}, indent=1)
    arguments.result.write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
