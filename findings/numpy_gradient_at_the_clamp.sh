#!/usr/bin/env bash
# Title: Curvature from two calls of numpy.gradient is half the true value at the ends, on any mesh.
# Version: NumPy 2.4.6
# Guess: The one-sided difference at the ends is of first order, so the bending moment at the clamp
#   converges as the mesh is refined.
# Seen: Cantilever with a load at its tip, 11, 101 and 1001 points: the clamp carries 0.450, 0.495 and
#   0.4995 of the true curvature, its neighbour tends to 0.75. With edge_order=2 in both calls: 0.925, 0.993
#   and 0.999.
# Hurts: Anyone who takes moments, stresses or stiffness from a measured or computed rod shape: the clamp
#   has the largest moment, and a mesh study confirms the wrong value.
# Documented: The order of the difference at the ends is; that it leaves an error of order one when applied
#   twice is not.
# Instead: Use edge_order=2 in both calls, a three-point formula for the second derivative, or a spline.

set -euo pipefail
sed -n '2,/^$/s/^# \{0,1\}//p' "$0"
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python=${PYTHON:-python3}
"$python" -m venv "$dir/venv"
"$dir/venv/bin/pip" install --quiet --disable-pip-version-check \
  numpy==2.4.6
cd "$dir"
"$dir/venv/bin/python" - <<'EOF'
import numpy as np

print("NumPy", np.__version__, "- curvature over its true value 1 at the clamp")
seen = {}
for points in (11, 101, 1001, 10001):
    x = np.linspace(0.0, 1.0, points)
    shape = x**2 * (3 - x) / 6  # P L^3 / EI = 1; the curvature is 1 - x
    for order in (1, 2):
        slope = np.gradient(shape, x, edge_order=order)
        curvature = np.gradient(slope, x, edge_order=order)
        seen[points, order] = curvature
        print(f"{points:5d} points, edge_order {order}: clamp {curvature[0]:.4f}, next {curvature[1]:.4f}, "
              f"third {curvature[2]:.4f}")
for points in (101, 1001, 10001):
    assert abs(seen[points, 1][0] - 0.5) < 0.01 and abs(seen[points, 1][1] - 0.75) < 0.02
    assert abs(seen[points, 1][2] - 1) < 0.03
    assert abs(seen[points, 2][0] - 1) < 0.01
assert abs(seen[1001, 1][0] - 0.5) < abs(seen[101, 1][0] - 0.5)  # it converges to one half

# a uniformly bent wire: curvature exactly 2 everywhere
x = np.linspace(0.0, 1.0, 501)
curvature = np.gradient(np.gradient(x**2, x), x)
print(f"uniform curvature 2: ends {curvature[0]:.4f} and {curvature[-1]:.4f}, middle {curvature[250]:.4f}")
assert abs(curvature[0] - 1) < 1e-6 and abs(curvature[-1] - 1) < 1e-6 and abs(curvature[250] - 2) < 1e-6
EOF
