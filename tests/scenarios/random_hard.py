#!/usr/bin/env python3
"""Three wires around a shaft or the cam of a grapple fixture, drawn at random: what a capture may meet.

    random_hard.py SNARE [--first K] [--count N] [--results FILE] [--keep DIR] [--jobs J]

Wires: solid or rope, 20 to 60 elements, nearer to the shaft or looser. Visitor: 10 g to 10 t at 1 mm/s to 1 m/s in any direction, its energy at most
ten times that of a wire at its strength, off centre, turning. Friction 0 to 2, in a third of the cases between the wires, too. Case K is the same on every machine. Each must do what hard.py
asks. Prints a line each and appends one to FILE (JSON), where cases that are there already are left out; exits 1 where one fails.
"""

import argparse
import concurrent.futures
import json
import math
import pathlib
import random
import sys
import tempfile

import hard

STRENGTH = 1000.0  # [N]
LENGTH = 0.180  # [m]
SAG = 18.75  # of the buckled wire [mm]
SHAFT = 6.0  # radius [mm]
WIRE = 0.75
CAM = 60.0  # height of the cam's underside above the foot [mm]


def log_uniform(rng, low, high):
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def short(value):
    return float(f"{value:.4g}") if isinstance(value, float) else value


def wire(name, turn, height, distance, rope, elements):
    """One whose chord passes the axis at `distance` [mm], bulging around its far side."""
    c, s = math.cos(turn), math.sin(turn)

    def place(x, y):
        return f"[{c * x - s * y:.6f}, {s * x + c * y:.6f}, {height}]"

    section = "construction = \"solid\""
    if rope:
        section = "construction = \"strand\"\nbending_stiffness_Nm2 = 0.0005\naxial_stiffness_N = 50000.0"
    return f"""
[[wires]]
name = "{name}"
{section}
diameter_mm = 1.5
length_mm = 180.0
youngs_modulus_GPa = 193.0
poisson_ratio = 0.29
density_kg_m3 = 7930.0
from_mm = {place(-distance, -87.5)}
to_mm = {place(-distance, 87.5)}
bulge = [{c:.9f}, {s:.9f}, 0.0]
elements = {elements}
"""


def scenario(case):
    rng = random.Random(f"hard {case}")
    rope = rng.random() < 0.5
    cam = rng.random() < 0.5
    stretch = 5e4 if rope else 3.41e5
    limit = 10.0 * STRENGTH**2 * LENGTH / (2.0 * stretch)
    while True:
        mass = log_uniform(rng, 1e-2, 1e4)
        speed = math.sqrt(2.0 * log_uniform(rng, 1e-3, 1.0) * limit / mass)
        if 1e-3 <= speed <= 1.0:
            break
    distance = rng.uniform(8.0, 11.5)
    clear = SAG - distance - SHAFT - WIRE
    way = rng.uniform(0.0, 2.0 * math.pi)
    off = rng.uniform(0.0, 0.7) * clear
    place = (off * math.cos(way), off * math.sin(way))
    # Sideways into the wires, or with the cam's underside down on them.
    above = rng.uniform(1.0, 8.0)
    direction = [rng.gauss(0.0, 1.0), rng.gauss(0.0, 1.0), 0.3 * rng.gauss(0.0, 1.0)]
    if cam:
        direction = [0.5 * direction[0], 0.5 * direction[1], -1.0]
    norm = math.sqrt(sum(d * d for d in direction))
    velocity = [speed * d / norm for d in direction]
    spin = [rng.gauss(0.0, 0.3) * speed / 0.1 for _ in range(3)]
    inertia = mass * 0.02
    stiffness = 2e5
    way = 1e-3 * (above if cam else 2.0 * clear)
    duration = min(6.0, 1.5 * way / speed + 1.5 * math.pi * math.sqrt(mass / stiffness) + 0.01)
    friction = rng.choice([0.0, 0.1, 0.3, 1.0, 2.0])
    static = max(friction, rng.choice([friction, 1.5 * friction]))
    elements = rng.choice([20, 40, 60])
    if cam:
        shape = f'kind = "grapple_shaft"\nposition_mm = [0.0, 0.0, {3.0 + WIRE + above - CAM:.3f}]'
    else:
        shape = f'kind = "cylinder"\nradius_mm = {SHAFT}\nlength_mm = 200.0'
    text = f"""schema = "snare-scenario/2"
title = "random {case}"
duration_s = {duration:.6g}
output_interval_s = {duration / 100.0:.6g}
[damping]
bending_time_s = {rng.choice([1e-5, 1e-4])}
axial_time_s = 1e-5

[[bodies]]
name = "visitor"
mass_kg = {mass:.6g}
inertia_kg_m2 = [{inertia:.6g}, {inertia:.6g}, {0.8 * inertia:.6g}]
position_mm = [{place[0]:.6f}, {place[1]:.6f}, 0.0]
velocity_m_s = [{velocity[0]:.6g}, {velocity[1]:.6g}, {velocity[2]:.6g}]
spin_rad_s = [{spin[0]:.6g}, {spin[1]:.6g}, {spin[2]:.6g}]

[[shapes]]
name = "fixture"
body = "visitor"
{shape}
friction = {friction}
static_friction = {static}
"""
    for k, name in enumerate(("first", "second", "third")):
        text += wire(name, 2.0 * math.pi * k / 3.0, 3.0 * (k - 1), distance, rope, elements)
    pairs = rng.random() < 0.3
    for one, other in (("first", "second"), ("second", "third"), ("first", "third")) if pairs else ():
        text += f'''
[[contacts]]
name = "{one}_{other}"
wire = "{one}"
other_wire = "{other}"
friction = {friction}
static_friction = {static}
'''
    facts = {"pairs": pairs, "rope": rope, "cam": cam, "mass_kg": mass, "speed_m_s": speed, "friction": friction, "elements": elements,
             "duration_s": duration}
    return text, facts


def run(snare, case, keep):
    text, facts = scenario(case)
    with tempfile.TemporaryDirectory() as out:
        file = pathlib.Path(keep or out) / f"random_{case}.toml"
        file.write_text(text)
        problem, summary = hard.problems(snare, file, str(pathlib.Path(out) / "out"))
    peak = max((c["peak_force_N"] for c in summary.get("contacts", [])), default=None)
    return {"case": case, "problem": problem, **facts, "steps": summary.get("steps"), "starts": summary.get("restarts"),
            "peak_force_N": peak, "wall_s": summary.get("wall_s")}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("snare")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--results", type=pathlib.Path)
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the scenario files")
    parser.add_argument("--jobs", type=int, default=1)
    a = parser.parse_args()
    done = set()
    if a.results and a.results.exists():
        done = {json.loads(line)["case"] for line in a.results.read_text().splitlines()}
    cases = [k for k in range(a.first, a.first + a.count) if k not in done]
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
        for result in pool.map(lambda k: run(a.snare, k, a.keep), cases):
            failed += result["problem"] is not None
            print(f"{result['case']:4} {result['problem'] or 'ok':50} {result['steps']} steps, {result['wall_s']} s",
                  flush=True)
            if a.results:
                with a.results.open("a") as file:
                    file.write(json.dumps({key: short(value) for key, value in result.items()}) + "\n")
    print(f"{failed} of {len(cases)} failed")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
