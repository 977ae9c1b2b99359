"""The cases with the command snare. Its processor time is that of the whole command, including start, input and output."""

import csv
import json
import math
import os
import pathlib
import resource
import statistics
import subprocess
import tempfile

import peer
from references import BENDING, GREENHILL, LENGTH, MASS, SPAN, SPEED, TRAVELS, TWISTING, Elastica

COMMAND = os.environ.get("SNARE_COMMAND", str(pathlib.Path(__file__).parents[2] / "build/release/snare"))
WIRE = """construction       = "solid"
diameter_mm        = 1.5
length_mm          = 180.0
youngs_modulus_GPa = 193.0
poisson_ratio      = 0.29
density_kg_m3      = 7930.0
"""


def command(verb, text, sets=(), files=(), repeats=1):
    """What a verb writes, by name, and the processor time of the command."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder)
        for name, content in {"input.toml": text, **dict(files)}.items():
            (path / name).write_text(content)
        words = [COMMAND, verb, str(path / "input.toml"), "--out", str(path / "out"), "--threads", "1", "--quiet"]
        for key, value in sets:
            words += ["--set", f"{key}={value}"]
        seconds = []
        for _ in range(repeats):
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            run = subprocess.run(words, capture_output=True, text=True)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            seconds.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
            if run.returncode:
                raise RuntimeError(run.stderr.strip() or f"status {run.returncode}")
            out = {p.name: p.read_text() for p in (path / "out").iterdir() if p.suffix in (".csv", ".json")}
        return out, statistics.median(seconds)


def solver(settings):
    return [(f"solver.{key}", json.dumps(value)) for key, value in settings.items()]


def push(position=65.0, **settings):
    text = f"""schema = "snare-experiment/1"
title  = "push at {position} mm"
[wire]
{WIRE}
[mount]
kind    = "clamped"
span_mm = 175.0
[pusher]
shape     = "cylinder"
radius_mm = 6.0
friction  = 0.0
direction = "outward"
[[series]]
name                = "push"
contact_position_mm = {position}
travel_mm           = {TRAVELS[-1] * 1e3}
points              = {len(TRAVELS) + 1}
"""
    out, seconds = command("push", text, solver(settings), repeats=5)
    force = [float(r["force_N"]) for r in csv.DictReader(out["curves.csv"].splitlines())]
    return {"force_N": force[1:], "processor_s": seconds}


def impact(elements=None, formulation=None, model=None, duration=0.3, **settings):
    keys = "".join(f"{key} = {json.dumps(value)}\n" for key, value in
                   (("elements", elements), ("formulation", formulation), ("model", model)) if value is not None)
    touch = float(Elastica(0.5 * SPAN).first_touch) * LENGTH * 1e3
    text = f"""schema = "snare-scenario/2"
title  = "head-on impact"
duration_s        = {duration}
output_interval_s = {min(0.001, duration)}
[damping]
bending_time_s = 1.0e-5
axial_time_s   = 1.0e-5
[[wires]]
name = "wire"
{WIRE}from_mm = [0.0, 0.0, 0.0]
to_mm   = [175.0, 0.0, 0.0]
bulge   = [0.0, 1.0, 0.0]
{keys}
[[bodies]]
name          = "target"
mass_kg       = {MASS}
inertia_kg_m2 = [0.16, 0.16, 0.16]
position_mm   = [87.5, {touch - 0.1!r}, 0.0]
velocity_m_s  = [0.0, {SPEED}, 0.0]
[[shapes]]
name      = "probe"
frame     = "target"
kind      = "capsule"
radius_mm = 6.0
length_mm = 60.0
friction  = 0.0
"""
    out, seconds = command("simulate", text, solver(settings), repeats=5)
    contact = json.loads(out["summary.json"])["contacts"][0]
    impulse = contact["impulse_Ns"]
    size = sum(v * v for v in impulse) ** 0.5 if isinstance(impulse, list) else abs(impulse)
    return {"peak_N": contact["peak_force_N"], "impulse_Ns": size, "processor_s": seconds}


def start():
    """What the impact's command takes for a microsecond of motion: start, reading, the wire at rest, writing."""
    return {"processor_s": impact(duration=1e-6)["processor_s"]}


def scenario(wire, body="", duration=0.3):
    """A straight wire from the world's origin along x, to a frame of its own."""
    return f"""schema = "snare-scenario/2"
title  = "straight wire"
duration_s        = {duration}
output_interval_s = {duration / 10}
[[wires]]
name = "wire"
{WIRE}from_mm = [0.0, 0.0, 0.0]
to_mm   = [0.0, 0.0, 0.0]
{wire}
{body}
"""


def mesh(elements, formulation=None):
    return (f"elements = {elements}\n" if elements else "") + (f'formulation = "{formulation}"\n' if formulation else "")


def tip(load=4.0, elements=None, formulation=None, **settings):
    """The tip is clamped to a light body, which the load pushes until drag has brought it to rest."""
    force = load * BENDING / LENGTH**2
    body = f"""[[bodies]]
name          = "tip"
mass_kg       = 0.01
inertia_kg_m2 = [1e-6, 1e-6, 1e-6]
position_mm   = [{LENGTH * 1e3}, 0.0, 0.0]
force_N       = [0.0, {force}, 0.0]
drag_Ns_m     = 1.0
drag_Nms_rad  = 1e-3
"""
    text = scenario('to_frame = "tip"\nmodel = "quasi_static"\n' + mesh(elements, formulation), body)
    out, seconds = command("simulate", text, solver(settings), repeats=5)
    place = json.loads(out["summary.json"])["bodies"][0]["position_after_mm"]
    return {"tip": [place[0] / (LENGTH * 1e3), place[1] / (LENGTH * 1e3)], "processor_s": seconds}


def frequency(elements=None, formulation=None, **settings):
    """The tip is clamped to a body of no weight to speak of."""
    body = f"""[[bodies]]
name          = "tip"
mass_kg       = 1e-9
inertia_kg_m2 = [1e-15, 1e-15, 1e-15]
position_mm   = [{LENGTH * 1e3}, 0.0, 0.0]
[output]
modes = true
"""
    out, seconds = command("simulate", scenario('to_frame = "tip"\n' + mesh(elements, formulation), body, 1e-4), solver(settings), repeats=5)
    return {"frequency_Hz": json.loads(out["summary.json"])["modes"][0]["frequency_Hz"], "processor_s": seconds}


CHUCK_URDF = f"""<robot name="chuck">
<link name="base"/>
<link name="chuck"><inertial><origin xyz="0 0 0" rpy="0 0 0"/><mass value="0.1"/>
<inertia ixx="1e-3" ixy="0" ixz="0" iyy="1e-3" iyz="0" izz="1e-3"/></inertial></link>
<joint name="turn" type="continuous"><origin xyz="{LENGTH} 0 0" rpy="0 0 0"/><parent link="base"/><child link="chuck"/><axis xyz="1 0 0"/></joint>
</robot>
"""
CHUCK = """schema = "snare-arm/1"
title  = "a chuck that turns"
urdf   = "chuck.urdf"
tip    = "chuck"
[every_joint]
law                 = "linear"
stiffness_Nm_rad    = 1e6
damping_Nms_rad     = 100.0
motor_inertia_kg_m2 = 0.01
drive               = "locked"
[[pose]]
name       = "straight"
angles_deg = [0]
"""


def twist(elements=None, formulation=None, **settings):
    """A chuck turns the end of the straight wire; the small oscillations there give the frequency."""
    squares, total = [], 0.0
    for share in peer.SHARES:
        body = f"""[[arms]]
name = "arm"
file = "chuck.toml"
pose = "straight"
[[drives]]
joint      = "arm::turn"
mode       = "course"
by_deg     = {math.degrees(share * GREENHILL / TWISTING * LENGTH)}
duration_s = 0.2
[output]
modes = true
"""
        out, seconds = command("simulate", scenario('to_frame = "arm::chuck"\n' + mesh(elements, formulation), body), solver(settings),
                               {"chuck.toml": CHUCK, "chuck.urdf": CHUCK_URDF}, repeats=1)
        squares.append(json.loads(out["summary.json"])["modes"][0]["frequency_Hz"]**2)
        total += seconds
    return {"critical": peer.critical(squares), "squares": squares, "processor_s": total}


if __name__ == "__main__":
    peer.main(globals())
