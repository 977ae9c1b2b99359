"""snare as a solver of cosseratbench 0.3.0, and one experiment with snare or with a solver that cosseratbench includes.

usage: cosserat_snare.py EXPERIMENT '{"solver": "snare" | "mujoco" | "pyelastica", "n_elements": N}'

Every rod begins on the line that the experiment gives it. A free end that bears a load is clamped to a light body, and an end that slides and turns is on
an arm of a slide and a hinge. Snare.run gives the reason where an experiment cannot be expressed.
"""

import dataclasses
import itertools
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


def turned_to(axis):
    """Rotation vector [deg] that takes z to an axis."""
    across = np.cross([0.0, 0.0, 1.0], axis)
    size = np.linalg.norm(across)
    if size < 1e-12:
        return [0.0 if axis[2] > 0 else 180.0, 0.0, 0.0]
    return across / size * math.degrees(math.atan2(size, axis[2]))


# An arm that slides along x and turns about it, of little mass and stiff gears.
CLAMP = """schema = "snare-arm/1"
title = "a clamp that slides and turns"
urdf = "clamp.urdf"
tip = "clamp"
[every_joint]
law = "linear"
stiffness_Nm_rad = 1e3
damping_Nms_rad = 10.0
motor_inertia_kg_m2 = 1e-3
drive = "limp"
[[pose]]
name = "start"
angles_deg = [0, 0]
"""
CLAMP_URDF = """<robot name="clamp"><link name="guide"/>
<link name="slide"><inertial><mass value="1e-3"/><inertia ixx="1e-7" ixy="0" ixz="0" iyy="1e-7" iyz="0" izz="1e-7"/></inertial></link>
<link name="clamp"><inertial><mass value="1e-3"/><inertia ixx="1e-7" ixy="0" ixz="0" iyy="1e-7" iyz="0" izz="1e-7"/></inertial></link>
<joint name="along" type="prismatic"><parent link="guide"/><child link="slide"/><axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1e5" velocity="10"/></joint>
<joint name="about" type="continuous"><parent link="slide"/><child link="clamp"/><axis xyz="1 0 0"/></joint>
</robot>
"""


class Snare:
    name = "snare"
    capabilities = frozenset({Capability.STRETCH, Capability.ROD_CONTACT})

    def run(self, scenario, *, n_elements, n_frames):
        if scenario.self_contact and scenario.obstacles:
            raise NotImplementedError("a wire does not touch itself, as the loops of the heap do")
        if any(not m.slides_along or not np.allclose(m.axis, [1, 0, 0]) for r in scenario.rods for e in End for m in [r.motion(e)] if m):
            raise NotImplementedError("an end that is moved, but for one that slides along x and turns about it")
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder)
            (path / "scenario.toml").write_text(self.scenario_file(scenario, n_elements, n_frames, path))
            run = subprocess.run([COMMAND, "simulate", str(path / "scenario.toml"), "--out", str(path / "out"), "--threads", "1", "--quiet"],
                                 capture_output=True, text=True)
            if run.returncode:
                raise RuntimeError(run.stderr.strip().splitlines()[-1])
            frames = np.array([points(file) for file in sorted((path / "out").glob("motion_*.vtp"))])
        of_rods = [frames[:, k * (n_elements + 1):(k + 1) * (n_elements + 1)] for k in range(len(scenario.rods))]
        directors = [np.array([parallel_transport(frame, np.asarray(rod.normal, dtype=float)) for frame in positions])
                     for rod, positions in zip(scenario.rods, of_rods)]
        return Trajectory(np.linspace(0.0, scenario.duration, len(frames)), tuple(of_rods), tuple(directors))

    def scenario_file(self, scenario, n_elements, n_frames, path):
        ends_move = any(r.motion(e) or r.loads for r in scenario.rods for e in End)
        text = f"""schema = "snare-scenario/2"
title  = "cosseratbench"
duration_s        = {scenario.duration}
output_interval_s = {scenario.duration / (n_frames - 1)!r}
[gravity]
vector_m_s2 = {vector(scenario.gravity)}
[damping]
{self.damping(scenario, ends_move)}
{"" if scenario.quasi_static else UNDAMPED}
[output]
paraview = true
"""
        for k, rod in enumerate(scenario.rods):
            text += self.rod(k, rod, n_elements, path)
        for k, obstacle in enumerate(scenario.obstacles):
            text += self.cylinder(k, obstacle)
        for a, b in itertools.combinations(range(len(scenario.rods)), 2):
            if nearest(scenario.rods[a], scenario.rods[b]) < 10 * scenario.rods[a].radius:
                text += f"""[[contacts]]
name       = "contact {a} {b}"
wire       = "rod_{a}"
other_wire = "rod_{b}"
friction   = {max(scenario.rods[a].friction, scenario.rods[b].friction)}
"""
        return text

    def damping(self, scenario, ends_move):
        """Where equilibrium is the result: critical for the slowest mode, by drag, or in bending where the drag's world is not that of the mounts."""
        if not scenario.quasi_static:
            return "bending_time_s = 0.0\naxial_time_s = 0.0"
        slow = scenario.slowest_frequency()
        tips = all(r.end is EndCondition.FREE for r in scenario.rods)
        if not ends_move:
            return f"mass_rate_1_s = {2 * slow!r}"
        return "" if tips else f"bending_time_s = {0.1 / slow!r}"

    def rod(self, k, rod, n_elements, path):
        material = rod.material
        np.savetxt(path / f"rod_{k}.csv", 1e3 * np.column_stack([rod._arc(), rod.centerline]), "%.17g", ",", header="s_mm,x_mm,y_mm,z_mm", comments="")
        loads = {end: sum((np.asarray(l.force) for l in rod.loads if l.at is end), np.zeros(3)) for end in End}
        tip = rod.end is EndCondition.FREE and np.any(loads[End.END])
        ends = {EndCondition.CLAMPED: "clamped", EndCondition.PINNED: "pinned", EndCondition.FREE: "free"}
        text = f"""[[wires]]
name                    = "rod_{k}"
construction            = "solid"
diameter_mm             = {2e3 * rod.radius!r}
youngs_modulus_GPa      = {1e-9 * material.youngs_modulus!r}
poisson_ratio           = {min(0.5, material.youngs_modulus / (2 * material.shear_modulus) - 1)!r}
torsional_stiffness_Nm2 = {material.shear_modulus * 2 * rod.second_moment_of_area!r}
density_kg_m3           = {material.density!r}
elements                = {n_elements}
shape_file              = "rod_{k}.csv"
ends                    = {{ left = "{ends[rod.start]}", right = "{"clamped" if tip else ends[rod.end]}" }}
"""
        if tip:
            return text + 'to_frame = "tip"\n' + self.light_body(rod, loads[End.END])
        if rod.motion(End.END):
            return text + f'to_frame = "clamp_{k}::tip"\n' + self.clamp(k, rod, loads[End.END], path)
        return text

    def light_body(self, rod, load):
        weight = rod.material.density * rod.area * rod.length  # of the rod [kg]; the tip's body is to be slow enough for drag to settle it
        stiffness = 3 * rod.material.youngs_modulus * rod.second_moment_of_area / rod.length**3
        return f"""[[bodies]]
name          = "tip"
mass_kg       = {0.01 * weight!r}
inertia_kg_m2 = {vector([1e-4 * weight * rod.length**2] * 3)}
position_mm   = {vector(rod.centerline[-1], 1e3)}
force_N       = {vector(load)}
drag_Ns_m     = {2 * math.sqrt(stiffness * 0.25 * weight)!r}
"""

    def clamp(self, k, rod, load, path):
        """Arm, drive and load of an end that slides along x and turns about it."""
        motion = rod.motion(End.END)
        (path / "clamp.toml").write_text(CLAMP)
        (path / "clamp.urdf").write_text(CLAMP_URDF)
        turn = np.degrees([r[0] for r in motion.rotation])
        np.savetxt(path / f"turn_{k}.csv", np.column_stack([motion.times, turn]), "%.17g", ",", header="time_s,angle_deg", comments="")
        return f"""[[arms]]
name    = "clamp_{k}"
file    = "clamp.toml"
pose    = "start"
base_mm = {vector(rod.centerline[-1], 1e3)}
[[drives]]
joint       = "clamp_{k}::about"
mode        = "course"
course_file = "turn_{k}.csv"
[[loads]]
name    = "load_{k}"
frame   = "clamp_{k}::tip"
axes    = "world"
force_N = {vector(load)}
"""

    def cylinder(self, k, obstacle):
        return f"""[[shapes]]
name         = "cylinder_{k}"
kind         = "cylinder"
radius_mm    = {1e3 * obstacle.radius!r}
length_mm    = {1e3 * obstacle.length!r}
position_mm  = {vector(obstacle.center, 1e3)}
rotation_deg = {vector(turned_to(obstacle.unit_axis))}
friction     = {obstacle.friction}
"""


UNDAMPED = """[solver]
position_tolerance_m   = 1e-9
velocity_tolerance_m_s = 1e-6
relative_tolerance     = 1e-8
"""


def nearest(rod, other):
    """Smallest distance between the points of two rods at the start [m]."""
    return min(np.linalg.norm(np.asarray(other.centerline) - p, axis=1).min() for p in rod.centerline)


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
