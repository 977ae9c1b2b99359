"""Laws outside their range: linear, never negative, never falling along the travel, flagged or refused; the same through every export."""

import importlib.util
import json
import pathlib
import subprocess
import tempfile
import unittest
import warnings
import xml.etree.ElementTree

import mo_reader
import setting
import snare
import tables
import numpy as np

SIMPLE = ["quadratic", "quadratic_through_origin", "linear", "power", "stretched_wire", "stretched_wire_linear", "tensioned_wire"]

C_PROGRAM = """#include <math.h>
#include <stdio.h>
#include "law.h"
int main(void) {
  double d, s, e;
  while (scanf("%lf %lf %lf", &d, &s, &e) == 3) {
    double refused = force_or_nan(d, s, e);
    printf("%.17g %d %d %d", force(d, s, e), in_range(d, s, e), travel_in_range(d), refused == force(d, s, e));
LAWS    printf("\\n");
  }
  return 0;
}
"""

CPP_PROGRAM = """#include <cstdio>
#include "law.hpp"
using namespace snare_law;
template <class F> bool refuses(F f) { try { f(); return false; } catch (const std::domain_error&) { return true; } }
int main() {
  double d, s, e;
  while (std::scanf("%lf %lf %lf", &d, &s, &e) == 3) {
    std::printf("%.17g %d %d %d", force(d, s, e), in_range(d, s, e), travel_in_range(d),
                !refuses([&] { return force(d, s, e, Outside::refuse); }));
LAWS    std::printf("\\n");
  }
}
"""


def module_of(path):
    specification = importlib.util.spec_from_file_location("law", path)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


class Continuation(unittest.TestCase):
    """One wire whose positions end before mid-span, one whose position is fixed."""

    @classmethod
    def setUpClass(cls):
        warnings.simplefilter("ignore", snare.OutsideRange)
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = pathlib.Path(cls.folder.name)
        wire = setting.small_wire(cls.out)
        cls.names = ("short", "fixed")
        for name, changes in (("short", ["ranges.position_mm=[40.0, 60.0]", "pusher.friction=0.1"]),
                              ("fixed", ["ranges.position_mm=[52.5]"])):
            arguments = [part for change in [*changes, "laws.positions_mm=[52.5]", "laws.displacement_offsets_mm=[0.0]"] for part in ("--set", change)]
            setting.run_command("distil", str(wire), "--out", str(cls.out / name), *arguments)
        cls.laws = {name: snare.Law(cls.out / name / "law.json") for name in cls.names}
        random = np.random.default_rng(11)
        count = 300
        d = np.concatenate([random.uniform(-0.002, 0.012, count), random.uniform(0.0, 0.1, count)])
        s = random.uniform(-0.03, 0.205, 2 * count)
        e = random.uniform(-0.002, 0.004, 2 * count)
        s[::3], e[::3] = 0.0525, 0.49e-3  # outside in the travel alone, or inside
        e[1::3] = 0.49e-3
        cls.points = np.array([d, s, e])

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_no_force_is_negative_and_none_falls_outside(self):
        for law in self.laws.values():
            d, s, e = self.points
            force = law.force(d, s, e)
            self.assertGreaterEqual(force.min(), 0.0)
            outside = ~law.in_range(d, s, e)
            self.assertGreater(outside.sum(), 300)
            self.assertGreaterEqual(law.stiffness(d, s, e)[outside].min(), 0.0)
            step = 1e-6
            again = ~law.in_range(d + step, s, e)
            rise = law.force(d + step, s, e) - force
            self.assertGreaterEqual(rise[outside & again].min(), -1e-12)  # round-off
            for simple in law.simple:
                travel = np.linspace(0.0, 0.1, 4001)
                force = simple.force(travel)
                self.assertGreaterEqual(force.min(), 0.0, simple.name)
                beyond = travel > law.travel[1]
                self.assertGreaterEqual(np.diff(force[beyond]).min(), -1e-12, simple.name)  # round-off
                np.testing.assert_allclose(np.diff(force[beyond], 2), 0.0, atol=1e-9 * force.max())  # straight
                # The energy is the integral: of the trapezoidal rule with steps of 25 micrometres, second order.
                work = np.sum(0.5 * (simple.force(travel)[1:] + simple.force(travel)[:-1]) * np.diff(travel))
                self.assertAlmostEqual(simple.energy(0.1), work, delta=1e-4 * work)

    def test_it_is_straight_along_the_travel(self):
        for law in self.laws.values():
            end, s, e = law.travel[1], 0.0525, 0.49e-3
            for beyond in (1e-5, 1e-3, 0.1):
                straight = law.force(end, s, e) + law.stiffness(end, s, e) * beyond
                self.assertAlmostEqual(law.force(end + beyond, s, e), straight, delta=1e-9 * straight)

    def test_the_flag_warns_and_refuses(self):
        law = self.laws["short"]
        simple = law.simple[0]
        with warnings.catch_warnings():
            warnings.simplefilter("error", snare.OutsideRange)
            law.force(1e-3, 0.05)
            law.force(-1.0, 0.05)
            simple.force([1e-3, -1.0])
            for call in (lambda: law.force([1e-3, 0.1], 0.05), lambda: law.stiffness(1e-3, 0.08), lambda: law.force(1e-3, 0.05, 0.1),
                         lambda: simple.force(0.1), lambda: simple.energy([0.1])):
                with self.assertRaisesRegex(snare.OutsideRange, "in_range"):
                    call()
        for call in (lambda: law.force([1e-3, 0.1], 0.05, outside="refuse"), lambda: simple.force(0.1, outside="refuse"),
                     lambda: law.stiffness(1e-3, 0.08, outside="refuse")):
            with self.assertRaisesRegex(ValueError, "outside the range of the"):
                call()
        self.assertEqual(list(law.in_range([-1.0, 1e-3, 0.1], 0.05)), [True, True, False])
        self.assertEqual(list(simple.in_range([-1.0, 1e-3, 0.1])), [True, True, False])

    def compare(self, name, rows, places=11):
        """Rows of an export, as force, in_range, travel_in_range, not refused, simple laws: with the library."""
        law = self.laws[name]
        d, s, e = self.points
        rows = np.array(rows, dtype=float)
        force = law.force(d, s, e)
        np.testing.assert_allclose(rows[:, 0], force, rtol=10.0**-places, atol=1e-9)
        np.testing.assert_array_equal(rows[:, 1].astype(bool), law.in_range(d, s, e))
        np.testing.assert_array_equal(rows[:, 3].astype(bool), law.in_range(d, s, e))
        simple = {one.name: one for one in law.simple}
        for k, one in enumerate(SIMPLE):
            np.testing.assert_allclose(rows[:, 4 + k], simple[one].force(d), rtol=10.0**-places, atol=1e-9, err_msg=one)
            np.testing.assert_array_equal(rows[:, 2].astype(bool), simple[one].in_range(d))

    def test_c_and_cpp_say_the_same(self):
        for name in self.names:
            for compiler, program, source, print_one in (
                    (["gcc", "-std=c99"], C_PROGRAM, "law.c", '    printf(" %.17g", {}_s52_5(d));\n'),
                    (["g++", "-std=c++17"], CPP_PROGRAM, None, '    std::printf(" %.17g", {}_s52_5(d));\n')):
                ending = "c" if source else "cpp"
                text = program.replace("LAWS", "".join(print_one.format(one) for one in SIMPLE))
                (self.out / name / f"main.{ending}").write_text(text)
                subprocess.run([*compiler, "-Wall", "-Wextra", "-Werror", f"main.{ending}", *([source] if source else []), "-lm", "-o",
                                f"run_{ending}"], cwd=self.out / name, check=True)
                said = subprocess.run([self.out / name / f"run_{ending}"], input="\n".join(" ".join(map(repr, p)) for p in self.points.T.tolist()),
                                      check=True, capture_output=True, text=True).stdout
                self.compare(name, [line.split() for line in said.splitlines()])

    def rows_of_functions(self, functions, refusing):
        rows = []
        for d, s, e in self.points.T.tolist():
            try:
                refusing(d, s, e)
                accepted = True
            except (ValueError, AssertionError):
                accepted = False
            rows.append([functions["force"](d, s, e), functions["in_range"](d, s, e), functions["travel_in_range"](d), accepted,
                         *(functions[f"{one}_s52_5"](d) for one in SIMPLE)])
        return rows

    def test_python_says_the_same(self):
        for name in self.names:
            module = module_of(self.out / name / "law.py")
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", module.OutsideRange)
                self.compare(name, self.rows_of_functions(vars(module), lambda *point: module.force(*point, outside="refuse")))
            with warnings.catch_warnings():
                warnings.simplefilter("error", module.OutsideRange)
                for call in (lambda: module.force(0.1, 0.05, 0.49e-3), lambda: module.linear_s52_5(0.1)):
                    with self.assertRaises(module.OutsideRange):
                        call()
            with self.assertRaisesRegex(ValueError, "must be finite"):
                module.force(float("nan"), 0.05, 0.49e-3)
            with self.assertRaisesRegex(ValueError, "must be 'extrapolate' or 'refuse'"):
                module.force(1e-3, 0.05, 0.49e-3, outside="maybe")

    def test_modelica_says_the_same(self):
        for name in self.names:
            package = mo_reader.load((self.out / name / "law.mo").read_text())
            self.compare(name, self.rows_of_functions(package, package["force_or_stop"]))
            with self.assertRaisesRegex(AssertionError, "outside the range"):
                package["linear_s52_5_or_stop"](0.1)
            self.assertEqual(package["linear_s52_5_or_stop"](1e-3), package["linear_s52_5"](1e-3))

    def test_tables_of_data_alone_are_written_out_beyond_the_range(self):
        """Simulink's and ADAMS' file, read as these programs read them."""
        for name in self.names:
            law = self.laws[name]
            content = json.loads((self.out / name / "law.json").read_text())["cases"][0]
            exports = content["exports"]
            self.assertEqual(exports["simulink"]["range"]["travel_mm"], [0.0, 1e3 * law.travel[1]])
            simulink = tables.lookup_table((self.out / name / "law_simulink.csv").read_text())
            splines = tables.adams_splines((self.out / name / "law_adams.adm").read_text())
            surface = splines[max(splines)]
            d, s = self.points[:2]
            e = law.nominal_slack
            end = law.travel[1]
            for read, stated in ((simulink, exports["simulink"]["largest_error_N"]), (surface.akima, exports["adams"]["largest_error_N"]),
                                 (surface.linear, exports["adams"]["largest_error_N"])):
                self.assertLessEqual(stated, content["table"]["error"]["bound_N"])
                force = np.array([read(*point) for point in zip(d, s)])
                self.assertGreaterEqual(force.min(), 0.0)
                # The stated error holds between the numbers of the file, 2.5 % more off the points where it was taken; beyond them the
                # error of a straight line grows with the distance.
                allowed = 1.025 * stated * np.maximum(1.0, 2.0 * d / end)
                self.assertGreaterEqual((allowed - np.abs(force - law.force(d, s, e))).min(), 0.0)
                rising = np.array([read(x + 1e-5, y) for x, y in zip(d, s)]) - force
                self.assertGreaterEqual(rising[d > end].min(), -1e-9)
            for k, simple in enumerate(exports["adams"]["curves_largest_error_N"], 1):
                travel = np.concatenate([np.linspace(-0.01, end, 300), np.linspace(end, 0.1, 100)])
                full = law.force(travel, content["positions"][k - 1]["position_mm"] * 1e-3, e)
                for read in (splines[k].akima, splines[k].linear):
                    force = np.array([read(x, 0.0) for x in travel])
                    self.assertGreaterEqual(force.min(), 0.0)
                    self.assertLess(np.abs(force - full)[travel <= end].max(), simple + law.bound)
                    self.assertGreaterEqual(np.diff(force[300:]).min(), -1e-9)

    def test_springs_of_mujoco_push_and_carry_their_range(self):
        for name in self.names:
            root = xml.etree.ElementTree.parse(self.out / name / "law_mujoco.xml").getroot()
            joint = root.find(".//worldbody//joint[@name='wire_travel_s52_5']").get("name")
            law, end = self.laws[name], self.laws[name].travel[1]
            q = np.concatenate([np.linspace(-0.01, 0.0, 11), np.linspace(0.0, 0.1, 1001)])
            force = np.zeros(q.size)
            for tendon in root.findall(".//tendon/fixed"):
                if tendon.find("joint").get("joint") != joint:
                    continue
                k = [float(x) for x in tendon.get("stiffness").split()]
                low, high = (float(x) for x in tendon.get("springlength").split())
                self.assertLess(low, -100.0)
                u = np.maximum(0.0, q - high)
                force += u * (k[0] + u * (k[1] + u * k[2]))
            wanted = np.array([law.force(d, 0.0525) if d >= 0.0 else 0.0 for d in q])
            self.assertLess(np.abs(force - wanted).max(), 1e-9 * wanted.max())
            numeric = root.find(".//custom/numeric[@name='wire_travel_s52_5_range']")
            self.assertEqual([float(x) for x in numeric.get("data").split()], [0.0, end])
            self.assertEqual(root.find(".//sensor/jointpos[@name='wire_travel_s52_5_now']").get("joint"), joint)


class Positions(unittest.TestCase):
    """Positions on both sides of mid-span, each export against the full wire over all of them."""

    def test_every_export_holds_over_the_positions_that_were_asked_for(self):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder)
            text = setting.FITTED_WIRE.read_text().split("[ranges]")[0].split("[damping]")[0]
            (out / "wire.toml").write_text(text + "[ranges]\ntravel_mm = 2.0\nposition_mm = [20.0, 150.0]\nslack_mm = [0.4, 0.6]\n"
                                           "[table]\npoints = [10, 9, 2]\nmost_points = [10, 9, 2]\n[laws]\npositions_mm = [30.0, 120.0]\n")
            setting.run_command("distil", str(out / "wire.toml"), "--out", folder)
            content = json.loads((out / "law.json").read_text())["cases"][0]
            exports, bound = content["exports"], content["table"]["error"]["bound_N"]
            for name in ("c", "cpp", "python", "modelica", "mujoco", "simulink", "adams"):
                self.assertTrue(np.all(np.asarray(exports[name]["largest_error_N"]) > 0.0), name)
            self.assertEqual(exports["adams"]["range"]["position_mm"], [[20.0, 155.0]])
            series = "".join(f'[[series]]\nname = "p{s}"\ncontact_position_mm = {s}.0\ntravel_mm = 2.0\npoints = 9\n'
                             for s in (20, 47, 88, 101, 133, 150))
            (out / "push.toml").write_text(text.replace("snare-wire/1", "snare-experiment/1") + series)
            pushed = snare.push(out / "push.toml")["curves"]
            module = module_of(out / "law.py")
            simulink = tables.lookup_table((out / "law_simulink.csv").read_text())
            splines = tables.adams_splines((out / "law_adams.adm").read_text())
            surface = splines[max(splines)]
            self.assertIn("0.02 to 0.155 m", (out / "law.h").read_text())
            package = mo_reader.load((out / "law.mo").read_text())
            largest = 0.0
            for name, curve in pushed.items():
                s = float(name[1:]) * 1e-3
                for d, full in zip(curve["displacement_m"], curve["force_N"]):
                    largest = max(largest, full)
                    for force, stated in ((module.force(d, s, 0.49e-3), 0.0), (package["force"](d, s, 0.49e-3), 0.0),
                                          (simulink(d, s), exports["simulink"]["largest_error_N"]),
                                          (surface.akima(d, s), exports["adams"]["largest_error_N"]),
                                          (surface.linear(d, s), exports["adams"]["largest_error_N"])):
                        self.assertLess(abs(force - full), bound + 1.025 * stated, (name, d))
            self.assertGreater(largest, 20.0 * bound)  # the test tells


if __name__ == "__main__":
    setting.main()
