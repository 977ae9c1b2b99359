#!/usr/bin/env python3
"""Every notebook of examples/notebooks runs from its first cell to its last, and has results within a minute.

usage: slow_notebooks_test.py REPOSITORY

Needs the Python module of the release build and Debian's python3-nbclient, python3-nbformat and python3-ipykernel; skipped, saying so, where
one is absent.
"""

import os
import pathlib
import sys
import time

SKIPPED = 77
LONGEST = 60.0  # [s] of one notebook

try:
    import nbclient
    import nbformat
    import snare  # noqa: F401
    import ipykernel  # noqa: F401
except ImportError as reason:
    print(f"skipped: {reason}; apt-get install python3-nbclient python3-ipykernel, and ./test builds the module")
    sys.exit(SKIPPED)


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    os.environ.update(SNARE_SOURCE_DIR=str(root), MPLBACKEND="agg", PYTHONDONTWRITEBYTECODE="1", PYDEVD_DISABLE_FILE_VALIDATION="1")
    failed = 0
    notebooks = sorted((root / "examples/notebooks").glob("*.ipynb"))
    for path in notebooks:
        notebook = nbformat.read(path, as_version=4)
        nbformat.validate(notebook)
        problem = next((f"cell {k} has outputs, which are not kept" for k, c in enumerate(notebook.cells) if c.get("outputs")), "")
        begin = time.monotonic()
        try:
            nbclient.NotebookClient(notebook, timeout=600, kernel_name="python3", resources={"metadata": {"path": str(path.parent)}}).execute()
        except nbclient.exceptions.CellExecutionError as error:
            problem = str(error)
        took = time.monotonic() - begin
        problem = problem or (f"took longer than {LONGEST:g} s" if took > LONGEST else "")
        print(f"{path.name}: {took:.1f} s {problem}")
        failed += bool(problem)
    return 1 if failed or len(notebooks) != 4 else 0


if __name__ == "__main__":
    sys.exit(main())
