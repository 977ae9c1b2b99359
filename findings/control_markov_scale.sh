#!/usr/bin/env bash
# Title: python-control identifies two sets of Markov parameters from one record, a factor of the sampling
#   rate apart, depending on how the record is passed.
# Version: python-control 0.10.2
# Guess: markov(response, n) and markov(y, u, n) of the same data are equal, and equal to the response of
#   the discrete system to a unit pulse.
# Seen: Sampled at 100 Hz, the parameters of x+ = 0.9 x + u are 1, 0.9, 0.81 from the arrays, and 100, 90,
#   81 from the response object. impulse_response gives 100, 90, 81; the pulse response by SciPy gives 1,
#   0.9, 0.81.
# Hurts: Anyone who identifies a modal model or a transfer function of a structure and realises it (for
#   example by the eigensystem method): the gain is wrong by the sampling rate, poles and shapes are right.
# Documented: Yes: the description of dt says that it scales the result and that it depends on the type of
#   the input.
# Instead: Pass arrays, or pass dt explicitly; compare the static gain of the realised model with the data.

set -euo pipefail
sed -n '2,/^$/s/^# \{0,1\}//p' "$0"
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python=${PYTHON:-python3}
"$python" -m venv "$dir/venv"
"$dir/venv/bin/pip" install --quiet --disable-pip-version-check \
  control==0.10.2 scipy==1.17.1 numpy==2.4.6 matplotlib==3.11.2
cd "$dir"
"$dir/venv/bin/python" - <<'EOF'
import control
import numpy as np
from scipy import signal

STEP, POLE = 0.01, 0.9
system = control.ss([[POLE]], [[1.0]], [[1.0]], [[0.0]], STEP)
drive = np.random.default_rng(0).normal(size=4000)
response = control.forced_response(system, np.arange(drive.size) * STEP, drive)
exact = np.array([0.0, 1.0, POLE, POLE**2])

from_arrays = np.ravel(control.markov(response.outputs, drive, 60))[:4]
from_response = np.ravel(control.markov(response, 60))[:4]
impulse = control.impulse_response(system, T=STEP * np.arange(4)).outputs
_, pulse = signal.dimpulse((system.A, system.B, system.C, system.D, STEP), n=4)
pulse = np.ravel(pulse[0])
print("python-control", control.__version__, "- exact Markov parameters", exact)
print("markov of arrays          ", np.round(from_arrays, 3))
print("markov of response object ", np.round(from_response, 3))
print("impulse_response          ", np.round(impulse, 3))
print("scipy.signal.dimpulse     ", np.round(pulse, 3))
assert np.allclose(from_arrays, exact, atol=0.02) and np.allclose(pulse, exact)
assert np.allclose(from_response, exact / STEP, atol=2) and np.allclose(impulse, exact / STEP)

gain = float(np.real(control.dcgain(system)))
sums = [np.sum(control.markov(response.outputs, drive, 60)), np.sum(control.markov(response, 60))]
print(f"static gain {gain:.2f}; sum of the parameters {sums[0]:.2f} from arrays, "
      f"{sums[1]:.1f} from the response object")
assert abs(sums[0] / gain - 1) < 0.05 and abs(sums[1] / gain * STEP - 1) < 0.05
EOF
