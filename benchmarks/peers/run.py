#!/usr/bin/env python3
"""Compares snare with other rod programs. Each case has a reference that shares no code with snare.

usage: run.py [--snare SNARE] [--only PROGRAM[/CASE] ...] [--limit SECONDS] [--environments FOLDER] [--rows FILE] [--out FILE]

Installs pinned versions of the programs into virtual environments in FOLDER, by default below the folder for temporary files, and runs every
setting of settings.py, one at a time on one core. Finished runs are kept in the rows FILE, so that a later call resumes; delete the file to
measure again. Then stores the results in benchmarks/results/peers.json (with --only nowhere but in --out) and prints the table.
"""

import argparse
import datetime
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import environments
import settings

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
GOOD = 1e-3  # error that the fastest setting of a program must reach


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--snare", type=pathlib.Path, default=ROOT / "build/release/snare")
    parser.add_argument("--only", nargs="+", default=[], help="EXUDYN, EXUDYN/push, ...")
    parser.add_argument("--limit", type=float, default=300.0, help="seconds of the clock that a run may take")
    parser.add_argument("--environments", type=pathlib.Path, default=pathlib.Path(tempfile.gettempdir()) / "snare_peers")
    parser.add_argument("--rows", type=pathlib.Path, default=pathlib.Path(tempfile.gettempdir()) / "snare_peers" / "rows.jsonl")
    parser.add_argument("--out", type=pathlib.Path, help="default: benchmarks/results/peers.json, with --only none")
    found = parser.parse_args()
    if found.out is None and not found.only:
        found.out = ROOT / "benchmarks/results/peers.json"
    if not found.snare.is_file():
        parser.error(f"--snare {found.snare}: no such file; build it by ./run")
    return found


def called(python, script, arguments, limit, snare):
    """Result that an adapter prints, or the reason for a missing one."""
    one = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")
    try:
        run = subprocess.run([python, str(HERE / script), *arguments], capture_output=True, text=True, timeout=limit, cwd=tempfile.gettempdir(),
                             env={**os.environ, **one, "SNARE_COMMAND": str(snare.resolve())})
    except subprocess.TimeoutExpired:
        return {"reason": f"not done after {limit:.0f} s"}
    for line in run.stdout.splitlines():
        if line.startswith("RESULT "):
            return json.loads(line[len("RESULT "):])
    last = (run.stderr.strip().splitlines() or [f"status {run.returncode}"])[-1]
    return {"reason": re.sub(r"/\S*/", "", last).removeprefix("RuntimeError: ")[:200]}


def errors(case, result, reference):
    """Signed relative errors by name; of a curve over its largest force, of a place over the length."""
    if case == "push":
        largest = max(reference["force_N"])
        return {"force": max((f - r for f, r in zip(result["force_N"], reference["force_N"])), key=abs) / largest}
    if case == "impact":
        damped = reference["damped" if result.get("damped", True) else "undamped"]
        return {"peak": result["peak_N"] / damped["peak_N"] - 1, "impulse": result["impulse_Ns"] / damped["impulse_Ns"] - 1}
    if case == "tip":
        return {"place": math.dist(result["tip"], reference["tip"])}
    if case == "frequency":
        return {"frequency": result["frequency_Hz"] / reference["frequency_Hz"] - 1}
    return {"twist": result["critical"] - 1}


def row_of(program, case, setting, result, reference):
    row = {"program": program, "case": case, "settings": setting}
    if "reason" not in result:
        row["errors"] = errors(case, result, reference)
        row["error"] = max(abs(e) for e in row["errors"].values())
        if not row["error"] < 10.0:
            result = {"reason": "diverges"}
            del row["errors"], row["error"]
    return {**row, **result, "date": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds")}


def order(rows):
    """Observed order of convergence of three runs whose mesh or step is halved, from the errors of the last two; None where they do not fall."""
    if len(rows) < 3 or any("error" not in r for r in rows):
        return None
    first, second, third = (r["error"] for r in rows)
    return math.log2(second / third) if first > second > third > 0 else None


def summary(rows, program, case):
    """Best, default and order of a program in a case."""
    plan = settings.RUNS[program][case]

    def found(setting):
        return next((r for r in rows if (r["program"], r["case"], r["settings"]) == (program, case, setting)), None)

    done = [r for r in map(found, plan["ladder"]) if r]
    with_error = [r for r in done if "error" in r]
    good = [r for r in with_error if r["error"] <= GOOD]
    best = min(good, key=lambda r: r["processor_s"]) if good else min(with_error, key=lambda r: r["error"], default=None)
    default = found(plan["defaults"]) if plan.get("defaults") is not None else None
    halved = [found(s) for s in plan.get("order", [])]
    return {"best": best, "defaults": default, "order": order(halved) if all(halved) else None,
            "order_errors": [r.get("error") for r in halved if r], "reasons": sorted({r["reason"] for r in done if "reason" in r})}


def processor():
    names = [line.split(":")[1].strip() for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("model name")]
    return re.sub(r"\s+\d+-Core.*", "", names[0]) if names else "unknown"


def main():
    o = options()
    o.environments.mkdir(parents=True, exist_ok=True)
    rows = [json.loads(line) for line in o.rows.read_text().splitlines()] if o.rows.is_file() else []
    pythons = {}

    def python_of(program):
        name = settings.PROGRAMS[program]["environment"]
        if name not in pythons:
            print(f"environment {name}", flush=True)
            pythons[name] = environments.environment(o.environments, name)
        return pythons[name]

    def keep(row):
        rows.append(row)
        with o.rows.open("a") as file:
            file.write(json.dumps(row) + "\n")

    reference = next((r for r in rows if r["program"] == "reference"), None)
    if reference is None:
        reference = {"program": "reference", "case": "all", "settings": {}, **called(python_of("snare")[0], "references.py", [], 600, o.snare)}
        if "reason" in reference:
            sys.exit(f"reference: {reference['reason']}")
        keep(reference)
    start = next((r for r in rows if r["case"] == "start"), None)
    if start is None:
        start = {"program": "snare", "case": "start", "settings": {}, **called(python_of("snare")[0], "snare_wire.py", ["start"], o.limit, o.snare)}
        keep(start)
    for program, cases in settings.RUNS.items():
        for case, plan in cases.items():
            if o.only and program not in o.only and f"{program}/{case}" not in o.only:
                continue
            wanted = plan["ladder"] + ([plan["defaults"]] if plan.get("defaults") is not None else []) + plan.get("order", [])
            for setting in wanted:
                if any((r["program"], r["case"], r["settings"]) == (program, case, setting) for r in rows):
                    continue
                python, reason = python_of(program)
                result = {"reason": reason} if reason else called(python, settings.PROGRAMS[program]["script"], [case, json.dumps(setting)], o.limit, o.snare)
                row = row_of(program, case, setting, result, reference[case])
                keep(row)
                print(f"{program:15} {case:9} {json.dumps(setting)}: "
                      + (f"{row['error']:.2e}, {row['processor_s']:.4f} s" if "error" in row else row["reason"]), flush=True)
    for experiment in settings.COSSERAT["experiments"]:
        for solver in settings.COSSERAT["solvers"]:
            setting = {"solver": solver}
            if o.only and "cosseratbench" not in o.only and f"cosseratbench/{experiment}" not in o.only:
                continue
            if any((r["program"], r["case"], r["settings"]) == ("cosseratbench", experiment, setting) for r in rows):
                continue
            python, reason = pythons.setdefault("cosserat", environments.environment(o.environments, "cosserat"))
            result = {"reason": reason} if reason else called(python, "cosserat_snare.py", [experiment, json.dumps(setting)], settings.COSSERAT["limit_s"], o.snare)
            keep({"program": "cosseratbench", "case": experiment, "settings": setting, **result,
                  "date": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds")})
            print("cosseratbench", experiment, solver, result.get("metrics", result.get("reason")), flush=True)
    version = subprocess.run([o.snare, "--version"], capture_output=True, text=True).stdout.strip()
    programs = {p: {"version": version if p == "snare" else v["version"], "what": v["what"]} for p, v in settings.PROGRAMS.items()}
    stored = {"date": max(r["date"] for r in rows if "date" in r), "processor": processor(), "programs": programs, "snare_start_s": start.get("processor_s"),
              "reference": {k: v for k, v in reference.items() if k in ("push", "impact", "tip", "frequency", "twist")},
              "cosseratbench": {"version": settings.COSSERAT["version"], "experiments": {
                  e: {s: {k: v for r in rows if (r["program"], r["case"], r["settings"]) == ("cosseratbench", e, {"solver": s})
                          for k, v in r.items() if k in ("metrics", "processor_s", "reason")} for s in settings.COSSERAT["solvers"]}
                  for e in settings.COSSERAT["experiments"]}},
              "cases": {case: {p: summary(rows, p, case) if case in settings.RUNS.get(p, {}) else {"cannot": settings.CANNOT[p, case]}
                               for p in settings.PROGRAMS} for case in settings.CASES}}
    if o.out:
        o.out.write_text(json.dumps(stored, indent=1) + "\n")
    for case, programs in stored["cases"].items():
        print(f"\n{case}: {settings.CASES[case]}")
        for program, s in programs.items():
            print(f"  {program:15} {text(s)}")
    for experiment, solvers in stored["cosseratbench"]["experiments"].items():
        print(f"\ncosseratbench, {experiment}")
        for solver, s in solvers.items():
            print(f"  {solver:15} {s.get('metrics') or s.get('reason', 'not run')}" + (f" in {s['processor_s']:.3g} s" if "processor_s" in s else ""))


def text(s):
    """One line for a program in a case."""
    if "cannot" in s:
        return s["cannot"]

    def run(r):
        if r is None:
            return "not run"
        return f"{r['error']:.1e} in {r['processor_s']:.3g} s" if "error" in r else r["reason"]

    found = f"{s['order']:.1f}" if s["order"] else "none"
    best = run(s["best"]) if s["best"] else "; ".join(s["reasons"]) or "not run"
    return f"best {best}; defaults {run(s['defaults'])}; order {found}"


if __name__ == "__main__":
    main()
