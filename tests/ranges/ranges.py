#!/usr/bin/env python3
"""Every number of every file at the ends of its range and beyond, alone and in pairs.

    ranges.py SNARE [--cases N] [--tenth K] [--jobs J] [--results FILE] [--seconds S] [--seed N] [--list]

The keys come from the readers themselves: a key that does not exist is answered with those that do, a word in place of a number
with what is allowed. Each key gets its ends, the numbers just beyond them, zero, the smallest and the largest doubles, not a number
and infinities; then pairs of keys get ends within their ranges. Every case must end by itself within 60 s with status 0, 2 or 3, say
why where it is not 0, write no number that is none, and leave no half file and no lock. Where a key asks for work (a million
points, a tolerance of 1e-100) it may take longer: after 15 s it is told to end and must do so, with status 3: "long".
`--tenth 3` runs every tenth case from the
third on. Prints what fails and a count; appends the count as a line of JSON to FILE; exits 1 where a case fails.
"""

import argparse
import collections
import concurrent.futures
import json
import math
import pathlib
import random
import re
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
LIMIT = 60.0  # [s]
WORK_LIMIT = 15.0  # [s]
ANSWER = 15.0  # [s]; a second, or to the end of results that are being written, and what a loaded machine adds
WORK = re.compile(r"points|elements|knots|interval|duration|tolerance|max_step|max_order|modes|speeds|travels|window")
NUMBER = re.compile(r"(?<![A-Za-z_])[-+]?(nan|inf(inity)?)(?![A-Za-z_])", re.I)

# What is run, made small: the file, the verb, what else is set.
WIRE = ["distil.elements=16", "distil.travel_knots=5", "distil.position_knots=3"]
BASES = {
    "push": ("push", "data/experiments/published_static.toml",
             ["solver.elements=16", "series[s40].points=5", "series[s65].points=4", "series[s90].points=4"]),
    "push_supports": ("push", "tests/ranges/supports.toml", []),
    "push_all": ("push", "tests/ranges/everything.toml", []),
    "fit": ("fit", "tests/ranges/readings.toml", []),
    "distil": ("distil", "tests/ranges/wire.toml", []),
    "ringdown": ("ringdown", "data/experiments/ringdown.toml", []),
    "contact": ("simulate", "data/scenarios/air_table.toml", ["duration_s=0.01", "solver.elements=8"]),
    "bodies": ("simulate", "data/scenarios/grapple_shaft.toml",
               ["duration_s=0.005", "wires[lower].elements=8", "wires[right].elements=8", "wires[left].elements=8"]),
    "joint_step": ("simulate", "data/scenarios/jemrms_step.toml", ["duration_s=1.0"]),
    "joint_motion": ("simulate", "data/scenarios/ssrms_push.toml", ["duration_s=1.0"]),
    "arm_contact": ("simulate", "data/scenarios/jemrms_payload_on_wire.toml", ["duration_s=0.01", "solver.elements=8"]),
    "arm": ("arm show", "data/arms/jemrms_like.toml", []),
}
WEIGHT = {"push": 5, "push_supports": 5, "push_all": 4, "fit": 1, "distil": 1, "arm": 3}  # of pairs; others 1
NOWHERE = "zzzzzzzzzzzzzzzzzzzzzzzzzzzzz"

# What is known to take longer than it should: a wire a billion times as stiff as any, whose motion is resolved.
KNOWN = re.compile(r"^(bodies .*wires\[\w+\]|contact .*\bwire)\.bending_stiffness_Nm2=1000000000\.0.*: more than 60 s$")

Key = collections.namedtuple("Key", "base address kind low high open count")


def command(snare, base, sets, out):
    verb, file, more = BASES[base]
    line = [snare, *verb.split(), str(ROOT / file)]
    if not verb.startswith("arm"):
        line += ["--out", str(out), "--quiet", "--threads", "1"]
    for setting in [*more, *sets]:
        line += ["--set", setting]
    return line


def answer(snare, base, setting):
    """What the reader says of one setting; empty where it takes it."""
    with tempfile.TemporaryDirectory() as out:
        try:
            run = subprocess.run(command(snare, base, [setting], out), capture_output=True, text=True, timeout=LIMIT)
        except subprocess.TimeoutExpired:
            return ""
    return run.stderr if run.returncode == 2 else ""


def requirement(message, address):
    for line in message.splitlines():
        found = re.match(r"--set: (.*?) = .*?, (.*)$", line)
        if found and found.group(1) == address:
            return found.group(2)
    return ""


def elements(snare, base, address):
    """Labels of the elements of an array of tables, as --set names them."""
    message = answer(snare, base, f"{address}[{NOWHERE}].x=1")
    found = re.search(r"no such .*; there are: (.*)$", message, re.M)
    return [e for e in found.group(1).split(", ") if e != "..."] if found else []


def find_keys(snare, base, table="", depth=0):
    prefix = table + "." if table else ""
    message = answer(snare, base, f"{prefix}{NOWHERE}=1")
    found = re.search(re.escape(prefix + NOWHERE) + r" = 1, unknown key; known here: (.*)$", message, re.M)
    keys = []
    for name in found.group(1).split(", ") if found and depth < 4 else []:
        address = prefix + name
        wanted = requirement(answer(snare, base, f"{address}=x"), address)
        number = re.match(r"must be (a number|an integer)(.*)$", wanted)
        vector = re.match(r"must be an array of (\d+)( to \d+)? numbers", wanted)
        if number:
            low = re.search(r"(>=?) (\S+)", number.group(2))
            high = re.search(r"<= (\S+)", number.group(2))
            keys.append(Key(base, address, "integer" if "integer" in number.group(1) else "number",
                            float(low.group(2)) if low else None, float(high.group(1)) if high else None,
                            bool(low and low.group(1) == ">"), 1))
        elif vector:
            keys.append(Key(base, address, "vector", None, None, False, int(vector.group(1))))
        elif "must be a table" in wanted:
            keys += find_keys(snare, base, address, depth + 1)
        elif "must be tables" in wanted:
            for label in elements(snare, base, address):
                keys += find_keys(snare, base, f"{address}[{label}]", depth + 1)
    return keys


def beyond(value, up):
    return math.nextafter(value, math.inf if up else -math.inf)


def text(key, value):
    if isinstance(value, str):
        shown = value
    elif key.kind == "integer" and value == int(value):
        shown = str(int(value))
    else:
        shown = repr(float(value)).replace("+", "")
        if shown == "inf" or shown == "-inf" or shown == "nan":
            return f"{key.address}={shown}"
    return f"{key.address}=[{', '.join([shown] * key.count)}]" if key.kind == "vector" else f"{key.address}={shown}"


def ends(key):
    """Numbers of the range: its ends, and what is extreme within it."""
    low = key.low if key.low is not None else -1.7976931348623157e308
    high = key.high if key.high is not None else 1.7976931348623157e308
    if key.kind == "integer":
        return sorted({int(low), min(int(low) + 1, int(high)), int(high)})
    values = [beyond(low, True) if key.open else low, high]
    values += [v for v in (1e-300, 1e-9, 1.0, 1e9) if low < v < high]
    if low < 0.0 < high:
        values += [0.0, -1e-9, -1.0]
    return values


def singles(key):
    values = ends(key) + [0, -1, 5e-324, 1e-320, 1.7976931348623157e308, "nan", "inf", "-inf", "1e999"]
    if key.low is not None:
        values += [key.low - 1 if key.kind == "integer" else beyond(key.low, False)]
    if key.high is not None:
        values += [key.high + 1 if key.kind == "integer" else beyond(key.high, True)]
    return [(key.base, [text(key, v)]) for v in values]


def pairs(keys, count, seed):
    """Two keys at a time, each pair of keys before any comes again."""
    rng = random.Random(seed)
    by_base = collections.defaultdict(list)
    for key in keys:
        by_base[key.base].append(key)
    decks, result = {}, []
    bases = [b for b in by_base if len(by_base[b]) > 1]
    while len(result) < count and bases:
        base = rng.choices(bases, [WEIGHT.get(b, 1) for b in bases])[0]
        if not decks.get(base):
            k = by_base[base]
            decks[base] = [(a, b) for i, a in enumerate(k) for b in k[i + 1:]]
            rng.shuffle(decks[base])
        a, b = decks[base].pop()
        result.append((base, [text(a, rng.choice(ends(a))), text(b, rng.choice(ends(b)))]))
    return result


def run(snare, case):
    base, sets = case
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out"
        begin = time.monotonic()
        work = any(WORK.search(s.split("=")[0]) for s in sets)
        done = subprocess.Popen(command(snare, base, sets, out), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        long = False
        try:
            said = done.communicate(timeout=WORK_LIMIT if work else LIMIT)[1]
        except subprocess.TimeoutExpired:
            done.terminate()
            long = True
            try:
                said = done.communicate(timeout=ANSWER)[1]
            except subprocess.TimeoutExpired:
                done.kill()
                done.communicate()
                return case, "time", "deaf", LIMIT
        seconds = time.monotonic() - begin
        said = said.decode(errors="replace").strip()
        if long and not work:
            return case, "time", f"more than {LIMIT:g} s", seconds
        if long and done.returncode not in (0, 3):  # 0: all was computed, and is written now
            return case, done.returncode, f"status {done.returncode} when told to end", seconds
        if done.returncode not in (0, 2, 3):
            return case, done.returncode, f"status {done.returncode}: {said[-300:]}", seconds
        if done.returncode != 0 and not said:
            return case, done.returncode, f"status {done.returncode} without a word", seconds
        if done.returncode == 2 and out.exists():
            return case, done.returncode, "status 2 and something is written", seconds
        if out.exists():
            for file in out.rglob("*"):
                if file.name.endswith(".tmp") or file.name == ".snare.lock":
                    return case, done.returncode, f"{file.name} is left", seconds
                if file.suffix in (".csv", ".json") and NUMBER.search(file.read_text(errors="replace")):
                    return case, done.returncode, f"{file.name} has a number that is none", seconds
        return case, "long" if long else done.returncode, "", seconds


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("snare")
    parser.add_argument("--cases", type=int, default=20000)
    parser.add_argument("--tenth", type=int)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--results")
    parser.add_argument("--seconds", type=float, default=math.inf)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only")
    parser.add_argument("--list", action="store_true")
    options = parser.parse_args()
    snare = str(pathlib.Path(options.snare).resolve())
    bases = [b for b in BASES if options.only in (None, b)]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        keys = [k for found in pool.map(lambda b: find_keys(snare, b), bases) for k in found]
    if options.list:
        for key in keys:
            print(*key)
        return 0
    cases = [case for key in keys for case in singles(key)]
    cases += pairs(keys, max(0, options.cases - len(cases)), options.seed)
    random.Random(0).shuffle(cases)
    cases = cases[:options.cases]
    if options.tenth is not None:
        cases = cases[options.tenth::10]
    begin = time.monotonic()
    statuses, slowest, failures, ran = collections.Counter(), (0.0, ""), [], 0
    spent = collections.Counter()

    def one(case):
        return run(snare, case) if time.monotonic() - begin < options.seconds else None

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for result in pool.map(one, cases):
            if result is None:
                continue
            case, status, wrong, seconds = result
            ran += 1
            statuses[str(status)] += 1
            spent[case[0]] += seconds
            slowest = max(slowest, (seconds, " ".join([case[0], *case[1]])))
            if wrong and KNOWN.match(f"{case[0]} {' '.join(case[1])}: {wrong}"):
                statuses["known"] += 1
            elif wrong:
                failures.append({"case": " ".join([case[0], *case[1]]), "wrong": wrong})
                print(f"{failures[-1]['case']}: {wrong}", flush=True)
    summary = {"keys": len(keys), "bases": len(bases), "cases": ran, "asked": len(cases), "statuses": dict(sorted(statuses.items())),
               "failures": failures, "slowest_s": round(slowest[0], 1), "slowest": slowest[1],
               "seconds": {b: round(s) for b, s in spent.items()}, "wall_s": round(time.monotonic() - begin)}
    print(json.dumps({k: v for k, v in summary.items() if k != "failures"}), f"{len(failures)} failed")
    if options.results:
        with open(options.results, "a", encoding="utf-8") as file:
            file.write(json.dumps(summary) + "\n")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
