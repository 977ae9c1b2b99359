"""`pip install` with Debian's build tools and no net gives a package that works from anywhere."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ.get("SNARE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))


class Pip(unittest.TestCase):
    def test_an_installed_package_pushes_a_wire(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, "-m", "pip", "install", "--no-build-isolation", "--no-deps", "--no-index", "--quiet",
                            "--target", folder, str(SOURCE)], check=True)
            program = (f"import snare; assert snare.__file__.startswith({folder!r}), snare.__file__; "
                       f"print(len(snare.push({str(SOURCE / 'examples/push.toml')!r})['curves']))")
            run = subprocess.run([sys.executable, "-c", program], cwd=folder, capture_output=True, text=True,
                                 env={**os.environ, "PYTHONPATH": folder})
            self.assertEqual(run.stdout, "2\n", run.stderr)
            self.assertTrue((pathlib.Path(folder) / "snare/_core.pyi").is_file())
            self.assertTrue((pathlib.Path(folder) / "snare/py.typed").is_file())


if __name__ == "__main__":
    unittest.main(verbosity=2)
