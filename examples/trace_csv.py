"""Predicts, fits and traces a push, and draws it: the same experiment as trace_csv.cpp.

usage: trace_csv.py EXPERIMENT.toml [PICTURE.png]
"""

import sys

import snare

experiment = sys.argv[1]
pushed = snare.push(experiment)  # dictionaries; columns are NumPy arrays in SI units
for series, columns in pushed["curves"].items():
    print(f"largest force of {series}: {columns['force_N'].max():.6g} N")

traced = snare.trace(experiment)
print(traced["verdict"])
for effect in traced["selected"]:
    print(f"it lacks: {effect}")
for key, number in traced["final"]["parameters"].items():
    print(f"{key}: {number['value']:.6g} {number['unit']}")

if len(sys.argv) > 2:
    import snare.plot  # needs matplotlib

    snare.plot.curves(traced).figure.savefig(sys.argv[2])
