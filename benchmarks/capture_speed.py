#!/usr/bin/env python3
"""How fast the shipped capture of a visitor runs, by model of its three wires and by their elements: a minute, 20 outputs a second, one core.

usage: capture_speed.py SNARE [--elements N ...] [--models a,b] [--formulations a,b] [--runs N] [--out RESULT.json]

Runs take turns; of each the median of the real-time factors counts, simulated time over that of the clock, without reading and writing;
`holding` is that of the last 50 s, with the visitor caught: the minute less a run of its first 10 s.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import tempfile

MINUTE, CLOSING = 60.0, 10.0  # [s]
SCENARIO = pathlib.Path(__file__).parents[1] / "data/scenarios/ssrms_htv_capture.toml"


def summary_of(snare, model, elements, formulation, duration):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([snare, "simulate", SCENARIO, "--out", folder + "/out", "--threads", "1", "--quiet", "--set", f"duration_s={duration}",
                        "--set", "output_interval_s=0.05", "--set", f"snares[snare].wire.elements={elements}",
                        "--set", f'snares[snare].wire.model="{model}"',
                        "--set", f'snares[snare].wire.formulation="{formulation}"'], check=True)
        return json.loads(pathlib.Path(folder, "out", "summary.json").read_text())


def seconds(summary, duration):
    return duration / summary["real_time_factor"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("snare")
    parser.add_argument("--elements", type=int, nargs="+", default=[40, 60])
    parser.add_argument("--models", default="stretched,quasi_static,full")
    parser.add_argument("--formulations", default="higher_order,vertices")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--out", type=pathlib.Path)
    options = parser.parse_args()
    formulations = options.formulations.split(",")
    cases = [(model, elements, formulation) for elements in options.elements for model in options.models.split(",")
             for formulation in (formulations if model in ("full", "quasi_static") else formulations[:1])]
    told = {case: [] for case in cases}
    closing = {case: [] for case in cases}
    for _ in range(options.runs):
        for case in cases:
            told[case].append(summary_of(options.snare, *case, MINUTE))
            closing[case].append(seconds(summary_of(options.snare, *case, CLOSING), CLOSING))
    rows = []
    for case in cases:
        model, elements, formulation = case
        runs = told[case]
        held = statistics.median(seconds(r, MINUTE) for r in runs) - statistics.median(closing[case])
        rows.append({"model": model, "elements": elements, "formulation": formulation,
                     "real_time_factor": statistics.median(r["real_time_factor"] for r in runs), "slowest": min(r["real_time_factor"] for r in runs),
                     "holding": (MINUTE - CLOSING) / held,
                     "steps": runs[0]["steps"], "jacobians": runs[0]["jacobians"], "caught": runs[0]["outcome"]["caught"]})
        print("{model:13} {elements:4} elements, {formulation:12}: {real_time_factor:7.1f} times real time "
              "(slowest {slowest:.1f}, holding {holding:.1f}), {steps} steps".format(**rows[-1]), flush=True)
    if options.out:
        options.out.write_text(json.dumps({"scenario": SCENARIO.name, "load": os.getloadavg()[0], "runs": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
