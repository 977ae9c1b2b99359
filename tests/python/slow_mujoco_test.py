"""law_mujoco.xml in MuJoCo itself: loaded, stepped, and its force beside the table's.

Needs node and the package @mujoco/mujoco (npm install @mujoco/mujoco), looked for where SNARE_NODE_MODULES says, below the
repository and in the home folder; skipped, saying so, where there is none.
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import setting
import snare
import numpy as np

WHERE = [os.environ.get("SNARE_NODE_MODULES"), setting.SOURCE / "node_modules", pathlib.Path.home() / "node_modules"]
PACKAGE = next((pathlib.Path(one) / "@mujoco/mujoco" for one in WHERE if one and (pathlib.Path(one) / "@mujoco/mujoco").is_dir()), None)
if shutil.which("node") is None or PACKAGE is None:
    print("skipped: node or its package @mujoco/mujoco is not installed")
    sys.exit(setting.SKIPPED)

PROGRAM = """
import fs from 'fs';
import load from '%PACKAGE%/mujoco.js';
const mujoco = await load();
const model = mujoco.MjModel.from_xml_string(fs.readFileSync(process.argv[2], 'utf8'));
const data = new mujoco.MjData(model);
const ask = JSON.parse(fs.readFileSync(process.argv[3], 'utf8'));
const answer = {joints: model.njnt, spring: [], speed: []};
for (const travel of ask.travel) {
  for (let j = 0; j < model.njnt; ++j) { data.qpos[j] = travel; data.qvel[j] = 0; }
  mujoco.mj_forward(model, data);
  answer.spring.push(Array.from(data.qfrc_spring));
}
model.opt.timestep = ask.step;
model.opt.gravity[0] = model.opt.gravity[1] = model.opt.gravity[2] = 0;
mujoco.mj_resetData(model, data);
for (let j = 0; j < model.njnt; ++j) { data.qpos[j] = ask.start; data.qvel[j] = 0; }
for (let k = 0; k < ask.steps; ++k) mujoco.mj_step(model, data);
answer.position = Array.from(data.qpos); answer.speed = Array.from(data.qvel); answer.time = data.time;
fs.writeFileSync(process.argv[4], JSON.stringify(answer));
"""


class InMuJoCo(unittest.TestCase):
    def test_force_against_travel_is_the_tables(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            setting.run_command("distil", str(setting.small_wire(folder, table="")), "--out", name)
            law = snare.Law(folder / "law.json")
            positions = sorted({one.position for one in law.simple})
            self.assertEqual(len(positions), 3)
            travel = np.linspace(0.0, law.travel[1], 81)
            start, step, steps = 0.5 * law.travel[1], 1e-6, 200
            (folder / "ask.json").write_text(json.dumps({"travel": travel.tolist(), "start": start, "step": step, "steps": steps}))
            (folder / "ask.mjs").write_text(PROGRAM.replace("%PACKAGE%", str(PACKAGE)))
            subprocess.run(["node", folder / "ask.mjs", folder / "law_mujoco.xml", folder / "ask.json", folder / "answer.json"],
                           check=True)
            answer = json.loads((folder / "answer.json").read_text())
            self.assertEqual(answer["joints"], 3)
            spring = -np.array(answer["spring"])
            text = (folder / "law_mujoco.xml").read_text()
            stated = [(float(a), float(b)) for a, b in re.findall(r"by up to (\S+) N of (\S+) N; the linear", text)]
            for k, position in enumerate(positions):
                table = law.force(travel, position)
                error = np.abs(spring[:, k] - table).max()
                print(f"s = {1e3 * position:.4g} mm: {error:.3g} N of {np.ptp(table):.4g} N in MuJoCo, stated {stated[k][0]:.3g} N")
                self.assertLess(error, 0.02 * np.ptp(table))
                # Printed with three digits; the table itself is off the full wire by its bound.
                self.assertLess(error, 1.01 * stated[k][0] + law.bound)
                # A mass of 1 g let go for 0.2 ms, in which it moves by a few hundredths of a millimetre and the force changes
                # by a few per cent.
                force, time = law.force(start, position), steps * step
                self.assertAlmostEqual(answer["speed"][k], -force * time / 0.001, delta=0.05 * force * time / 0.001)


if __name__ == "__main__":
    setting.main()
