#!/usr/bin/env bash
# Title: solve_ivp swings a mass through a wall for eight periods before the contact event is seen, at a
#   tolerance of 1e-6.
# Version: SciPy 1.17.1
# Guess: An event that is defined by the gap is found to about the tolerance of the integration; the dense
#   output is searched for its roots.
# Seen: A mass swings by 1 m towards a wall at 0.999 m. First contact is at 1.526 s; with DOP853 and rtol
#   1e-6 it is reported at 51.79 s, with Radau and rtol 1e-3 at 20.4 s, with RK45 and rtol 1e-3 never within
#   100 s. Smaller tolerances find it only because the steps become shorter.
# Hurts: Anyone who detects touch-down, grazing contact, a closing snare or a limit switch by events: a
#   longer step, that is a better method, is more likely to pass through the wall.
# Documented: Yes: an event is found where its sign differs at the two ends of a step. There is no warning
#   when a step goes through and back.
# Instead: Bound max_step by the shortest contact, or add a second event at zero gap rate, which ends the
#   step at the deepest point and makes the sign change visible.

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
from scipy.integrate import solve_ivp

WALL = 0.999
EXACT = np.arcsin(WALL)


def swing(t, y):
    return [y[1], -y[0]]


def gap(t, y):
    return WALL - y[0]


def turning(t, y):
    return y[1]


gap.terminal = True


def first_contact(method, rtol, **more):
    result = solve_ivp(swing, (0, 100), [0.0, 1.0], events=gap, method=method, rtol=rtol, atol=1e-9, **more)
    return result.t_events[0][0] if len(result.t_events[0]) else np.inf


print("SciPy", scipy.__version__, f"- exact time of first contact {EXACT:.4f} s")
seen = {}
for method in ("RK45", "DOP853", "Radau", "BDF", "LSODA"):
    for rtol in (1e-3, 1e-6):
        seen[method, rtol] = first_contact(method, rtol)
        print(f"{method:7s} rtol {rtol:.0e}: first contact at {seen[method, rtol]:.4f} s")
assert seen["DOP853", 1e-6] > 20 and seen["Radau", 1e-3] > 5 and seen["RK45", 1e-3] > 5
for method in ("RK45", "Radau", "BDF", "LSODA"):
    assert abs(seen[method, 1e-6] - EXACT) < 1e-3

bounded = first_contact("DOP853", 1e-6, max_step=0.02)
print(f"DOP853 with max_step 0.02: {bounded:.4f} s")
assert abs(bounded - EXACT) < 1e-4
turning.terminal, turning.direction = True, -1
reach = solve_ivp(swing, (0, 100), [0.0, 1.0], events=[turning], method="DOP853", rtol=1e-6, atol=1e-9)
stop = reach.t_events[0][0]
second = solve_ivp(swing, (0, stop), [0.0, 1.0], events=gap, method="DOP853", rtol=1e-6, atol=1e-9)
print(f"DOP853 in two parts, ending at the turning point {stop:.4f} s: {second.t_events[0][0]:.4f} s")
assert abs(second.t_events[0][0] - EXACT) < 1e-4
EOF
