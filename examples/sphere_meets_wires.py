"""A sphere falls on three taut wires that cross each other: forces of every contact, and what the run says of its own errors.

usage: sphere_meets_wires.py SCENARIO.toml [PICTURE.png]
"""

import sys

import numpy as np
import snare

result = snare.simulate(sys.argv[1])
for contact in result["contacts"]:
    if contact["touches"]:
        print(f"{contact['contact']}: first touch {contact['first_touch_s']:.4g} s, largest force {contact['peak_force_N']:.4g} N")

# What the wires give the sphere, and its weight, is what its momentum has changed by.
body = result["bodies"][0]
on_wires = sum(np.array(c["impulse_Ns"]) for c in result["contacts"] if c.get("body") == body["body"])
print(f"impulse on the wires: {on_wires[2]:.6g} N s")
error = np.linalg.norm(result["momentum_error_Ns"]) / np.linalg.norm(on_wires)
print(f"momentum without a source, over the impulse: {error:.3g}")

if len(sys.argv) > 2:
    import snare.plot  # needs matplotlib

    snare.plot.history(result).figure.savefig(sys.argv[2])
