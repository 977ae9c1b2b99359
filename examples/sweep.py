"""A sweep: what the stiffness of three-point bending hangs on, beside the closed form.

In small deflection it is 48 EI/l^3, so of the variance of the force (1.5 %)^2 come from EI and (3 x 1 %)^2 from the span l: shares of
0.2 and 0.8. The sweep itself is sweep.toml beside this file; `snare sweep` runs it as well.

usage: sweep.py [PICTURE.png]
"""

import pathlib
import sys

import snare

result = snare.sweep(pathlib.Path(__file__).with_suffix(".toml"))
force = result["fields"]["force"]
print(f"cases: {result['finished']}, force {force['mean']:.4g} +- {force['deviation']:.2g} N")
for name, share in force["sobol"]["variables"].items():
    low, high = share["first_interval95"]
    print(f"share of {name}: {share['first']:.4g} ({low:.3g} to {high:.3g})")

if len(sys.argv) > 1:
    import snare.plot  # needs matplotlib

    axes = snare.plot.indices(result, "force")
    axes.axhline(0.2, color="0.5", linestyle=":", zorder=0)  # 48 EI/l^3: of EI,
    axes.axhline(0.8, color="0.5", linestyle=":", zorder=0)  # and of the span
    axes.figure.savefig(sys.argv[1])
