"""Three-point bending: the stiffness that a wire on two supports shows, beside 48 EI / l^3 of a slender beam.

usage: three_point_bending.py [PICTURE.png]
"""

import math
import pathlib
import sys

import snare

experiment = pathlib.Path(__file__).with_suffix(".toml")
result = snare.push(experiment)
curve = result["curves"]["middle"]  # NumPy arrays in SI units
stiffness = curve["force_N"][1] / curve["displacement_m"][1]

bending_stiffness = 193e9 * math.pi / 64 * 1.5e-3**4  # EI of the solid section [N m^2]
beam = 48 * bending_stiffness / 0.1**3  # [N/m]
print(f"stiffness: {stiffness:.6g} N/m")
print(f"stiffness over that of a beam: {stiffness / beam:.6g}")

# Which modulus would the readings have given? Three-point bending is how EI is measured.
print(f"bending stiffness from the curve: {stiffness * 0.1**3 / 48:.6g} N m^2")

if len(sys.argv) > 1:
    import snare.plot  # needs matplotlib

    snare.plot.curves(result).figure.savefig(sys.argv[1])
