"""snare: what a loose elastic wire does when something pushes on it.

The verbs are those of the command and read the same files::

    import snare
    result = snare.push("my_push.toml", set={"pusher.friction": 0.2})
    result["curves"]["middle"]["force_N"]                   # NumPy arrays
    snare.trace("my_push.toml", progress=print)["verdict"]
    law = snare.distil("wire.toml")["laws"][0]              # or snare.Law("out/distil/law.json")
    law.force(0.5e-3, 0.04)                                 # m, m -> N

A verb returns a dictionary: what the command writes as JSON, under the same names, with the unit in the name. Arrays of
numbers are NumPy arrays. The columns of tables (``curves``, ``history``, ``telemetry``) are in SI units, whatever the CSV
files have: ``displacement_m``, ``body_angle_rad``; a cell that is empty in the file is NaN. Functions of plain numbers take
and return SI units. The formats of all files: docs/README.md of the project.

Long work leaves other threads of Python running, and an interrupt (Ctrl-C) ends it within a second.
"""

from snare._core import InputError, Law, OutsideRange, SimpleLaw, __version__
from snare._results import load
from snare._verbs import SolverError, compare, distil, fit, push, simulate, sweep, trace

__all__ = ["InputError", "Law", "OutsideRange", "SimpleLaw", "SolverError", "__version__", "compare", "distil", "fit", "load",
           "push", "simulate", "sweep", "trace"]
