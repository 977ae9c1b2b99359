#!/usr/bin/env python3
"""Every notebook of examples/notebooks runs from its first cell to its last, and has results within a minute.

usage: slow_notebooks_test.py REPOSITORY

The cells of code are run one after the other in one namespace by plain Python, as a kernel would run them; Jupyter is not needed. Needs the
Python module of the release build and matplotlib; skipped, saying so, where one is absent. A notebook is shipped without outputs.
"""

import contextlib
import io
import json
import os
import pathlib
import sys
import time
import traceback

SKIPPED = 77
LONGEST = 60.0  # [s] of processor time of one notebook
CELLS = {"code": {"cell_type", "execution_count", "id", "metadata", "outputs", "source"}, "markdown": {"cell_type", "id", "metadata", "source"}}

os.environ["MPLBACKEND"] = "agg"
try:
    import matplotlib.pyplot
    import snare  # noqa: F401
except ImportError as reason:
    print(f"skipped: {reason}; apt-get install python3-matplotlib, and ./test builds the module")
    sys.exit(SKIPPED)


def malformed(notebook):
    """What of a notebook is not as nbformat 4.5 has it, or is an output; empty where all is well."""
    if (notebook["nbformat"], notebook["nbformat_minor"]) != (4, 5) or set(notebook) != {"cells", "metadata", "nbformat", "nbformat_minor"}:
        return "is no notebook of nbformat 4.5"
    ids = [cell.get("id") for cell in notebook["cells"]]
    if len(set(ids)) != len(ids):
        return "has two cells of one id"
    for k, cell in enumerate(notebook["cells"]):
        if set(cell) != CELLS.get(cell["cell_type"]):
            return f"cell {k} has the keys {sorted(cell)}"
        if cell.get("outputs") or cell.get("execution_count"):
            return f"cell {k} has outputs, which are not kept"
    return ""


def run(notebook, name):
    """Runs the cells of code; what the cell that failed has raised, empty where none did."""
    namespace = {"__name__": "__main__"}
    for k, cell in enumerate(notebook["cells"]):
        if cell["cell_type"] != "code":
            continue
        printed = io.StringIO()
        try:
            with contextlib.redirect_stdout(printed):
                exec(compile("".join(cell["source"]), f"{name}, cell {k}", "exec"), namespace)
        except Exception:
            return f"{printed.getvalue()}\n{traceback.format_exc()}"
    matplotlib.pyplot.close("all")
    return ""


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    os.environ["SNARE_SOURCE_DIR"] = str(root)
    failed = 0
    notebooks = sorted((root / "examples/notebooks").glob("*.ipynb"))
    for path in notebooks:
        notebook = json.loads(path.read_text(encoding="utf-8"))
        os.chdir(path.parent)
        begin = time.process_time()
        problem = malformed(notebook) or run(notebook, path.name)
        took = time.process_time() - begin
        problem = problem or (f"took longer than {LONGEST:g} s" if took > LONGEST else "")
        print(f"{path.name}: {took:.1f} s {problem}", flush=True)
        failed += bool(problem)
    return 1 if failed or len(notebooks) != 4 else 0


if __name__ == "__main__":
    sys.exit(main())
