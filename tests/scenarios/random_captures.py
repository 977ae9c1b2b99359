#!/usr/bin/env python3
"""Runs the shipped capture from random starts, with one or more models of its wires: random_captures.py SNARE [--starts N] [--seed S]
[--models a,b] [--scenario FILE] [--results FILE].

A start is off by up to 70 mm across the snare's axis and 10 degrees about an axis across it, and moves at 0.5 to 2 times its speed.
Every run must finish (or be refused because the shaft stands in a wire), close its energy within 1e-3 of the work and keep its momentum within
1e-7 of the visitor's. What does not at the default tolerances is run again with a tenth of them ("finer").
A line of JSON for every run; the summary says how many were caught and where models disagree.
"""

import argparse
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

NOT_CLOSED = "energy or momentum are not kept"
FINER = ["solver.position_tolerance_m=3e-8", "solver.velocity_tolerance_m_s=3e-4", "solver.quasi_static_velocity_tolerance_m_s=1e-5",
         "solver.body_position_tolerance_m=1e-9",
         "solver.body_velocity_tolerance_m_s=1e-7", "solver.body_angle_tolerance_rad=1e-8", "solver.body_spin_tolerance_rad_s=1e-6"]
ENERGY_SHARE = 1e-3
MOMENTUM_SHARE = 1e-7


def start_of(rng):
    """Numbers of one start: offsets [mm], tilt [deg] with its direction, factor of the speed."""
    angle, radius = rng.uniform(0.0, 2.0 * math.pi), 70.0 * math.sqrt(rng.random())
    return {"x_mm": radius * math.cos(angle), "y_mm": radius * math.sin(angle), "tilt_deg": rng.uniform(0.0, 10.0),
            "azimuth_deg": rng.uniform(0.0, 360.0), "speed": math.exp(rng.uniform(math.log(0.5), math.log(2.0)))}


def settings(start, model):
    """What --set is told. The visitor's centre of mass is 5.2 m behind the shaft: it is turned about the shaft."""
    tilt, azimuth = math.radians(start["tilt_deg"]), math.radians(start["azimuth_deg"])
    turn = [start["tilt_deg"] * math.cos(azimuth), start["tilt_deg"] * math.sin(azimuth), 0.0]
    arm = 5200.0
    place = [start["x_mm"] + arm * math.sin(tilt) * math.sin(azimuth), start["y_mm"] - arm * math.sin(tilt) * math.cos(azimuth),
             arm * math.cos(tilt)]
    return [f'snares[snare].wire.model="{model}"', f"bodies[htv].position_mm={place}", f"bodies[htv].rotation_deg={turn}",
            f"bodies[htv].velocity_m_s=[{0.01 * start['speed']}, 0.0, 0.0]"]


def run(snare, scenario, start, model, seconds):
    """What a start comes to; where energy or momentum are not kept, followed ten times as closely."""
    result = run_once(snare, scenario, start, settings(start, model), seconds)
    if result.get("fault") == NOT_CLOSED:
        result = {**run_once(snare, scenario, start, settings(start, model) + FINER, seconds), "finer": True}
    return result


def run_once(snare, scenario, start, told, seconds):
    with tempfile.TemporaryDirectory() as folder:
        command = [snare, "simulate", str(scenario), "--quiet", "--out", folder + "/out"]
        for setting in told:
            command += ["--set", setting]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=seconds)
        except subprocess.TimeoutExpired:
            return {"status": "time", "fault": f"more than {seconds} s"}
        if done.returncode == 2 and "must be >= 0 m at the start" in done.stderr:
            return {"status": 2}
        if done.returncode != 0:
            return {"status": done.returncode, "fault": done.stderr.strip().splitlines()[-1:]}
        summary = json.loads(pathlib.Path(folder, "out", "summary.json").read_text())
    outcome, energy = summary["outcome"], summary["energy_J"]
    result = {"status": 0, "caught": outcome["caught"], "enclosed": outcome["enclosed"], "wall_s": summary["wall_s"],
              "peak_tension_N": max(outcome["peak_tension_N"].values()), "tight_s": outcome["tight_s"],
              "energy_share": abs(energy["integrator"]) / max(abs(energy["work"]), 1e-3)}
    momentum = math.dist(summary["momentum_error_Ns"], [0.0, 0.0, 0.0])
    result["momentum_share"] = momentum / (16000.0 * 0.01 * start["speed"])
    if result["energy_share"] > ENERGY_SHARE or result["momentum_share"] > MOMENTUM_SHARE:
        result["fault"] = NOT_CLOSED
    return result


def main():
    root = pathlib.Path(__file__).resolve().parents[2]
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("snare")
    parser.add_argument("--starts", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--models", default="stretched")
    parser.add_argument("--scenario", default=root / "data/scenarios/ssrms_htv_capture.toml")
    parser.add_argument("--seconds", type=float, default=600.0)
    parser.add_argument("--results")
    options = parser.parse_args()
    rng = random.Random(options.seed)
    models = options.models.split(",")
    counts = {model: {"caught": 0, "lost": 0, "refused": 0, "faults": 0} for model in models}
    differ, lines = 0, []
    for k in range(options.starts):
        start = start_of(rng)
        outcomes = set()
        for model in models:
            result = run(options.snare, options.scenario, start, model, options.seconds)
            lines.append(json.dumps({"start": k, **start, "model": model, **result}))
            if "fault" in result:
                counts[model]["faults"] += 1
                print(lines[-1], file=sys.stderr)
            if result["status"] == 2:
                counts[model]["refused"] += 1
            elif result["status"] == 0:
                counts[model]["caught" if result["caught"] else "lost"] += 1
                outcomes.add(result["caught"])
        differ += len(outcomes) > 1
    if options.results:
        pathlib.Path(options.results).write_text("".join(line + "\n" for line in lines))
    print(json.dumps({"starts": options.starts, "seed": options.seed, "models": counts, "different_outcomes": differ}))
    return 1 if any(c["faults"] for c in counts.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
