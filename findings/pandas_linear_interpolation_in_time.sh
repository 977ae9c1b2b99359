#!/usr/bin/env bash
# Title: pandas interpolates a time-stamped record with method 'linear' by counting rows, not by time.
# Version: pandas 3.1.1
# Guess: On a time index, interpolate(method='linear') draws straight lines over time.
# Seen: A reading missing after 1 s between 0 N at 0 s and 10 N at 10 s becomes 5 N for 1 N. The force on a
#   spring of 1000 N/m, logged once a second and joined with the travel from an encoder that records in
#   bursts of 0.1 s, gives 9901 N/m within a burst; method "index" gives 1000 N/m to round-off.
# Hurts: Anyone who joins two loggers, fills gaps, or resamples a record with uneven steps before
#   identification: the errors are smooth and look like hysteresis.
# Documented: Yes, in the list of methods; the name and the time index suggest otherwise.
# Instead: Use method='time' or 'index', or numpy.interp on the stamps.

set -euo pipefail
sed -n '2,/^$/s/^# \{0,1\}//p' "$0"
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
python=${PYTHON:-python3}
"$python" -m venv "$dir/venv"
"$dir/venv/bin/pip" install --quiet --disable-pip-version-check \
  pandas==3.1.1 numpy==2.4.6
cd "$dir"
"$dir/venv/bin/python" - <<'EOF'
import numpy as np
import pandas as pd

print("pandas", pd.__version__)
stamps = pd.to_datetime([0.0, 1.0, 10.0], unit="s")
record = pd.Series([0.0, np.nan, 10.0], index=stamps)
linear, timed = record.interpolate(method="linear").iloc[1], record.interpolate(method="time").iloc[1]
print(f"missing reading at 1 s of 10 s: linear {linear:.1f} N, time {timed:.1f} N")
assert linear == 5.0 and timed == 1.0

STIFFNESS, SPEED = 1000.0, 1e-3  # N/m, m/s: the travel is a ramp, so straight lines over time are exact
force_times = np.arange(0.0, 20.5, 1.0)  # a slow load cell
burst = np.arange(0.0, 0.1, 0.001)  # a triggered encoder: 100 readings in 0.1 s, every two seconds
travel_times = np.concatenate([start + 0.4503 + burst for start in range(0, 20, 2)])
travel = pd.Series(SPEED * travel_times, index=travel_times)
force = pd.Series(STIFFNESS * SPEED * force_times, index=force_times)
joined = pd.concat({"travel": travel, "force": force}, axis=1).sort_index()
seen = {}
for method in ("linear", "index"):
    full = joined.interpolate(method=method, limit_area="inside").loc[travel_times]
    local = [np.polyfit(*full.iloc[100 * i:100 * (i + 1)][["travel", "force"]].to_numpy().T, 1)[0] for i in range(10)]
    error = np.abs(full["force"] - STIFFNESS * full["travel"]).max()
    seen[method] = np.mean(local), error
    print(f"method {method}: stiffness within a burst {np.mean(local):.1f} N/m, "
          f"largest error of the force {error:.2e} N")
assert abs(seen["index"][0] - STIFFNESS) < 1e-6 and seen["index"][1] < 1e-9
assert seen["linear"][0] > 5 * STIFFNESS and seen["linear"][1] > 0.3
EOF
