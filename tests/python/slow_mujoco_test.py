"""The MuJoCo forms of a law in MuJoCo itself: forces over travel, impacts, loops, and bodies of models of one's own.

Needs the package mujoco (4.0 for all of it) of the Python index, in the Python of the tests or in a folder that SNARE_PEER_PACKAGES names; skipped,
saying so, where there is none.
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import warnings

import setting
import snare
import numpy as np

setting.add_peer_packages()
try:
    import mujoco
except ImportError as reason:
    print(f"skipped: the package mujoco is not installed ({reason})")
    sys.exit(setting.SKIPPED)
VERSION = tuple(int(x) for x in mujoco.__version__.split(".")[:2])
POLYNOMIAL, YIELD = VERSION >= (3, 7), VERSION >= (4, 0)  # the versions with stiffness of three numbers, with springyield
try:
    import jax
    from mujoco import mjx
except (ImportError, AttributeError):  # the latter from a NumPy that is too old for it
    mjx = None

warnings.simplefilter("ignore", snare.OutsideRange)
MASS = 8.9  # of the impacts of the wire file [kg]
SLIDE = """<mujoco><option gravity="0 0 0"/><worldbody>
  <body name="visitor" pos="0.1 0.2 0.3" euler="0 0 30"><joint name="along" type="slide" axis="0 1 0"/>
    <geom size="0.05" mass="8.9"/></body></worldbody></mujoco>"""


def forces(model, travels, place=0):
    """Force of the springs against the travel at rest."""
    data = mujoco.MjData(model)
    found = []
    for d in travels:
        data.qpos[:] = d
        data.qvel[:] = 0.0
        mujoco.mj_forward(model, data)
        found.append(-data.qfrc_passive[place])
    return np.array(found)


def impact(model, speed, step):
    """Peak force, time of contact and restitution of a body that meets the wire from below first touch."""
    model.opt.timestep = step
    data = mujoco.MjData(model)
    data.qpos[0], data.qvel[0] = -0.3 * speed * 2e-3 - 1e-4, speed
    peak, touch, leave, before = 0.0, None, None, data.qpos[0]
    for _ in range(int(0.6 / step)):
        mujoco.mj_step(model, data)
        peak = max(peak, -data.qfrc_passive[0])
        q = data.qpos[0]
        if before < 0.0 <= q:
            touch = data.time - step * q / (q - before)
        if before >= 0.0 > q and touch is not None:
            leave = data.time - step * q / (q - before)
        before = q
    return peak, leave - touch, -data.qvel[0] / speed


def impact_of_law(force, damping, speed):
    """The same of m d'' = -(F + c d'), by the classical Runge-Kutta method."""
    step, y, time, peak = 1e-5, np.array([0.0, speed]), 0.0, 0.0
    rate = lambda y: np.array([y[1], -(force(max(y[0], 0.0)) + damping * y[1]) / MASS])
    while True:
        k1 = rate(y)
        k2 = rate(y + 0.5 * step * k1)
        k3 = rate(y + 0.5 * step * k2)
        k4 = rate(y + step * k3)
        after = y + step / 6.0 * (k1 + 2 * k2 + 2 * k3 + k4)
        if after[0] < 0.0:
            return peak, time + step * y[0] / (y[0] - after[0]), -after[1] / speed
        y, time = after, time + step
        peak = max(peak, force(y[0]) + damping * y[1])


class Laws(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = pathlib.Path(cls.folder.name)
        wire = setting.small_wire(cls.out, table="\n[table]\npoints = [12, 3, 3]\nmost_points = [12, 3, 3]\n"
                                                 f"[damping]\nimpact_mass_kg = {MASS}\nimpact_speeds_m_s = [0.02]\nelements = 16\n")
        setting.run_command("distil", str(wire), "--out", str(cls.out / "plain"), "--set", "laws.positions_mm=[40.0, 52.5]", "--set",
                            "laws.displacement_offsets_mm=[0.0, 0.0]")
        setting.run_command("distil", str(wire), "--out", str(cls.out / "rubbing"), "--set", "pusher.friction=0.3",
                            "--set", "laws.positions_mm=[52.5]", "--set", "laws.displacement_offsets_mm=[0.0]")
        cls.law = snare.Law(cls.out / "plain/law.json")
        cls.case = json.loads((cls.out / "plain/law.json").read_text())["cases"][0]
        (cls.out / "slide.xml").write_text(SLIDE)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def export(self, text, body, *arguments, law="plain"):
        """The files of `snare export` of a model, by name."""
        (self.out / "model.xml").write_text(text)
        setting.run_command("export", str(self.out / law / "law.json"), "--mujoco", str(self.out / "model.xml"), "--body", body,
                            "--out", str(self.out / "exported"), *arguments)
        return self.out / "exported"

    @unittest.skipUnless(POLYNOMIAL, "MuJoCo before 3.7.0")
    def test_the_force_is_the_laws_below_within_and_beyond_the_range(self):
        model = mujoco.MjModel.from_xml_path(str(self.out / "plain/law_mujoco.xml"))
        positions = sorted({one.position for one in self.law.simple})
        self.assertEqual(model.njnt, len(positions))
        end = self.law.travel[1]
        travels = np.concatenate([np.linspace(-end, 0.0, 21), np.linspace(0.0, 2.5 * end, 301)])
        for k, position in enumerate(positions):
            wanted = np.array([self.law.force(d, position) if d >= 0.0 else 0.0 for d in travels])
            got = forces(model, travels, k)
            self.assertLess(np.abs(got - wanted).max(), 1e-6 * wanted.max())
            self.assertEqual(np.abs(got[travels <= 0.0]).max(), 0.0)

    def test_the_linear_form_is_the_linear_law(self):
        model = mujoco.MjModel.from_xml_path(str(self.out / "plain/law_mujoco_linear.xml"))
        travels = np.linspace(-0.004, 0.008, 61)
        linear = {one.position: one for one in self.law.simple if one.name == "linear"}
        for k, position in enumerate(sorted(linear)):
            wanted = linear[position].force(1e-3) / 1e-3
            np.testing.assert_allclose(forces(model, travels, k), wanted * np.maximum(travels, 0.0), atol=1e-9)

    @unittest.skipIf(mjx is None, "mujoco-mjx is not installed")
    def test_the_linear_form_in_mjx(self):
        jax.config.update("jax_enable_x64", True)
        model = mujoco.MjModel.from_xml_path(str(self.export(SLIDE, "visitor") / "law_mujoco_linear.xml"))
        on_device = mjx.put_model(model)
        data = mjx.make_data(on_device)
        force = jax.jit(lambda q: mjx.forward(on_device, data.replace(qpos=q)).qfrc_passive)
        travels = np.linspace(-0.004, 0.008, 13)
        np.testing.assert_allclose([-float(force(jax.numpy.array([d]))[0]) for d in travels], forces(model, travels), atol=1e-9)

    @unittest.skipUnless(YIELD, "MuJoCo before 4.0.0")
    def test_the_models_of_distil_are_stable_at_the_default_step(self):
        for name in ("plain/law_mujoco.xml", "rubbing/law_mujoco.xml", "rubbing/law_mujoco_loop.xml"):
            model = mujoco.MjModel.from_xml_path(str(self.out / name))
            self.assertEqual(model.opt.timestep, 2e-3)
            data = mujoco.MjData(model)
            data.qpos[:] = 1e-3
            start = None
            for _ in range(1000):
                mujoco.mj_step(model, data)
                if data.qpos[0] < 0.0 and start is None:
                    start = data.qvel.copy()
            self.assertTrue(np.isfinite(data.qvel).all())
            np.testing.assert_allclose(data.qvel, start, rtol=1e-9)  # it flies on: nothing pulls it back

    @unittest.skipUnless(POLYNOMIAL, "MuJoCo before 3.7.0")
    def test_impacts_are_those_of_the_law(self):
        position = 0.0525
        place = next(one for one in self.case["positions"] if abs(one["position_mm"] - 52.5) < 1e-6)
        damping = place["impacts"][0]["damping_Ns_m"]
        out = self.export(SLIDE, "visitor", "--position-mm", "52.5")
        table = np.linspace(0.0, 0.02, 8001)
        curve = np.array([self.law.force(d, position) for d in table])
        for speed in (0.02, 0.1):
            peak, duration, restitution = impact_of_law(lambda d: np.interp(d, table, curve), damping, speed)
            for step in (2e-3, 1e-4):
                model = mujoco.MjModel.from_xml_path(str(out / "law_mujoco.xml"))
                got = impact(model, speed, step)
                print(f"{speed} m/s at {step} s: peak {got[0]:.5g} N for {peak:.5g}, {1e3 * got[1]:.5g} ms for {1e3 * duration:.5g}, "
                      f"restitution {got[2]:.6f} for {restitution:.6f}")
                # The law itself is off the full wire by up to 0.2 % of the peak; the step is 1/70 of the impact.
                self.assertAlmostEqual(got[0] / peak, 1.0, delta=2e-3)
                self.assertAlmostEqual(got[1] / duration, 1.0, delta=2e-3)
                self.assertAlmostEqual(got[2], restitution, delta=5e-4)

    @unittest.skipUnless(YIELD, "MuJoCo before 4.0.0")
    def test_a_loop_loses_the_same_at_three_rates(self):
        content = json.loads((self.out / "rubbing/law.json").read_text())["cases"][0]
        loop = content["positions"][0]["load_unload"]["loop_J"]
        end = content["ranges"]["travel_mm"][1] * 1e-3
        for rate in (0.1, 10.0, 1000.0):
            text = SLIDE.replace('mass="8.9"', 'mass="1e9"')
            model = mujoco.MjModel.from_xml_path(str(self.export(text, "visitor", law="rubbing") / "law_mujoco_loop.xml"))
            n = 4000
            model.opt.timestep = 1.0 / (rate * n)
            data = mujoco.MjData(model)
            travel = 0.5 * end * (1.0 - np.cos(2.0 * np.pi * np.arange(2 * n + 1) / n))
            force = []
            for i, d in enumerate(travel):
                data.qpos[0], data.qvel[0] = d, (travel[min(i + 1, 2 * n)] - d) / model.opt.timestep
                mujoco.mj_step(model, data)
                force.append(-data.qfrc_spring[0])
            force = np.array(force)
            lost = np.sum(0.5 * (force[n + 1:] + force[n:-1]) * np.diff(travel[n:]))
            print(f"{rate} 1/s: {1e3 * lost:.5g} mJ for {1e3 * loop:.5g}")
            self.assertAlmostEqual(lost / loop, 1.0, delta=0.01)
            data.qpos[0] = -1e-3
            mujoco.mj_step(model, data)
            self.assertEqual(abs(data.qfrc_spring[0]), 0.0)  # none below first touch, whatever was before

    @unittest.skipUnless(POLYNOMIAL, "MuJoCo before 3.7.0")
    def test_bodies_of_ones_own(self):
        include = self.out / "part.xml"
        include.write_text('<mujocoinclude><body name="inner" pos="0 0 1"><joint class="s"/><geom size="0.02" mass="2"/></body></mujocoinclude>')
        models = {
            "a class of defaults, no name, an included file":
                ("inner", (), '<mujoco><option gravity="0 0 0"/><default><default class="s"><joint type="slide" axis="1 0 0"/></default></default>'
                              '<worldbody><include file="part.xml"/></worldbody></mujoco>', [0], 1.0),
            "against its axis, with a reference":
                ("b", ("--axis", "0,0,-1"), '<mujoco><option gravity="0 0 0"/><worldbody><body name="b"><joint type="slide" ref="0.5"/>'
                                            '<geom size="0.02" mass="2"/></body></worldbody></mujoco>', [0], -1.0),
            "a free body in turned frames":
                ("b", ("--axis", "1 0 0"), '<mujoco><compiler eulerseq="XYZ"/><option gravity="0 0 0"/><worldbody><frame euler="90 0 90" pos="1 2 3">'
                                           '<body name="b" euler="10 20 30"><freejoint/><geom size="0.02" mass="2"/></body></frame></worldbody></mujoco>', None, 1.0)}
        for what, (body, arguments, text, coordinate, sign) in models.items():
            out = self.export(text, body, *arguments, "--position-mm", "52.5", "--first-touch-mm", "0.5")
            for name in ("law_mujoco.xml", "law_mujoco_linear.xml"):
                model = mujoco.MjModel.from_xml_path(str(out / name))
                data = mujoco.MjData(model)
                mujoco.mj_forward(model, data)
                rest = data.qpos.copy()
                axis = data.body(body).xmat.reshape(3, 3)[:, 0].copy()
                for d in (-1e-3, 0.2e-3, 1.5e-3, 3e-3, 6e-3):
                    data.qpos[:] = rest
                    if coordinate is None:
                        data.qpos[:3] += d * axis
                    else:
                        data.qpos[coordinate] += sign * d
                    mujoco.mj_forward(model, data)
                    got = data.qfrc_passive[:3] @ axis if coordinate is None else sign * data.qfrc_passive[0]
                    wanted = self.law.force(d - 0.5e-3, 0.0525) if name == "law_mujoco.xml" else None
                    if d < 0.5e-3:
                        self.assertEqual(abs(got), 0.0, (what, d))
                    elif wanted is not None:
                        self.assertAlmostEqual(-got, wanted, delta=2e-6 * self.law.force(6e-3, 0.0525), msg=(what, d))

    def test_wrong_bodies_are_refused_with_those_that_there_are(self):
        (self.out / "fixed.xml").write_text('<mujoco><worldbody><body name="wall"><geom size="1"/></body></worldbody></mujoco>')
        for model, body, words in (("slide.xml", "visitr", ["visitr", "there are: visitor", "did you mean visitor"]),
                                   ("fixed.xml", "wall", ["must be able to move"]), ("slide.xml", "world", ["there are: visitor"])):
            done = subprocess.run([setting.COMMAND, "export", self.out / "plain/law.json", "--mujoco", self.out / model, "--body", body,
                                   "--out", self.out / "none"], capture_output=True, text=True)
            self.assertEqual(done.returncode, 2, done.stderr)
            for word in words:
                self.assertIn(word, done.stderr)
            self.assertFalse((self.out / "none").exists())


if __name__ == "__main__":
    setting.main()
