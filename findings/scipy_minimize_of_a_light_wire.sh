#!/usr/bin/env bash
# Title: scipy.optimize.minimize reports success without moving when the energy of a light wire is given in
#   joules.
# Version: SciPy 1.17.1
# Guess: The minimisers scale with the function: energy in joules and in microjoules leads to the same
#   shape.
# Seen: A wire of 0.1 m and EI = 1e-6 N m^2 under 10 uN: BFGS, L-BFGS-B, CG and SLSQP report success with a
#   tip at 0.0 mm for 3.58 mm, after 0 or 1 iterations. In microjoules, BFGS, L-BFGS-B and SLSQP find 3.58
#   mm.
# Hurts: Anyone who finds equilibria of thin wires, tethers or membranes by energy minimisation, or fits
#   with a cost in small units: the start value is returned as the solution, with the success flag set.
# Documented: The gradient tolerance is described as a bound on the gradient norm; that it is absolute,
#   hence in units of the function, is left to the reader.
# Instead: Divide the energy by its scale (here P L or EI / L), check the residual force against the load,
#   and start twice from different shapes.

set -euo pipefail
sed -n '2,/^$/s/^# \{0,1\}//p' "$0"
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python=${PYTHON:-python3}
"$python" -m venv "$dir/venv"
"$dir/venv/bin/pip" install --quiet --disable-pip-version-check \
  scipy==1.17.1 numpy==2.4.6
cd "$dir"
"$dir/venv/bin/python" - <<'EOF'
import numpy as np
import scipy
from scipy.optimize import minimize

SEGMENTS, LENGTH, STIFFNESS, LOAD = 20, 0.1, 1e-6, 1e-5  # -, m, N m^2, N
SPACING = LENGTH / SEGMENTS


def energy(angles):
    """Returns bending energy minus the work of the tip load, in joules; the first segment is clamped."""
    turned = np.concatenate([[0.0], angles])
    bending = 0.5 * STIFFNESS / SPACING * np.sum(np.diff(turned) ** 2)
    return bending - LOAD * SPACING * np.sum(np.sin(turned))


def tip(result):
    return 1e3 * SPACING * np.sum(np.sin(result.x))  # mm


small = 1e3 * LOAD * LENGTH**3 / 3 / STIFFNESS
print("SciPy", scipy.__version__, f"- straight start; small deflections give {small:.2f} mm")
seen = {}
for method in ("BFGS", "L-BFGS-B", "CG", "SLSQP"):
    for unit, scale in (("J", 1.0), ("uJ", 1e6)):
        result = minimize(lambda angles: scale * energy(angles), np.zeros(SEGMENTS), method=method)
        seen[method, unit] = result.success, result.nit, tip(result)
        print(f"{method:9s} energy in {unit:2s}: success {result.success}, {result.nit} iterations, "
              f"tip {tip(result):.4f} mm")
for method in ("BFGS", "L-BFGS-B", "CG", "SLSQP"):
    success, iterations, deflection = seen[method, "J"]
    assert success and iterations <= 1 and abs(deflection) < 0.05
for method in ("BFGS", "L-BFGS-B", "SLSQP"):
    assert seen[method, "uJ"][0] and abs(seen[method, "uJ"][2] - 3.583) < 0.01
EOF
