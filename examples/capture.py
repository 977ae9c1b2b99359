"""A capture: the ring of a snare turns until its three wires are tight round the shaft of a visitor.

The wires are strings here, much faster than the full rod; `snare compare` says what that costs and changes.

usage: capture.py SCENARIO.toml [PICTURE.png]
"""

import sys

import snare

result = snare.simulate(sys.argv[1], set={"snares[snare].wire.model": "stretched"})
outcome = result["outcome"]
print(f"caught: {int(outcome['caught'])}")
for wire, tension in outcome["peak_tension_N"].items():
    print(f"{wire}: tight after {outcome['tight_s'][wire]:.4g} s, largest tension {tension:.4g} N")
print(f"energy without a source, over what the drives gave: {abs(result['energy_J']['integrator'] / result['energy_J']['work']):.3g}")

if len(sys.argv) > 2:
    import snare.plot  # needs matplotlib

    snare.plot.history(result).figure.savefig(sys.argv[2])
