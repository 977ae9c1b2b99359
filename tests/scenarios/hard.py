#!/usr/bin/env python3
"""Runs scenarios in which contact is hard: shafts, cams and ropes where a snare works.

    hard.py SNARE FILE.toml...

Each must finish, with no second of simulated time that takes more than 60 s of the processor, at most 50 starts of the integrator beside
those at checkpoints, finite numbers, and the energy that the integrator gained or lost below a hundredth of the largest energy. Prints a line each; exits 1
where one does not hold.
"""

import json
import math
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile
import tomllib


def numbers(value):
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        for item in value:
            yield from numbers(item)
    elif isinstance(value, float):
        yield value


def problems(snare, file, out):
    duration = tomllib.loads(file.read_text())["duration_s"]
    limit = math.ceil(60.0 * max(1.0, duration))
    try:
        run = subprocess.run([snare, "simulate", file, "--out", out, "--quiet"], capture_output=True, text=True,
                             preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 5)),
                             timeout=10.0 * limit, check=False)  # others may have the machine
    except subprocess.TimeoutExpired:
        return "no end in time", {}
    if run.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return "no end in time", {}
    if run.returncode != 0:
        return f"exit {run.returncode}: {run.stderr.strip()}", {}
    summary = json.loads((pathlib.Path(out) / "summary.json").read_text())
    energy = summary["energy_J"]
    largest = max(abs(energy[name]) for name in ("kinetic", "strain", "dissipated", "work"))
    if not all(map(math.isfinite, numbers(summary))):
        return "a number is not finite", summary
    if summary["restarts"] > 50 + duration / min(1.0, duration / 10.0):
        return f"{summary['restarts']} starts", summary
    if abs(energy["integrator"]) > 1e-2 * largest:
        return f"energy gained {energy['integrator']:.3g} J of {largest:.3g} J", summary
    return None, summary


def main():
    snare, failed = sys.argv[1], False
    for name in sys.argv[2:]:
        file = pathlib.Path(name)
        with tempfile.TemporaryDirectory() as out:
            problem, summary = problems(snare, file, out)
        failed = failed or problem is not None
        cost = f"{summary['steps']} steps, {summary['wall_s']:.1f} s" if summary else ""
        print(f"{file.stem:14} {problem or 'ok':40} {cost}", flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
