#!/usr/bin/env python3
"""Fits numbers that go together from several starts: an answer may depend on the start along reported null directions only.

usage: null_directions.py SNARE [--pushes N] [--pairs N] [--triples N] [--ringdowns N] [--part K N] [--seed S] [--results FILE]

--pushes: of all pairs of the numbers that a push can fit, so many, evenly spread (0: all); --pairs and --triples: so many, drawn
with the seed, of the numbers of three small scenarios; --ringdowns: so many records of known modes. --part K N: every Nth case
from the Kth on. Every pair and triple is fitted from five starts. A case fails where
- a number with an interval differs between two starts by more than a fifth of its standard error (and 1e-4 of itself),
- a number has an interval from one start and none from another, both of which end in the same minimum,
- a run ends with a status other than 0 and 2, or a refusal without a reason.
Starts that end at a chi2 that is higher than the least by more than 1 are counted as other minima, not as failures: the answer is
then wrong for another reason; those that end with a number on its bound, which the fit says and which hangs on the start, are compared
with those on the same bound. A number of which a warning says that it is not identifiable counts as one without an interval. Prints a line
a failure and the sums; status 1 with failures.
"""

import argparse
import csv
import itertools
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import tomllib

FACTORS = (1.0, 0.95, 1.05, 0.9, 1.1)  # of the starts, over the values with which the readings were made
WIRE = """schema = "snare-experiment/1"
title = "a loose wire"
[wire]
construction = "{construction}"
diameter_mm = 1.5
length_mm = 176.0
youngs_modulus_GPa = 193.0
poisson_ratio = 0.29
density_kg_m3 = 7930.0
{wire}
[mount]
kind = "{kind}"
span_mm = 175.0
{mount}
[pusher]
shape = "cylinder"
radius_mm = 6.0
friction = {friction}
direction = "outward"
{pusher}
[gravity]
vector_m_s2 = [0.0, {gravity}, 0.0]
[solver]
elements = 32
extrapolate = false
"""
# Tests in which different numbers are declared.
TESTS = [
    dict(construction="solid", wire="bending_stiffness_Nm2 = 0.0094\naxial_stiffness_N = 19300.0", kind="clamped", mount="",
         friction=0.0, pusher="", gravity=-9.81),
    dict(construction="solid", wire="natural_curvature_1_m = 1.0", kind="clamped",
         mount="rotational_stiffness_Nm_rad = 5.0\ntranslational_stiffness_N_m = 1.0e6", friction=0.1,
         pusher="compliance_m_N = 1.0e-6", gravity=-9.81),
    dict(construction="solid", wire="", kind="clamped", mount="slip_tension_N = 60.0", friction=0.0, pusher="", gravity=0.0),
    dict(construction="strand", wire="bending_stiffness_Nm2 = 0.0094\naxial_stiffness_N = 19300.0\n"
         "strand_extra_stiffness_Nm2 = 0.01\nstrand_slip_curvature_1_m = 1.0\nstrand_slip_breadth = 1.0",
         kind="clamped", mount="", friction=0.0, pusher="", gravity=0.0),
    dict(construction="solid", wire="yield_stress_MPa = 300.0\nhardening_ratio = 0.05", kind="clamped", mount="", friction=0.0,
         pusher="", gravity=0.0),
    dict(construction="solid", wire="", kind="supports", mount="support_radius_mm = 3.0", friction=0.1, pusher="", gravity=-9.81),
]
# Where a fitted number stands in the file, if it does.
STARTS = {"strand_hysteresis.extra_stiffness_Nm2": "wire.strand_extra_stiffness_Nm2",
          "strand_hysteresis.slip_curvature_1_m": "wire.strand_slip_curvature_1_m",
          "strand_hysteresis.slip_breadth": "wire.strand_slip_breadth",
          "plasticity.yield_stress_MPa": "wire.yield_stress_MPa", "plasticity.hardening_ratio": "wire.hardening_ratio",
          "mount_slip.tension_N": "mount.slip_tension_N"}
BODY = """schema = "snare-scenario/2"
title = "small"
duration_s = {duration}
output_interval_s = 0.001
"""
SCENARIOS = [
    # A body meets a wire of the quadratic law.
    (0.2, 40, BODY.format(duration=0.2) + """[[wires]]
name = "wire"
construction = "solid"
diameter_mm = 1.5
length_mm = 180.0
youngs_modulus_GPa = 193.0
poisson_ratio = 0.29
density_kg_m3 = 7930.0
from_mm = [0.0, 0.0, 0.0]
to_mm = [175.0, 0.0, 0.0]
bulge = [0.0, 1.0, 0.0]
model = "quadratic"
quadratic = { position_mm = 90.0, A_N_m2 = 890183.0, B_N_m = 300.0, C_N = 0.1 }
[[bodies]]
name = "target"
mass_kg = 8.9
inertia_kg_m2 = [0.16, 0.16, 0.16]
position_mm = [90.0, -88.0123, 0.0]
velocity_m_s = [0.0, 0.1, 0.0]
[[shapes]]
name = "probe"
frame = "target"
kind = "capsule"
position_mm = [0.0, 100.0, 0.0]
radius_mm = 6.0
length_mm = 60.0
[[sensors]]
name = "seen"
kind = "velocity"
frame = "target"
rate_Hz = 1000
""", "seen_y_m_s", 1e-3),
    # A body on a damped spring.
    (1.0, 50, BODY.format(duration=1.0) + """[[bodies]]
name = "block"
mass_kg = 2.0
inertia_kg_m2 = [0.01, 0.01, 0.01]
position_mm = [10.0, 0.0, 0.0]
[[bushings]]
name = "spring"
frame = "world"
other_frame = "block"
translational_stiffness_N_m = 800.0
translational_damping_Ns_m = 4.0
rotational_stiffness_Nm_rad = 10.0
rotational_damping_Nms_rad = 0.1
[[sensors]]
name = "seen"
kind = "velocity"
frame = "block"
rate_Hz = 1000
""", "seen_x_m_s", 1e-3),
    # The same pulled by a constant force, from rest.
    (1.0, 50, BODY.format(duration=1.0) + """[[bodies]]
name = "block"
mass_kg = 2.0
inertia_kg_m2 = [0.01, 0.01, 0.01]
[[bushings]]
name = "spring"
frame = "world"
other_frame = "block"
translational_stiffness_N_m = 800.0
translational_damping_Ns_m = 4.0
rotational_stiffness_Nm_rad = 10.0
rotational_damping_Nms_rad = 0.1
[[loads]]
name = "pull"
frame = "block"
force_N = [6.0, 1.0, 0.0]
[[sensors]]
name = "seen"
kind = "position"
frame = "block"
rate_Hz = 1000
""", "seen_x_mm", 5e-2)]


def run(snare, *arguments, cwd):
    """Status (that of timeout(1) where a run takes longer than five minutes), what is said, and JSON of a run."""
    try:
        done = subprocess.run([snare, *arguments, "--json", "--quiet", "--threads", "1", "--out", "o"], cwd=cwd,
                              capture_output=True, text=True, timeout=300)
    except subprocess.TimeoutExpired:
        return 124, "took longer than five minutes", None
    try:
        return done.returncode, done.stderr, json.loads(done.stdout)
    except json.JSONDecodeError:
        return done.returncode, done.stderr, None


def leaves(value, path=""):
    """Keys of the numbers of a scenario, as --set has them, with their values."""
    if isinstance(value, bool):
        return
    if isinstance(value, (int, float)):
        yield path, float(value)
    elif isinstance(value, dict):
        for k, v in value.items():
            yield from leaves(v, f"{path}.{k}" if path else k)
    elif isinstance(value, list):
        for i, v in enumerate(value):
            name = v.get("name") if isinstance(v, dict) else None
            yield from leaves(v, f"{path}[{name or i + 1}]")


def at(document, key):
    for part in key.split("."):
        document = document.get(part, {}) if isinstance(document, dict) else {}
    return document if isinstance(document, (int, float)) and not isinstance(document, bool) else None


class Push:
    """Readings of one kind of test, loaded and unloaded, in a folder."""

    def __init__(self, snare, folder, test, seed):
        self.snare, self.folder = snare, folder
        folder.mkdir()
        self.text = WIRE.format(**test)
        self.declared = tomllib.loads(self.text)
        plain = self.text
        for name, place in (("a", 50.0), ("b", 87.5)):
            plain += f'[[series]]\nname = "{name}"\ncontact_position_mm = {place}\npath_mm = [0.0, 1.5, 0.2]\npoints = 8\n'
        (folder / "plain.toml").write_text(plain)
        status, said, _ = run(snare, "push", "plain.toml", cwd=folder)
        if status != 0:
            raise RuntimeError(said)
        rows = list(csv.DictReader((folder / "o/curves.csv").open()))
        noise = random.Random(seed)
        fitted = self.text
        for name, place in (("a", 50.0), ("b", 87.5)):
            own = [r for r in rows if r["series"] == name]
            peak = max(abs(float(r["force_N"])) for r in own)
            sigma = 0.005 * peak
            lines = ["displacement_mm,force_N,time_s"]
            time, last = 0.0, 0.0
            for r in own:
                d = float(r["displacement_mm"])
                time += abs(d - last) / 0.5
                last = d
                lines.append(f'{d},{float(r["force_N"]) + noise.gauss(0.0, sigma):.9g},{time:.6g}')
            (folder / f"{name}.csv").write_text("\n".join(lines) + "\n")
            fitted += (f'[[series]]\nname = "{name}"\ncontact_position_mm = {place}\nfile = "{name}.csv"\n'
                       f"force_sigma_N = {sigma:.6g}\n")
        (folder / "x.toml").write_text(fitted)
        self.readings = len(rows)

    def fit(self, keys, factor):
        """Answer of one start: the declared values of the numbers in the file times the factor."""
        arguments = ["fit", "x.toml", "--set", f"fit.free={json.dumps(keys)}"]
        for k, key in enumerate(keys):
            name = STARTS.get(key, key)
            value = at(self.declared, name)
            if value is not None and name != "mount.span_mm" and name != "wire.length_mm":
                arguments += ["--set", f"{name}={value * (factor if k % 2 == 0 else 2.0 - factor)!r}"]
            elif name == "wire.length_mm":
                arguments += ["--set", f"{name}={value + 2.0 * (factor - 1.0)!r}"]
        return run(self.snare, *arguments, cwd=self.folder)


class Record:
    """Readings of one scenario in a folder."""

    def __init__(self, snare, folder, scenario, seed):
        self.snare, self.folder = snare, folder
        self.duration, self.count, text, self.column, sigma = scenario
        folder.mkdir()
        (folder / "s.toml").write_text(text)
        self.declared = {k: v for k, v in leaves(tomllib.loads(text)) if not k.startswith(("sensors", "output", "duration"))}
        status, said, _ = run(snare, "simulate", "s.toml", cwd=folder)
        if status != 0:
            raise RuntimeError(said)
        rows = list(csv.DictReader((folder / "o/telemetry.csv").open()))
        rows = [r for r in rows if r.get(self.column)]
        noise = random.Random(seed)
        lines = ["time_s,v"]
        for r in rows[::max(1, len(rows) // self.count)]:
            lines.append(f'{r["time_s"]},{float(r[self.column]) + noise.gauss(0.0, sigma):.9g}')
        (folder / "v.csv").write_text("\n".join(lines) + "\n")
        self.readings = len(lines) - 1
        (folder / "x.toml").write_text(f'schema = "snare-record/1"\ntitle = "small"\nscenario = "s.toml"\n[[records]]\nname = "one"\n'
                                       f'file = "v.csv"\ncolumns = {{ v = "{self.column}" }}\nsigma = {sigma}\n')

    def fit(self, keys, factor):
        arguments = ["fit", "x.toml", "--set", f"fit.free={json.dumps(keys)}"]
        for k, key in enumerate(keys):
            value = self.declared[key]
            arguments += ["--set", f"scenario.{key}={value * (factor if k % 2 == 0 else 2.0 - factor)!r}"]
        return run(self.snare, *arguments, cwd=self.folder)


def interval(number):
    """Whether a number has an interval, and its standard error."""
    lower, upper = number.get("lower95", number.get("lower")), number.get("upper95", number.get("upper"))
    return (lower is not None and upper is not None), number.get("stderr")


def known(result, key):
    """Whether a fit determines a number, and its answer."""
    number = result["fit"]["parameters"][key]
    return number["identified"] and not any(w.startswith(f"{key} is not identifiable") for w in result.get("warnings", []))


def judge(answers, readings, mirror=None):
    """What is wrong with the answers of several starts, and how many ended in another minimum. mirror: place about which a push is the same."""
    wrong, results = [], []
    for status, said, result in answers:
        if status == 0 and result:
            results.append(result)
        elif status not in (0, 2, 3):
            wrong.append(f"status {status}: {said[-200:]}")
        elif status == 2 and len(said) < 40:
            wrong.append(f"refused without a reason: {said}")
    if len(results) < 2:
        return wrong, 0
    keys = list(results[0]["fit"]["parameters"])
    dof = readings - len(keys)
    least = min(r["fit"]["chi2_dof"] for r in results)
    same = [r for r in results if (r["fit"]["chi2_dof"] - least) * dof < 1.0]

    def bounds(result):
        return [result["fit"]["parameters"][key].get("on_bound", "none") for key in keys]

    for key in keys:
        for a, b in itertools.combinations(same, 2):
            if bounds(a) != bounds(b):
                continue
            if known(a, key) != known(b, key):
                wrong.append(f"{key} is determined from some starts only")
                break
            first, second = (r["fit"]["parameters"][key] for r in (a, b))
            if not known(a, key) or not interval(first)[1] or not interval(second)[1]:
                continue
            limit = 0.2 * max(interval(first)[1], interval(second)[1]) + 1e-4 * abs(first["value"])
            apart = abs(first["value"] - second["value"])
            if mirror and key.endswith("position_mm"):
                apart = min(apart, abs(first["value"] + second["value"] - 2.0 * mirror))
            if apart > limit and bounds(a).count("none") == len(keys):
                wrong.append(f"{key}: {first['value']:.6g} and {second['value']:.6g}, standard error {interval(first)[1]:.3g}")
                break
    return wrong, len(results) - len(same)


def free_keys():
    """Numbers that a push can fit, in the order in which messages list them."""
    text = (pathlib.Path(__file__).resolve().parents[2] / "identification/effects/catalogue.cpp").read_text()
    block = text[text.index("order_in_messages"):]
    return [line.split('"')[1] for line in block[:block.index("};")].splitlines() if '"' in line]


def push_cases(snare, folder, wanted, seed):
    tests = [Push(snare, folder / f"push{k}", test, seed + k) for k, test in enumerate(TESTS)]
    pairs = list(itertools.combinations(free_keys(), 2))
    if wanted:
        pairs = pairs[::max(1, len(pairs) // wanted)][:wanted]
    for pair in pairs:
        yield "push", list(pair), tests


def record_cases(snare, folder, pairs, triples, seed):
    records = [Record(snare, folder / f"record{k}", s, seed + 100 + k) for k, s in enumerate(SCENARIOS)]
    draw = random.Random(seed)
    for k in range(pairs + triples):
        record = records[draw.randrange(len(records))]
        # Numbers that are zero have no size to start from.
        keys = [key for key, value in record.declared.items() if value != 0.0]
        yield "record", sorted(draw.sample(keys, 2 if k < pairs else 3)), [record]


def ringdown(snare, folder, seed):
    """A record of one or two known modes, asked for as many or for one more: what it has with an interval is near the truth."""
    draw = random.Random(seed)
    modes = draw.choice([1, 2])
    first = draw.uniform(8.0, 20.0)
    truth = [(first, draw.uniform(0.3, 2.0), 1.0), (first * draw.uniform(1.02, 3.0), draw.uniform(0.3, 4.0), draw.uniform(0.1, 0.8))]
    duration, sigma = draw.uniform(0.3, 2.0), draw.choice([1e-3, 1e-2, 5e-2])
    lines = ["time_s,displacement_mm"]
    for i in range(400):
        t = duration * i / 399
        x = sum(a * math.exp(-s * t) * math.cos(2.0 * math.pi * f * t) for f, s, a in truth[:modes]) + draw.gauss(0.0, sigma)
        lines.append(f"{t:.9g},{x:.9g}")
    (folder / "r.csv").write_text("\n".join(lines) + "\n")
    asked = modes + draw.choice([0, 1])
    (folder / "r.toml").write_text(f'schema = "snare-ringdown/1"\ntitle = "made"\n[[series]]\nname = "one"\nfile = "r.csv"\nmodes = {asked}\n'
                                   "friction = false\n")
    status, said, result = run(snare, "ringdown", "r.toml", cwd=folder)
    case = {"kind": "ringdown", "seed": seed, "modes": modes, "asked": asked, "duration_s": duration, "sigma_mm": sigma}
    if status not in (0, 3) or result is None:
        return case, [f"status {status}: {said[-200:]}"]
    wrong = []
    damping = result["damping"]
    if not damping["separated"]:
        for key in ("bending_time_s", "mass_rate_1_s"):
            if damping[key]["stderr"] is not None:
                wrong.append(f"{key} has a standard error though it is not separated")
    if asked != modes:
        return case, wrong
    for mode in result["series"][0]["modes"]:
        f = mode["frequency_Hz"]
        if not mode["significant"] or f["stderr"] is None:
            continue
        # Five standard errors: one in two million by noise alone.
        if min(abs(f["value"] - true) for true, _, _ in truth[:modes]) > 5.0 * f["stderr"] + 1e-6:
            wrong.append(f"{f['value']:.6g} -+ {f['stderr']:.2g} Hz is none of {[round(t[0], 4) for t in truth[:modes]]}")
    return case, wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("snare")
    parser.add_argument("--pushes", type=int, default=0)
    parser.add_argument("--pairs", type=int, default=300)
    parser.add_argument("--triples", type=int, default=200)
    parser.add_argument("--ringdowns", type=int, default=40)
    parser.add_argument("--part", type=int, nargs=2, default=(0, 1))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--results", type=pathlib.Path)
    options = parser.parse_args()
    snare = str(pathlib.Path(options.snare).resolve())
    cases, failures = [], 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        drawn = itertools.chain([] if options.pushes < 0 else push_cases(snare, folder, options.pushes, options.seed),
                                record_cases(snare, folder, options.pairs, options.triples, options.seed))
        for number, (kind, keys, places) in enumerate(drawn):
            if number % options.part[1] != options.part[0]:
                continue
            case = {"kind": kind, "keys": keys, "answer": "refused"}
            for place in places:
                answers = [place.fit(keys, FACTORS[0])]
                if answers[0][0] == 2:
                    case["reason"] = answers[0][1].strip()[-160:]
                    continue
                answers += [place.fit(keys, f) for f in FACTORS[1:]]
                wrong, elsewhere = judge(answers, place.readings, 87.5)
                best = next((a[2]["fit"] for a in answers if a[0] == 0 and a[2]), None)
                case.pop("reason", None)
                case.update(answer="fitted" if best else "stopped", where=place.folder.name, other_minima=elsewhere, wrong=wrong,
                            open=[d["what"] for d in best["indistinguishable"]] if best else [])
                break
            cases.append(case)
            if case.get("wrong"):
                failures += 1
                print(f"{kind} {keys}: {'; '.join(case['wrong'])}", flush=True)
        for k in range(options.ringdowns):
            case, wrong = ringdown(snare, folder, options.seed * 1000 + k)
            cases.append(case | {"wrong": wrong})
            if wrong:
                failures += 1
                print(f"ringdown {case}: {'; '.join(wrong)}", flush=True)
    sums = {"cases": len(cases), "failures": failures,
            "refused": sum(c.get("answer") == "refused" for c in cases), "stopped": sum(c.get("answer") == "stopped" for c in cases),
            "with_null_directions": sum(bool(c.get("open")) for c in cases),
            "with_other_minima": sum(bool(c.get("other_minima")) for c in cases)}
    print(json.dumps(sums))
    if options.results:
        version = subprocess.run([snare, "--version"], capture_output=True, text=True).stdout.strip()
        head = {"version": version, "seed": options.seed, "starts": FACTORS, **sums}
        options.results.write_text(json.dumps(head)[:-1] + ', "list": [\n' + ",\n".join(json.dumps(c) for c in cases) + "\n]}\n")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
