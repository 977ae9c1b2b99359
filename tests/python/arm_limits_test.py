"""<limit> of a URDF: its effort limits a servo that has no limit of its own, and `snare arm show` states what becomes of it."""

import json
import pathlib
import subprocess
import tempfile
import unittest

import setting

URDF = """<robot name="arm"><link name="base"/>
  <joint name="a" type="revolute"><parent link="base"/><child link="la"/><origin xyz="0 0 0" rpy="0 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" effort="%s" velocity="0.5"/></joint>
  <link name="la"><inertial><origin xyz="1 0 0" rpy="0 0 0"/><mass value="10"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
</robot>
"""
ARM = """schema = "snare-arm/1"
title = "one joint"
urdf = "arm.urdf"
tip = "la"
[every_joint]
law = "linear"
stiffness_Nm_rad = 1e4
damping_Nms_rad = 1.0
motor_inertia_kg_m2 = 1.0
"""
SERVO = 'drive = "servo"\nproportional_Nm_rad = 10.0\nderivative_Nms_rad = 1.0\n'


class Limits(unittest.TestCase):
    def shown(self, effort, drive, *options):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "arm.urdf").write_text(URDF % effort)
            (folder / "arm.toml").write_text(ARM + drive)
            done = subprocess.run([setting.COMMAND, "arm", "show", folder / "arm.toml", *options], capture_output=True, text=True, check=True)
            return done.stdout

    def test_the_effort_limits_a_servo(self):
        for effort, drive, limit, words in (("120", SERVO, 120.0, "effort 120 N m is the limit of its servo"),
                                            ("120", SERVO + "limit_Nm = 7.0\n", 7.0, "effort 120 N m not used (limit_Nm of the arm file)"),
                                            ("0", SERVO, None, "effort 0 N m is no limit"),
                                            ("120", 'drive = "locked"\n', None, "effort 120 N m not used (no servo)")):
            joint = json.loads(self.shown(effort, drive, "--json"))["joints"][0]
            self.assertEqual(joint["servo_limit_Nm"], limit)
            self.assertEqual((joint["urdf_effort_Nm"], joint["urdf_velocity_rad_s"]), (float(effort), 0.5))
            text = self.shown(effort, drive)
            self.assertIn(words, text)
            self.assertIn("velocity 0.5 rad/s not used", text)

    def test_the_mass_matrix_has_the_names_of_the_joints(self):
        matrix = json.loads(self.shown("120", SERVO, "--json"))["mass_matrix"]
        self.assertEqual(matrix["joints"], ["a"])
        self.assertAlmostEqual(matrix["rows"][0][0], 1.0 + 10.0, delta=1e-9)  # about the joint, 1 m from the centre of mass


if __name__ == "__main__":
    setting.main()
