"""What the tests of the Python module have in common."""

import os
import pathlib
import site
import subprocess
import sys
import unittest

SOURCE = pathlib.Path(os.environ.get("SNARE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
COMMAND = os.environ.get("SNARE_COMMAND", str(SOURCE / "build/release/snare"))
FITTED_WIRE = SOURCE / "tests/data/wires/fitted.toml"  # 0.49 mm of slack between mounts 175 mm apart
SKIPPED = 77  # status of a test that ctest is to call skipped

try:
    import snare  # noqa: F401
except ImportError as reason:
    print(f"skipped: the Python module was not built ({reason}); ./test builds it")
    sys.exit(SKIPPED)


def add_peer_packages() -> None:
    """Makes packages of other programs known that are in folders of SNARE_PEER_PACKAGES (separated by colons), behind those of this Python."""
    for folder in filter(None, os.environ.get("SNARE_PEER_PACKAGES", "").split(":")):
        site.addsitedir(folder)


def small_wire(folder, table="\n[table]\npoints = [8, 3, 3]\nmost_points = [8, 3, 3]\n") -> pathlib.Path:
    """A wire file with a small table, good to some per cent, and no runs in motion. table: "" for the default one."""
    text = FITTED_WIRE.read_text().split("[damping]")[0]
    path = pathlib.Path(folder) / "wire.toml"
    path.write_text(text + table)
    return path


def run_command(*arguments: str) -> None:
    """The command that was built beside the module."""
    subprocess.run([COMMAND, *arguments, "--quiet"], check=True)


def main() -> None:
    unittest.main(verbosity=2)
