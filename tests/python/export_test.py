"""`snare export`: a law on a body of a model, refusals, and the text of the user is kept."""

import pathlib
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree

import setting

MODEL = """<mujoco model="mine">
  <!-- kept -->
  <compiler meshdir="meshes"/>
  <asset><mesh name="m" file="m.stl"/></asset>
  <worldbody>
    <body name="wall"/>
    <body name="probe" pos="0 1 0"><joint type="slide" axis="0 1 0"/><geom size="0.1" mass="1"/></body>
    <body name="ship"><freejoint/><geom size="0.1" mass="1"/></body>
  </worldbody>
</mujoco>
"""


class Export(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = pathlib.Path(cls.folder.name)
        setting.run_command("distil", str(setting.small_wire(cls.out)), "--out", str(cls.out / "law"))
        (cls.out / "model.xml").write_text(MODEL)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def export(self, *arguments, model="model.xml", law="law/law.json"):
        return subprocess.run([setting.COMMAND, "export", self.out / law, "--mujoco", self.out / model, *arguments], capture_output=True,
                              text=True, cwd=self.out)

    def test_the_model_keeps_what_it_has_and_gains_the_law(self):
        done = self.export("--body", "probe", "--out", "a/b")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("position", done.stderr)
        self.assertEqual(sorted(p.name for p in (self.out / "a/b").iterdir()), ["law_mujoco.xml", "law_mujoco_linear.xml"])
        for name, numbers in (("law_mujoco.xml", 3), ("law_mujoco_linear.xml", 1)):
            text = (self.out / "a/b" / name).read_text()
            self.assertIn("<!-- kept -->", text)
            self.assertIn("Readers: ", text)
            root = xml.etree.ElementTree.fromstring(text)
            self.assertEqual(root.findall("compiler")[-1].get("meshdir"), "../../meshes")
            joint = root.find(".//body[@name='probe']/joint").get("name")
            tendons = root.findall("tendon/fixed")
            self.assertEqual({one.find("joint").get("joint") for one in tendons}, {joint})
            self.assertEqual({len(one.get("stiffness").split()) for one in tendons}, {numbers})
        again = self.export("--body", "probe", "--out", "c", model="a/b/law_mujoco.xml")
        self.assertEqual(again.returncode, 2)
        self.assertIn("this law is on the body", again.stderr)
        other = self.export("--body", "probe", "--position-mm", "40", "--out", "c", model="a/b/law_mujoco.xml")
        self.assertEqual(other.returncode, 0, other.stderr)

    def test_a_free_body_gets_spatial_tendons(self):
        done = self.export("--body", "ship", "--axis", "1,0,0", "--point-mm", "10,20,30", "--out", "free")
        self.assertEqual(done.returncode, 0, done.stderr)
        root = xml.etree.ElementTree.parse(self.out / "free/law_mujoco.xml").getroot()
        self.assertEqual(len(root.findall("tendon/fixed")), 0)
        self.assertGreater(len(root.findall("tendon/spatial")), 0)
        self.assertEqual(root.find(".//body[@name='ship']/site").get("pos"), "0.01 0.02 0.03")

    def test_wrong_input_is_refused_and_nothing_is_written(self):
        (self.out / "bad.xml").write_text("<mujoco>\n<worldbody></mujoco>")
        (self.out / "robot.xml").write_text("<robot/>")
        (self.out / "lost.xml").write_text('<mujoco><include file="none.xml"/></mujoco>')
        for arguments, model, words in (
                (["--body", "prob"], "model.xml", ["--body", "prob", "did you mean probe?", "there are: wall, probe, ship"]),
                (["--body", "wall"], "model.xml", ["must be able to move"]),
                (["--body", "probe", "--axis", "1,0,0"], "model.xml", ["--axis", "must be along"]),
                (["--body", "probe", "--axis", "1,0"], "model.xml", ["--axis = 1,0", "three numbers"]),
                (["--body", "ship", "--axis", "0 0 0"], "model.xml", ["must not be all zero"]),
                (["--body", "probe", "--position-mm", "900"], "model.xml", ["--position-mm = 900", "the positions of the law"]),
                (["--body", "probe", "--slack-mm", "90"], "model.xml", ["--slack-mm = 90"]),
                (["--body", "probe", "--first-touch-mm", "-1"], "model.xml", ["--first-touch-mm = -1", "must be >= 0"]),
                (["--body", "probe", "--case", "2"], "model.xml", ["--case = 2", "must be 1 to 1"]),
                (["--body", "probe"], "bad.xml", ["bad.xml:2", "must close"]),
                (["--body", "probe"], "robot.xml", ["<robot>", "must be a model of MuJoCo"]),
                (["--body", "probe"], "lost.xml", ["none.xml"]),
                (["--body", "probe"], "missing.xml", ["missing.xml"])):
            done = self.export(*arguments, "--out", "none", model=model)
            self.assertEqual(done.returncode, 2, (arguments, done.stderr))
            for word in words:
                self.assertIn(word, done.stderr, arguments)
            self.assertFalse((self.out / "none").exists())
        done = self.export("--body", "probe", "--out", "none", law="model.xml")
        self.assertEqual(done.returncode, 2)


if __name__ == "__main__":
    setting.main()
