#!/usr/bin/env bash
# Title: With normalize_y, the noise variance alpha of a Gaussian process is in units of the spread of the
#   data, not of the readings.
# Version: scikit-learn 1.9.1
# Guess: normalize_y scales the readings and alpha together and scales the predictions back, so a noise of
#   (0.1 kN)^2 means 100 N in either case.
# Seen: Readings of about +-1000 N with a noise of 100 N and alpha = 100^2: at the maximum, where 1000 N is
#   right, the prediction is 954 N without and 18 N with normalize_y. With alpha divided by the variance of
#   the readings, both agree. With the data in MN, the noise is interpolated.
# Hurts: Anyone who passes the variance of a load cell or of each reading and turns on normalize_y: large
#   forces are fitted by their mean, small forces (in kN) are interpolated with their noise, and both
#   without a message.
# Documented: alpha is described as added to the diagonal during fitting; that the data have been scaled by
#   then is not mentioned.
# Instead: Divide alpha by the variance of the readings, or normalise by hand and leave normalize_y off.

set -euo pipefail
sed -n '2,/^$/s/^# \{0,1\}//p' "$0"
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python=${PYTHON:-python3}
"$python" -m venv "$dir/venv"
"$dir/venv/bin/pip" install --quiet --disable-pip-version-check \
  scikit-learn==1.9.1 scipy==1.17.1 numpy==2.4.6 joblib==1.6.0 threadpoolctl==3.8.0
cd "$dir"
"$dir/venv/bin/python" - <<'EOF'
import numpy as np
import sklearn
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel

random = np.random.default_rng(0)
x = np.linspace(0.0, 1.0, 50)[:, None]
truth = 1000 * np.sin(6 * x[:, 0])
force = truth + 100 * random.normal(size=50)
top = np.array([[0.26]])


def predict(unit, normalise, alpha):
    """Returns mean and standard deviation in newtons at the maximum; unit is newtons per unit of the data."""
    spread = 1.0 if normalise else (700.0 / unit) ** 2
    kernel = ConstantKernel(spread, "fixed") * RBF(0.3, "fixed")
    model = GaussianProcessRegressor(kernel, alpha=alpha, optimizer=None, normalize_y=normalise)
    mean, std = model.fit(x, force / unit).predict(top, return_std=True)
    return mean[0] * unit, std[0] * unit


print("scikit-learn", sklearn.__version__, f"- true force {1000 * np.sin(6 * 0.26):.0f} N, noise 100 N")
plain = predict(1.0, False, 100.0**2)
normal = predict(1.0, True, 100.0**2)
scaled = predict(1.0, True, 100.0**2 / np.var(force))
for name, value in (("without normalize_y", plain), ("with normalize_y", normal),
                    ("with it, alpha over variance", scaled)):
    print(f"alpha of (100 N)^2, {name}: {value[0]:.1f} +- {value[1]:.1f} N")
assert abs(plain[0] - 1000) < 60 and plain[1] < 60
assert abs(normal[0]) < 100
assert abs(scaled[0] - plain[0]) < 10

tiny = predict(1e6, True, (100.0 / 1e6) ** 2)
print(f"the same data in MN, alpha of (100 N)^2: {tiny[0]:.1f} +- {tiny[1]:.1f} N")
assert tiny[1] < 5
assert predict(1e6, False, (100.0 / 1e6) ** 2)[1] > 20
EOF
