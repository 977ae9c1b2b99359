"""snare as a solver of cosseratbench 0.3.0, and one experiment with snare or with a solver that cosseratbench includes.

usage: cosserat_snare.py EXPERIMENT '{"solver": "snare" | "mujoco" | "pyelastica", "n_elements": N}'

A wire of snare has two mounts and starts at rest between them. A free end is therefore clamped to a light body, and experiments that start from a
prescribed shape cannot be expressed; Snare.run gives the reason.
"""

import dataclasses
import json
import math
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np
from cosseratbench.registry import load_experiment, load_solver
from cosseratbench.scenario import End, EndCondition, parallel_transport
from cosseratbench.solver import Capability
from cosseratbench.trajectory import Trajectory

COMMAND = os.environ.get("SNARE_COMMAND", str(pathlib.Path(__file__).parents[2] / "build/release/snare"))


def vector(values, scale=1.0):
    return "[" + ", ".join(repr(float(v) * scale) for v in values) + "]"


class Snare:
    name = "snare"
    capabilities = frozenset({Capability.STRETCH})

    def run(self, scenario, *, n_elements, n_frames):
        rod = scenario.rods[0]
        straight = len(rod.centerline) == 2
        sags = rod.start is EndCondition.PINNED and rod.end is EndCondition.PINNED
        if scenario.obstacles or rod.start is EndCondition.FREE:
            raise NotImplementedError("a wire has two mounts and starts at rest between them")
        if rod.motion(End.START) or rod.motion(End.END):
            raise NotImplementedError("ends that slide under a load; a wire starts without the initial bow")
        if len(scenario.rods) > 1:
            raise NotImplementedError("wires start at rest, without the prescribed gap between the ropes")
        if not (straight or sags) or not scenario.quasi_static:
            raise NotImplementedError("a wire starts at rest, without a prescribed shape")
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder)
            (path / "scenario.toml").write_text(self.scenario_file(scenario, n_elements, n_frames))
            run = subprocess.run([COMMAND, "simulate", str(path / "scenario.toml"), "--out", str(path / "out"), "--threads", "1", "--quiet"],
                                 capture_output=True, text=True)
            if run.returncode:
                raise RuntimeError(run.stderr.strip().splitlines()[-1])
            frames = np.array([points(file) for file in sorted((path / "out").glob("motion_*.vtp"))])
        frames = frames[:, :n_elements + 1]
        directors = np.array([parallel_transport(frame, np.asarray(rod.normal, dtype=float)) for frame in frames])
        return Trajectory(np.linspace(0.0, scenario.duration, len(frames)), (frames,), (directors,))

    def scenario_file(self, scenario, n_elements, n_frames):
        rod, material = scenario.rods[0], scenario.rods[0].material
        start, end = np.asarray(rod.centerline[0]), np.asarray(rod.centerline[-1])
        tip = rod.end is EndCondition.FREE
        down = np.asarray(scenario.gravity)
        across = down if np.any(down) else np.asarray(rod.normal)
        mount = "clamped" if rod.start is EndCondition.CLAMPED else "pinned"
        slow = 2 * scenario.slowest_frequency()  # critical damping of the slowest mode
        text = f"""schema = "snare-scenario/2"
title  = "cosseratbench"
duration_s        = {scenario.duration}
output_interval_s = {scenario.duration / (n_frames - 1)!r}
[gravity]
vector_m_s2 = {vector(down)}
{"" if tip else f'''[damping]
mass_rate_1_s = {slow!r}
'''}
[output]
paraview = true
[[wires]]
name                      = "rod"
construction              = "solid"
diameter_mm               = {2e3 * rod.radius!r}
length_mm                 = {1e3 * rod.length!r}
youngs_modulus_GPa        = {1e-9 * material.youngs_modulus!r}
poisson_ratio             = {min(0.5, material.youngs_modulus / (2 * material.shear_modulus) - 1)!r}
torsional_stiffness_Nm2   = {material.shear_modulus * 2 * rod.second_moment_of_area!r}
density_kg_m3             = {material.density!r}
mount                     = "{mount}"
bulge                     = {vector(across)}
elements                  = {n_elements}
from_mm                   = {vector(start, 1e3)}
"""
        if not tip:
            return text + f"to_mm = {vector(end, 1e3)}\n"
        weight = material.density * rod.area * rod.length  # of the rod [kg]; the tip's body is to be slow enough for drag to settle it
        stiffness = 3 * material.youngs_modulus * rod.second_moment_of_area / rod.length**3
        load = sum((np.asarray(l.force) for l in rod.loads if l.at is End.END), np.zeros(3))
        return text + f"""to_frame = "tip"
to_mm    = [0.0, 0.0, 0.0]
[[bodies]]
name          = "tip"
mass_kg       = {0.01 * weight!r}
inertia_kg_m2 = {vector([1e-4 * weight * rod.length**2] * 3)}
position_mm   = {vector(end, 1e3)}
force_N       = {vector(load)}
drag_Ns_m     = {2 * math.sqrt(stiffness * 0.25 * weight)!r}
"""


def points(file):
    """Points of a frame [m]."""
    text = file.read_text()
    array = re.search(r"<Points>.*?<DataArray[^>]*>(.*?)</DataArray>", text, re.S).group(1)
    return np.array(array.split(), dtype=float).reshape(-1, 3)


def used():
    mine, children = time.process_time(), resource.getrusage(resource.RUSAGE_CHILDREN)
    return mine + children.ru_utime + children.ru_stime


def main():
    experiment = load_experiment(sys.argv[1])
    wanted = json.loads(sys.argv[2]) if len(sys.argv) > 2 else {"solver": "snare"}
    solver = Snare() if wanted["solver"] == "snare" else load_solver(wanted["solver"])
    elements = wanted.get("n_elements", experiment.n_elements)
    scenario = experiment.scenario
    if wanted["solver"] == "pyelastica":  # code that is compiled when it is first called
        solver.run(dataclasses.replace(scenario, duration=1e-3 * scenario.duration), n_elements=elements, n_frames=2)
    begin = used()
    try:
        trajectory = solver.run(scenario, n_elements=elements, n_frames=experiment.n_frames)
    except (NotImplementedError, FloatingPointError) as reason:
        print("RESULT " + json.dumps({"reason": str(reason)}))
        return
    print("RESULT " + json.dumps({"metrics": {name: float(metric(scenario, trajectory)) for name, metric in experiment.metrics.items()},
                                  "processor_s": used() - begin}))


if __name__ == "__main__":
    main()
