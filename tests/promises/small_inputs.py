"""Inputs of every verb for entries.py. A run takes a fraction of a second, a run of a `long` one minutes."""

import dataclasses
import math
import pathlib
import shutil
import subprocess

from wire_text import experiment

FITTED = "bending_stiffness_Nm2 = 0.0094\naxial_stiffness_N = 19300.0\n"
SERIES = """[[series]]
name = "middle"
contact_position_mm = 87.5
travel_mm = 0.5
points = 3
"""
READINGS = """[[series]]
name = "middle"
contact_position_mm = 60.0
file = "curves_measured.csv"
force_sigma_N = 0.1
"""
# Forces of that wire at 60 mm, computed by `snare push`, with noise of about 0.05 N [N].
READ = [0.02, 0.11, 0.37, 0.52, 0.82, 0.99, 1.36, 1.67, 1.95, 2.42, 2.78, 3.33]
WIRE = experiment("wire", 175.49, FITTED).replace("snare-experiment", "snare-wire") + """[ranges]
travel_mm = 2.0
[table]
points      = [4, 3, 2]
most_points = [4, 3, 2]
[solver]
elements = 16
extrapolate = false
[laws]
positions_mm = [90.0]
"""
# A ball that flies into a wire and touches it after a millisecond.
DROP = """schema = "snare-scenario/2"
title = "drop"
source = "a test"
duration_s = 0.01
[[bodies]]
name = "ball"
mass_kg = 1.0
inertia_kg_m2 = [0.1, 0.1, 0.1]
position_mm = [1.5, 0.0, 50.0]
velocity_m_s = [1.0, 0.0, 0.0]
[[shapes]]
name = "round"
body = "ball"
kind = "sphere"
radius_mm = 3.0
[[wires]]
name = "a"
construction = "solid"
diameter_mm = 1.5
length_mm = 100.0
youngs_modulus_GPa = 193.0
poisson_ratio = 0.29
density_kg_m3 = 7930.0
from_mm = [0.0, 0.0, 0.0]
to_mm = [0.0, 0.0, 99.0]
bulge = [1.0, 0.0, 0.0]
mount = "pinned"
elements = 12
"""
SWEEP = """schema = "snare-sweep/1"
title = "pushes"
case = "push.toml"
design = "latin_hypercube"
cases = 24
[[vary]]
key = "wire.length_mm"
uniform = [179.0, 181.0]
[collect]
force = "series[middle].largest_force_N"
[histories]
columns = ["force_N"]
"""
# A sweep in which every case fails: the wire reaches its strength at once.
STOPPED = SWEEP.split("[[vary]]")[0].replace("push.toml", "drop.toml").replace("cases = 24", "cases = 2") + """[set]
"wires[a].strength_N" = 20.0
"wires[a].at_strength" = "stop"
[[vary]]
key = "bodies[ball].mass_kg"
uniform = [1.0, 2.0]
[collect]
speed = "duration_s"
"""
RINGDOWN = """schema = "snare-ringdown/1"
title = "ring-down"
[[series]]
name = "a"
file = "vibration.csv"
"""
BENCHMARK = """schema = "snare-benchmark/1"
title = "pushes"
[[cases]]
name = "push"
file = "push.toml"
x = "displacement_mm"
[cases.quantities]
force_N = "force_N"
[[cases.refinements]]
set = { "solver.elements" = 32 }
[[cases.refinements]]
set = { "solver.elements" = 64 }
[[cases.models]]
name = "coarse"
set = { "solver.elements" = 16 }
"""
MODEL = """<mujoco model="table">
  <option gravity="0 0 0"/>
  <worldbody>
    <body name="target">
      <joint name="y" type="slide" axis="0 1 0"/>
      <inertial pos="0 0 0" mass="8.9" diaginertia="0.16 0.16 0.16"/>
    </body>
  </worldbody>
</mujoco>
"""


def chain(joints: int) -> str:
    """A chain of joints in URDF, each a metre from the one before."""
    inertial = "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>"
    links = "".join(f"<link name='l{k}'>{inertial}</link>" for k in range(joints + 1))
    return "<robot name='chain'>" + links + "".join(
        f"<joint name='j{k}' type='continuous'><parent link='l{k}'/><child link='l{k + 1}'/>"
        "<origin xyz='1 0 0'/><axis xyz='0 0 1'/></joint>" for k in range(joints)) + "</robot>"


def arm(urdf: str, joints: int) -> str:
    return f"""schema = "snare-arm/1"
title = "chain"
source = "a test"
urdf = "{urdf}"
tip = "l{joints}"
[every_joint]
law = "linear"
damping_Nms_rad = 0.0
motor_inertia_kg_m2 = 1.0
stiffness_Nm_rad = 100.0
drive = "locked"
"""


def table(columns: str, rows) -> str:
    return columns + "\n" + "".join(",".join(f"{cell:.9g}" for cell in row) + "\n" for row in rows)


@dataclasses.dataclass
class Work:
    """Inputs of one verb. Words are those of the command after the verb, the file first; sets are overrides as of --set."""
    words: list
    named: list = dataclasses.field(default_factory=list)     # names of the files that it reads, that of `words` first
    outputs: list = dataclasses.field(default_factory=list)   # files that it writes
    mistakes: list = dataclasses.field(default_factory=list)  # wrong (words, set), and a part of the message
    warned: dict = dataclasses.field(default_factory=dict)    # a set that causes a warning
    warning: str = ""
    stopped: tuple = ()                                       # (words, set) for which the solver fails
    long: tuple = ()                                          # (words, set) of a run that takes minutes
    json: bool = True                                         # has --json
    out: bool = True                                          # has --out


def of_experiment(file: str, named: list, outputs: list, stopped: tuple, long: str) -> Work:
    return Work([file], named, outputs, [([file], {"wire.length_mm": -1.0}, "wire.length_mm")], {"wire.youngs_modulus_GPa": 500.0},
                "the modulus of 500 GPa is above that of every metal", stopped, ([long], {}))


MEASURED = ("measured.toml", ["measured.toml", "curves_measured.csv"])
STIFF = {"wire.bending_stiffness_Nm2": 1e6}
FAR = {"series[middle].travel_mm": 100.0}
LAW = ["--mujoco", "model.xml", "--position-mm", "90", "--body"]
WORK = {
    "push": of_experiment("push.toml", ["push.toml"], ["curves.csv", "report.html"],
                          (["push.toml"], {**STIFF, **FAR}), "fine.toml"),
    "fit": of_experiment(*MEASURED, ["curves.csv", "fit.json", "report.html"], (["measured.toml"], STIFF), "many.toml"),
    "trace": of_experiment(*MEASURED, ["curves.csv", "trace.json", "report.html"], (["measured.toml"], STIFF), "many.toml"),
    "reproduce": of_experiment(*MEASURED, ["curves.csv", "reproduce.json", "report.html", "traced.toml"], (["measured.toml"], STIFF), "many.toml"),
    "distil": Work(["wire.toml"], ["wire.toml"],
                   ["law.c", "law.h", "law.hpp", "law.json", "law.mo", "law.py", "law_adams.adm", "law_mujoco.xml", "law_mujoco_linear.xml",
                    "law_simulink.csv", "report.html", "table.csv"],
                   [(["wire.toml"], {"wire.length_mm": -1.0}, "wire.length_mm")], {"wire.youngs_modulus_GPa": 500.0},
                   "the modulus of 500 GPa is above that of every metal", (["wire.toml"], STIFF),
                   (["wire.toml"], {"table.points": [60, 60, 30], "table.most_points": [60, 60, 30], "solver.elements": 256})),
    "compare": Work(["push.toml"], ["push.toml"], ["compare.json", "report.html"],
                    [(["push.toml"], {"wire.length_mm": -1.0}, "wire.length_mm")], stopped=(["push.toml"], {**STIFF, **FAR}),
                    long=(["fine.toml"], {})),
    "simulate": Work(["drop.toml"], ["drop.toml"], ["history.csv", "report.html", "summary.json"],
                     [(["drop.toml"], {"bodies[ball].mass_kg": -1.0}, "bodies[ball].mass_kg")],
                     {"bodies[ball].velocity_m_s": [400.0, 0.0, 0.0], "duration_s": 2e-5}, "is struck at",
                     (["drop.toml"], {"wires[a].strength_N": 20.0, "wires[a].at_strength": "stop"}),
                     (["drop.toml"], {"duration_s": 1000.0, "wires[a].elements": 64})),
    "ringdown": Work(["ringdown.toml"], ["ringdown.toml", "vibration.csv"], ["report.html", "ringdown.csv", "ringdown.json"],
                     [(["ringdown.toml"], {"series[a].modes": -1}, "series[a].modes")], long=(["swings.toml"], {})),
    "sweep": Work(["sweep.toml"], ["sweep.toml", "push.toml"], ["cases.csv", "cases.journal", "histories.h5", "report.html", "summary.json"],
                  [(["sweep.toml"], {"cases": 0}, "cases"), (["sweep.toml"], {"collect.force": "nowhere"}, "nowhere")],
                  stopped=(["stopped.toml"], {}), long=(["sweep.toml"], {"cases": 100000})),
    "benchmark": Work(["benchmark.toml"], ["benchmark.toml", "push.toml", "push.csv", "push.json"],
                      ["benchmark.json", "report.html", "scores.csv"],
                      [(["benchmark.toml"], {"cases[push].x": "nothing"}, "cases[push]")],
                      stopped=(["benchmark.toml"], {"cases[push].set": {**STIFF, **FAR}}),
                      long=(["benchmark.toml"], {"cases[push].set": {"series[middle].points": 1000000}})),
    "validate": Work([], [], ["validation.json", "report.html"], [([], {"any.key": 1}, "any.key")], long=([], {})),
    "arm": Work(["arm.toml"], ["arm.toml", "chain.urdf"], [], [(["arm.toml"], {"every_joint.stiffness_Nm_rad": -1.0}, "stiffness_Nm_rad")],
                long=(["long_arm.toml"], {}), out=False),
    "new": Work(["wire"], [], ["wire.toml"], [(["nothing"], {}, "nothing")], json=False),
    "export": Work(["law.json", *LAW, "target"], ["law.json", "model.xml"], ["law_mujoco.xml", "law_mujoco_linear.xml"],
                   [(["law.json", *LAW, "nobody"], {}, "nobody"), (["law.json", *LAW, "target", "--case", "7"], {}, "--case")], json=False),
}


def write(folder: pathlib.Path, snare: str) -> None:
    """Writes all files into the folder; the command makes the law and the archive of the benchmark."""
    measured = experiment("measured", 175.49, FITTED) + READINGS + '[solver]\nelements = 16\n[fit]\nfree = ["wire.length_mm"]\n'
    swing = [(1e-4 * k, math.exp(-1e-4 * k) * math.sin(0.05 * k)) for k in range(50000)]
    texts = {
        "push.toml": experiment("push", 180.0) + SERIES + "[solver]\nelements = 16\n",
        "fine.toml": experiment("fine", 180.0) + SERIES.replace("points = 3", "points = 20000") + "[solver]\nelements = 4096\n",
        "measured.toml": measured,
        "curves_measured.csv": table("displacement_mm,force_N", [(0.15 * k, force) for k, force in enumerate(READ)]),
        "many.toml": measured.replace("curves_measured.csv", "curves_many.csv").replace("elements = 16", "elements = 256"),
        "curves_many.csv": table("displacement_mm,force_N", [(3e-5 * k, 1e-4 * k) for k in range(100000)]),
        "wire.toml": WIRE,
        "drop.toml": DROP,
        "sweep.toml": SWEEP,
        "stopped.toml": STOPPED,
        "ringdown.toml": RINGDOWN,
        "vibration.csv": table("time_s,displacement_mm",
                               [(2e-3 * k, math.exp(-6e-3 * k) * math.cos(0.4 * k)) for k in range(200)]),
        "swings.toml": RINGDOWN.split("[[series]]")[0] + "".join(
            f'[[series]]\nname = "s{k}"\nfile = "swings.csv"\nmodes = 4\n' for k in range(20)),
        "swings.csv": table("time_s,displacement_mm", swing),
        "benchmark.toml": BENCHMARK,
        "arm.toml": arm("chain.urdf", 3),
        "chain.urdf": chain(3),
        "long_arm.toml": arm("long_chain.urdf", 600),
        "long_chain.urdf": chain(600),
        "model.xml": MODEL,
    }
    for name, text in texts.items():
        (folder / name).write_text(text)
    for words in (["distil", "wire.toml", "--out", "law"], ["benchmark", "benchmark.toml", "--archive", "--out", "archive"]):
        subprocess.run([snare, *words, "--quiet"], cwd=folder, check=True)
    (folder / "law/law.json").rename(folder / "law.json")
    shutil.rmtree(folder / "law")
