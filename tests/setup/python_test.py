"""scripts/install_python.sh makes `import snare` work in the Pythons of Debian 12. Skipped where the module was not built.

    python_test.py REPOSITORY
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv.pop() if len(sys.argv) > 1 else pathlib.Path(__file__).parents[2])
if not list((ROOT / "build/release/python/snare").glob("_core*.so")) or not (ROOT / "build/release/configured.stamp").exists():
    print("skipped: ./test builds the module")
    sys.exit(77)


class InstallPython(unittest.TestCase):
    def installed(self, home, python, *arguments, **more):
        """Runs the script with this home and imports snare by `python` from elsewhere; returns the path of the module."""
        unwanted = ("PYTHONPATH", "VIRTUAL_ENV", "PYTHONNOUSERSITE")
        environment = {**{key: value for key, value in os.environ.items() if key not in unwanted}, "HOME": home, **more}
        script = subprocess.run([ROOT / "scripts/install_python.sh", *arguments], env=environment, capture_output=True, text=True)
        self.assertEqual(script.returncode, 0, script.stderr)
        self.assertIn(f"import snare works in {python}", script.stdout)
        run = subprocess.run([python, "-c", "import snare; print(snare.__file__)"], cwd="/", env=environment,
                             capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        return run.stdout.strip()

    def test_plain_and_externally_managed_python(self):
        with tempfile.TemporaryDirectory() as home:
            self.assertTrue(self.installed(home, "/usr/bin/python3").startswith(str(ROOT / "build/release/python")))
            self.assertEqual(len(list(pathlib.Path(home).rglob("snare.pth"))), 1)

    def test_virtual_environment(self):
        for active in (False, True):
            with self.subTest(active=active), tempfile.TemporaryDirectory() as home:
                folder = pathlib.Path(home) / "environment with a blank"
                subprocess.run(["/usr/bin/python3", "-m", "venv", "--without-pip", "--system-site-packages", folder], check=True)
                python = str(folder / "bin/python")
                self.installed(home, python, *([] if active else [python]), **({"VIRTUAL_ENV": str(folder)} if active else {}))
                self.assertEqual([p.relative_to(folder).parts[0] for p in pathlib.Path(home).rglob("snare.pth")], ["lib"])

    def test_without_numpy_it_names_the_command(self):
        with tempfile.TemporaryDirectory() as home:
            subprocess.run(["/usr/bin/python3", "-m", "venv", "--without-pip", f"{home}/bare"], check=True)
            run = subprocess.run([ROOT / "scripts/install_python.sh", f"{home}/bare/bin/python"], capture_output=True, text=True,
                                 env={**os.environ, "HOME": home})
            self.assertEqual(run.returncode, 1)
            self.assertIn(f"{home}/bare/bin/python -m pip install numpy", run.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
