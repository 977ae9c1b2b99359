"""What the tests of the Python module have in common."""

import os
import pathlib
import subprocess
import sys
import unittest

SOURCE = pathlib.Path(os.environ.get("SNARE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
COMMAND = os.environ.get("SNARE_COMMAND", str(SOURCE / "build/release/snare"))
SKIPPED = 77  # status of a test that ctest is to call skipped

try:
    import snare  # noqa: F401
except ImportError as reason:
    print(f"skipped: the Python module was not built ({reason}); ./test builds it")
    sys.exit(SKIPPED)


def run_command(*arguments: str) -> None:
    """The command that was built beside the module."""
    subprocess.run([COMMAND, *arguments, "--quiet"], check=True)


def main() -> None:
    unittest.main(verbosity=2)
