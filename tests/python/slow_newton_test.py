"""The linear MuJoCo form of a law in Newton's SolverMuJoCo: the model that it makes of the file has the force of the linear law.

Needs the package newton (with mujoco) of the Python index, in the Python of the tests or in a folder that SNARE_PEER_PACKAGES names;
skipped, saying so, where there is none.
"""

import json
import pathlib
import sys
import tempfile
import unittest

import setting
import numpy as np

setting.add_peer_packages()
try:
    import mujoco
    import newton
    from newton.solvers import SolverMuJoCo
except ImportError as reason:
    print(f"skipped: the package newton is not installed ({reason})")
    sys.exit(setting.SKIPPED)

SLIDE = """<mujoco model="slide"><worldbody><body name="visitor"><joint name="along" type="slide" axis="0 1 0"/>
  <geom type="sphere" size="0.05" mass="8.9"/></body></worldbody></mujoco>"""


class InNewton(unittest.TestCase):
    def test_the_linear_form(self):
        with tempfile.TemporaryDirectory() as name:
            out = pathlib.Path(name)
            setting.run_command("distil", str(setting.small_wire(out)), "--out", name, "--set", "laws.positions_mm=[52.5]", "--set", "laws.displacement_offsets_mm=[0.0]")
            (out / "slide.xml").write_text(SLIDE)
            setting.run_command("export", str(out / "law.json"), "--mujoco", str(out / "slide.xml"), "--body", "visitor", "--out", str(out / "x"))
            laws = json.loads((out / "law.json").read_text())["cases"][0]["positions"][0]["laws"]
            stiffness = next(iter(next(one for one in laws if one["name"] == "linear")["parameters"].values()))["value"]
            builder = newton.ModelBuilder()
            SolverMuJoCo.register_custom_attributes(builder)
            builder.add_mjcf((out / "x/law_mujoco_linear.xml").read_text())
            model = SolverMuJoCo(builder.finalize(), use_mujoco_cpu=True).mj_model
            data = mujoco.MjData(model)
            for d in (-0.01, -1e-3, 0.0, 1e-3, 4e-3, 8e-3):
                data.qpos[0] = d
                mujoco.mj_forward(model, data)
                # Newton keeps its numbers in single precision.
                self.assertAlmostEqual(-data.qfrc_spring[0], stiffness * max(0.0, d), delta=1e-6 * 8e-3 * stiffness)
                if d < 0.0:
                    self.assertEqual(abs(data.qfrc_spring[0]), 0.0)
            with self.assertRaises(ValueError):
                newton.ModelBuilder().add_mjcf((out / "x/law_mujoco.xml").read_text())


if __name__ == "__main__":
    setting.main()
