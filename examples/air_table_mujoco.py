"""The air table's body meets a wire in MuJoCo, by the law that `snare export` puts onto it; beside the same body on the law's table here.

usage: air_table_mujoco.py WIRE.toml [PICTURE.png]     needs the package mujoco, 3.7.0 or later, and the command snare
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy as np
import snare

sys.path += [folder for folder in os.environ.get("SNARE_PEER_PACKAGES", "").split(":") if folder]
try:
    import mujoco
except ImportError as reason:
    print(f"skipped: the package mujoco is not installed ({reason})")
    sys.exit(77)

here = pathlib.Path(__file__).resolve().parent
command = os.environ.get("SNARE_COMMAND") or shutil.which("snare") or str(here.parent / "build/release/snare")
speed, arm, mass, inertia = 0.1, 0.05, 8.9, 0.16  # of approach [m/s]; offset of the probe [m]; of the body [kg, kg m^2]

with tempfile.TemporaryDirectory() as out:
    subprocess.run([command, "distil", sys.argv[1], "--out", out, "--quiet"], check=True)
    law = snare.Law(f"{out}/law.json")
    subprocess.run([command, "export", f"{out}/law.json", "--mujoco", str(here / "air_table.xml"), "--body", "target", "--axis", "0,1,0",
                    "--point-mm", "50,100,0", "--first-touch-mm", "0.1", "--position-mm", "90", "--out", out, "--quiet"], check=True)
    model = mujoco.MjModel.from_xml_path(f"{out}/law_mujoco.xml")

data = mujoco.MjData(model)
data.joint("y").qvel[0] = speed
times, forces = [], []
while data.time < 0.4:
    mujoco.mj_step(model, data)
    times.append(data.time)
    forces.append(-data.qfrc_passive[1])

# The probe moves along y alone by little: its mass there is that of the body with the lever of its centre.
probe_mass = 1.0 / (1.0 / mass + arm * arm / inertia)
travels = np.linspace(0.0, 0.008, 4001)
works = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(travels) * (law.force(travels[1:], 0.09) + law.force(travels[:-1], 0.09)))])
peak = law.force(float(np.interp(0.5 * probe_mass * speed**2, works, travels)), 0.09)

energy = 0.5 * mass * (data.qvel[0]**2 + data.qvel[1]**2) + 0.5 * inertia * data.qvel[2]**2
print(f"peak force: {max(forces):.6g} N")
print(f"peak force over that of the law: {max(forces) / peak:.6g}")
print(f"energy after over energy before: {energy / (0.5 * mass * speed**2):.6g}")

if len(sys.argv) > 2:
    import matplotlib.pyplot as plot

    plot.plot(times, forces)
    plot.xlabel("time [s]")
    plot.ylabel("force of the wire [N]")
    plot.savefig(sys.argv[2])
