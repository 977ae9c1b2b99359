#!/usr/bin/env bash
# Title: The constant of ARIMA and the intercept of SARIMAX differ tenfold for one record and one model.
# Version: statsmodels 0.15.0
# Guess: order=(1, 0, 0) with trend='c' is one model, so the first parameter of both classes is the level of
#   the record.
# Seen: AR(1) of 0.9 around 10 N: ARIMA gives 9.69, SARIMAX and AutoReg 0.88 and 0.87 for the constant. With
#   a drift of 0.01 N per reading, the slope is 0.0099 in ARIMA and 0.0009 in the others. The AR
#   coefficients agree.
# Hurts: Anyone who reads the zero or the drift of a load cell off the table of parameters, or swaps one
#   class for the other: the value changes by one minus the sum of the AR coefficients.
# Documented: Yes, in a page of frequent questions; the tables of results name the numbers const and
#   intercept.
# Instead: Divide the intercept by one minus the AR coefficients, or use ARIMA for the level and say which
#   form is meant.

set -euo pipefail
sed -n '2,/^$/s/^# \{0,1\}//p' "$0"
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python=${PYTHON:-python3}
"$python" -m venv "$dir/venv"
"$dir/venv/bin/pip" install --quiet --disable-pip-version-check \
  statsmodels==0.15.0 scipy==1.17.1 numpy==2.4.6 pandas==3.1.1 patsy==1.0.3
cd "$dir"
"$dir/venv/bin/python" - <<'EOF'
import warnings

import numpy as np
import statsmodels
from statsmodels.tsa.ar_model import AutoReg
from statsmodels.tsa.arima.model import ARIMA
from statsmodels.tsa.statespace.sarimax import SARIMAX

warnings.simplefilter("ignore")
READINGS, LEVEL, DRIFT = 3000, 10.0, 0.01
random = np.random.default_rng(7)


def noise(coefficient=0.9):
    value = np.zeros(READINGS)
    drive = random.normal(size=READINGS)
    for i in range(1, READINGS):
        value[i] = coefficient * value[i - 1] + drive[i]
    return value


def fits(record, trend):
    return (ARIMA(record, order=(1, 0, 0), trend=trend).fit().params,
            SARIMAX(record, order=(1, 0, 0), trend=trend).fit(disp=0).params,
            AutoReg(record, 1, trend=trend).fit().params)


print("statsmodels", statsmodels.__version__)
level = fits(LEVEL + noise(), "c")
for name, values in zip(("ARIMA", "SARIMAX", "AutoReg"), level):
    print(f"level {LEVEL}: {name:8s} constant {values[0]:8.4f}, AR coefficient {values[1]:.4f}")
    print(f"          constant over one minus the coefficient: {values[0] / (1 - values[1]):.3f}")
assert abs(level[0][0] - LEVEL) < 1
for values in level[1:]:
    assert values[0] < 2 and abs(values[0] / (1 - values[1]) - LEVEL) < 1
    assert abs(values[1] - level[0][1]) < 0.01

slope = fits(LEVEL + DRIFT * np.arange(READINGS) + noise(), "ct")
for name, values in zip(("ARIMA", "SARIMAX", "AutoReg"), slope):
    print(f"drift {DRIFT}: {name:8s} slope {values[1]:.5f}, constant {values[0]:.3f}, AR coefficient {values[2]:.4f}")
assert abs(slope[0][1] / DRIFT - 1) < 0.1
for values in slope[1:]:
    assert values[1] < 0.2 * DRIFT
EOF
