"""law.mo through open Modelica readers, whichever is installed: `modelica`, which simulates the simple laws (it knows no loops in functions, and so
not the table), and `pymoca`, which parses the whole package.

`modelica` needs Python 3.12; it runs in a process of its own, by the first Python that has it: this one, those of the environments in
SNARE_PEER_PACKAGES, those of PATH and of pyenv.
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import warnings

import setting
import snare

setting.add_peer_packages()
try:
    import pymoca.parser
except ImportError:
    pymoca = None

# Reads a package and an array of equations f = CALL from standard input; prints for each the curve or the error message.
READER = """
import json, sys
from modelica.lang import parse
from modelica.sim import causalize, flatten, simulate
given = json.load(sys.stdin)
package = parse(given["package"])
answers = []
for call in given["calls"]:
    model = parse(f"model M\\n Real d;\\n Real f;\\nequation\\n d = time*0.01 - 0.001;\\n f = snare_law.{call};\\nend M;")
    try:
        run = simulate(causalize(flatten([package, model], "M")), stop=1.1)
        answers.append({"d": [float(v) for v in run["d"]], "f": [float(v) for v in run["f"]]})
    except Exception as reason:
        answers.append({"refused": str(reason)})
print(json.dumps(answers))
"""


def with_modelica():
    """A Python that imports modelica.sim, or None."""
    folders = [pathlib.Path(f) for f in os.environ.get("SNARE_PEER_PACKAGES", "").split(":") if f]
    pyenv = pathlib.Path(os.environ.get("PYENV_ROOT", pathlib.Path.home() / ".pyenv")) / "versions"
    candidates = [sys.executable] + [f.parents[2] / "bin/python" for f in folders if len(f.parents) > 2]
    candidates += [shutil.which(f"python3.{minor}") for minor in (12, 13, 14)]
    candidates += sorted(p for minor in (12, 13, 14) for p in pyenv.glob(f"3.{minor}.*/bin/python"))
    for python in candidates:
        if python and pathlib.Path(python).is_file():
            if subprocess.run([str(python), "-c", "import modelica.sim"], capture_output=True).returncode == 0:
                return str(python)
    return None


READING = with_modelica()
if READING is None and pymoca is None:
    print("skipped: no Python here has modelica (which needs 3.12) or pymoca")
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

    def read(self, calls):
        run = subprocess.run([READING, "-c", READER], input=json.dumps({"package": self.text, "calls": calls}), capture_output=True, text=True,
                             check=True)
        return json.loads(run.stdout)

    @unittest.skipIf(READING is None, "no Python here has modelica (which needs 3.12)")
    def test_modelica_simulates_the_functions(self):
        warnings.simplefilter("ignore", snare.OutsideRange)
        calls = {f"{one.name}_s52_5(d)": one.force for one in self.law.simple}
        for (call, expected), run in zip(calls.items(), self.read(list(calls))):
            self.assertNotIn("refused", run, call)
            for d, f in zip(run["d"], run["f"]):  # within the travel and beyond it
                if abs(d) < 1e-9:
                    continue  # first touch, on either side of a jump
                self.assertAlmostEqual(f, expected(d), delta=1e-9 * (1.0 + expected(d)), msg=call)

    @unittest.skipIf(READING is None, "no Python here has modelica (which needs 3.12)")
    def test_modelica_refuses_the_table(self):
        self.assertIn("'force' uses a 'for' loop", self.read(["force(d, 0.0525, 0.0005)"])[0]["refused"])

    @unittest.skipIf(pymoca is None, "pymoca is not installed")
    def test_pymoca_reads_the_package(self):
        tree = pymoca.parser.parse(self.text)
        self.assertIsNotNone(tree)
        names = set(tree.classes["snare_law"].classes)
        self.assertTrue({"force", "in_range", "travel_in_range", "quadratic_s52_5", "power_s52_5"} <= names, names)


if __name__ == "__main__":
    setting.main()
