#!/usr/bin/env python3
"""Checks that a sweep by several ranks gives the bytes of one process, also after ranks were killed.

usage: ranks.py SNARE [--kills N]

Without mpirun, or where the command was built without MPI, it says so and ends well. N (8): how often all ranks are killed at
a random moment and the same command is given again.
"""

import argparse
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from wire_text import experiment

EXPERIMENT = experiment("push", 180.0) + """[[series]]
name = "middle"
contact_position_mm = 87.5
travel_mm = 1.5
points = 5
"""
SWEEP = """schema = "snare-sweep/1"
case = "one.toml"
design = "sobol"
cases = 2000
[[vary]]
key = "wire.length_mm"
uniform = [179.0, 181.0]
[[vary]]
key = "wire.diameter_mm"
normal = { mean = 1.5, sigma = 0.01 }
[collect]
force = "series[middle].largest_force_N"
[histories]
columns = ["force_N"]
"""
# Of a refined grid the next cases depend on the last ones.
REFINED = """schema = "snare-sweep/1"
case = "one.toml"
design = "grid"
[[vary]]
key = "wire.length_mm"
range = [175.4, 183.4]
points = 33
[[vary]]
key = "wire.diameter_mm"
range = [0.5, 2.1]
points = 17
[collect]
force = "series[middle].largest_force_N"
[refine]
of = "force"
levels = 2
differs_by = 80.0
"""
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")
failures = []


def check(condition: bool, what: str) -> None:
    print(("  ok  " if condition else "WRONG ") + what, flush=True)
    if not condition:
        failures.append(what)


def mpirun(snare: str, ranks: int, out: str, *more: str, sweep: str = "sweep.toml") -> list[str]:
    return ["mpirun", "--oversubscribe", *more, "-n", str(ranks), snare, "sweep", sweep, "--out", out, "--quiet"]


def ranks_of(launcher: subprocess.Popen) -> list[int]:
    """The processes that an mpirun has started."""
    children = pathlib.Path(f"/proc/{launcher.pid}/task/{launcher.pid}/children")
    return [int(pid) for pid in children.read_text().split()] if children.exists() else []


def rank_of(pid: int) -> int:
    for entry in pathlib.Path(f"/proc/{pid}/environ").read_bytes().split(b"\0"):
        if entry.startswith(b"OMPI_COMM_WORLD_RANK="):
            return int(entry.split(b"=")[1])
    return -1


def numbers_in(journal: pathlib.Path) -> list[str]:
    return [line.split()[0] for line in journal.read_text().splitlines()[1:]]


def journal_is_whole(file: pathlib.Path, cases: int) -> bool:
    numbers = numbers_in(file)
    return len(numbers) == len(set(numbers)) == cases


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("snare")
    parser.add_argument("--kills", type=int, default=8)
    options = parser.parse_args()
    snare = str(pathlib.Path(options.snare).resolve())
    if shutil.which("mpirun") is None or not (pathlib.Path(snare).parent / "snare_mpi.so").exists():
        print("no mpirun, or built without MPI: nothing to check")
        return 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "one.toml").write_text(EXPERIMENT)
        (folder / "sweep.toml").write_text(SWEEP)

        def run(command: list[str]) -> int:
            return subprocess.run(command, cwd=folder, env=ENVIRONMENT, timeout=600).returncode

        check(run([snare, "sweep", "sweep.toml", "--out", "whole", "--quiet"]) == 0, "one process")

        def written(out: str) -> tuple[bytes, bytes]:
            return (folder / out / "cases.csv").read_bytes(), (folder / out / "histories.h5").read_bytes()

        whole = written("whole")

        for ranks in (1, 2, 4):
            begin = time.monotonic()
            status = run(mpirun(snare, ranks, f"r{ranks}"))
            print(f"       {ranks} ranks: {time.monotonic() - begin:.1f} s")
            check(status == 0 and written(f"r{ranks}") == whole, f"{ranks} ranks, same bytes")

        (folder / "refined.toml").write_text(REFINED)
        check(run([snare, "sweep", "refined.toml", "--out", "grid", "--quiet"]) == 0, "a refined grid")
        check(run(mpirun(snare, 3, "grid3", sweep="refined.toml")) == 0 and
              (folder / "grid3/cases.csv").read_bytes() == (folder / "grid/cases.csv").read_bytes(), "3 ranks, same bytes")
        finished = len(numbers_in(folder / "grid3/cases.journal"))
        check(40 < finished < 33 * 17, f"{finished} of {33 * 17} cases were run")

        # All ranks at once, at random moments.
        chance = random.Random(1)
        for _ in range(options.kills):
            launcher = subprocess.Popen(mpirun(snare, 2, "killed"), cwd=folder, env=ENVIRONMENT,
                                        stderr=subprocess.DEVNULL)
            time.sleep(chance.uniform(0.3, 2.0))
            for pid in ranks_of(launcher):
                os.kill(pid, signal.SIGKILL)
            launcher.wait(timeout=120)
        check(run(mpirun(snare, 2, "killed")) == 0, "goes on after kills of all ranks")
        check(written("killed") == whole, "same bytes after them")
        check(journal_is_whole(folder / "killed/cases.journal", 2000), "no case twice or lost")

        # One rank that is not the first: the others run its cases, where the launcher lets them.
        launcher = subprocess.Popen(mpirun(snare, 3, "lost", "--enable-recovery"), cwd=folder, env=ENVIRONMENT,
                                    stderr=subprocess.DEVNULL)
        time.sleep(1.5)
        for pid in ranks_of(launcher):
            if rank_of(pid) == 1:
                os.kill(pid, signal.SIGKILL)
        try:
            launcher.wait(timeout=120)
        except subprocess.TimeoutExpired:
            launcher.kill()
        there = (folder / "lost/histories.h5").exists()
        print(f"       a rank killed: the others {'finished' if there else 'were ended by the launcher'}")
        if not there:
            check(run(mpirun(snare, 2, "lost")) == 0, "goes on after a kill of one rank")
        check(written("lost") == whole, "same bytes after a kill of one rank")
        check(journal_is_whole(folder / "lost/cases.journal", 2000), "no case twice or lost")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
