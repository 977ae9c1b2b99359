"""law.mo through open Modelica readers, whichever is installed: `modelica`, which simulates the simple laws (it knows no loops, and so not the
table), and `pymoca`, which parses the whole package."""

import pathlib
import sys
import tempfile
import unittest
import warnings

import setting
import snare

setting.add_peer_packages()
try:
    from modelica.lang import parse
    from modelica.sim import causalize, flatten, simulate
except ImportError:
    parse = None
try:
    import pymoca.parser
except ImportError:
    pymoca = None
if parse is None and pymoca is None:
    print("skipped: neither modelica (Python 3.12) nor pymoca is installed")
    sys.exit(setting.SKIPPED)


class Readers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        out = pathlib.Path(cls.folder.name)
        wire = setting.small_wire(out, "\n[table]\npoints = [8, 3, 2]\nmost_points = [8, 3, 2]\n")
        setting.run_command("distil", str(wire), "--out", str(out), "--set", "laws.positions_mm=[52.5]",
                            "--set", "laws.displacement_offsets_mm=[0.0]")
        cls.law = snare.Law(out / "law.json")
        cls.text = (out / "law.mo").read_text()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @unittest.skipIf(parse is None, "modelica is not installed")
    def test_modelica_simulates_the_functions(self):
        package = parse(self.text)
        simple = {one.name: one for one in self.law.simple}
        warnings.simplefilter("ignore", snare.OutsideRange)
        calls = {f"{name}_s52_5(d)": one.force for name, one in simple.items()}
        for call, expected in calls.items():
            model = parse(f"model M\n Real d;\n Real f;\nequation\n d = time*0.01 - 0.001;\n f = snare_law.{call};\nend M;")
            run = simulate(causalize(flatten([package, model], "M")), stop=1.1)
            for d, f in zip(run["d"], run["f"]):  # within the travel and beyond it
                if abs(d) < 1e-9:
                    continue  # first touch, on either side of a jump
                self.assertAlmostEqual(float(f), expected(float(d)), delta=1e-9 * (1.0 + expected(float(d))), msg=call)

    @unittest.skipIf(pymoca is None, "pymoca is not installed")
    def test_pymoca_reads_the_package(self):
        tree = pymoca.parser.parse(self.text)
        self.assertIsNotNone(tree)
        names = set(tree.classes["snare_law"].classes)
        self.assertTrue({"force", "in_range", "travel_in_range", "quadratic_s52_5", "power_s52_5"} <= names, names)


if __name__ == "__main__":
    setting.main()
