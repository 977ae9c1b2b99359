#!/usr/bin/env python3
"""Gauss and Newton's method beside Nelder and Mead's on blind records without an effect: fit_methods.py SNARE [--kinds a,b] [--seeds N] [--first SEED]
[--out FILE].

Every number is declared up to a tenth off and fitted to the first record by both; the second record is predicted with what the first one gave. Told: the
simulations of each method, the errors of the numbers against the truth, and the error of the record held out over its noise.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

from kinds import KINDS, RECORDS
from sets import Batch

METHODS = ("gauss_newton", "nelder_mead")


def fit(snare, folder, method):
    out = folder / method
    done = subprocess.run([snare, "fit", str(folder / "record.toml"), "--quiet", "--threads", "1", "--set", f'fit.method="{method}"', "--out", str(out)],
                          capture_output=True, text=True, timeout=600)
    if done.returncode != 0:
        raise SystemExit(f"status {done.returncode}: {done.stderr}")
    return json.loads((out / "fit.json").read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("snare", type=lambda path: str(pathlib.Path(path).resolve()))
    parser.add_argument("--kinds", default="payload,swing,step,flight")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--out", type=pathlib.Path)
    options = parser.parse_args()
    result = {}
    for name in options.kinds.split(","):
        kind = KINDS[name]
        batch = Batch(name, [(None, 0, seed) for seed in range(options.first, options.first + options.seeds)])
        readings = {record: batch.readings(batch.amount, record) for record in RECORDS}
        told = {method: {"simulations": [], "worst_error_percent": [], "heldout_over_sigma": []} for method in METHODS}
        for c in range(options.seeds):
            with tempfile.TemporaryDirectory() as temporary:
                folder = pathlib.Path(temporary)
                batch.write(c, folder, readings)
                for method in METHODS:
                    found = fit(options.snare, folder, method)
                    errors = [abs(found["fit"]["parameters"][key]["value"] / batch.truth[number][c] - 1.0) for key, number in kind.free.items()]
                    held = [channel["rmse"] / channel["sigma"] for channel in found["heldout"]["fit"]]
                    told[method]["simulations"].append(found["simulations"]["base_fit"])
                    told[method]["worst_error_percent"].append(round(100.0 * max(errors), 4))
                    told[method]["heldout_over_sigma"].append(round(max(held), 3))
        newton, simplex = (sum(told[method]["simulations"]) for method in METHODS)
        told["simulations_ratio"] = round(simplex / newton, 2)
        result[name] = told
        print(name, json.dumps(told), flush=True)
    if options.out:
        options.out.write_text(json.dumps(result, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
