#!/usr/bin/env python3
"""Every number of every file at the ends of its range and beyond, alone and together.

    ranges.py SNARE [--cases N] [--part FIRST EVERY] [--jobs J] [--results FILE] [--journal FILE] [--seconds S] [--seed N] [--list]
                    [--from FILE] [--time S]

The keys come from the readers themselves: a key that does not exist is answered with those that do, a word in place of a number
with what is allowed. Each key gets its ends, the numbers just beyond them, zero, the smallest and the largest doubles, not a number
and infinities (of elements of a list the first only). Then a covering array of strength two: every two ends of every two keys of a
file stand together in at least one case, ROW keys a case, the others as in the file. Every case must end by itself within 60 s of the
processor with status 0, 2 or 3, say why where it is not 0, write no number that is none, and leave no half file and no lock. Where a key
asks for work (a million points or outputs, 20,000 elements, of a push also a tolerance of 1e-100, a motion that is never to be given up) it
may take longer: after 15 s it is told to end and must do so, with status 3: "long". Motions have no other exception: one that gets nowhere
gives up by itself.
`--part 3 15` runs every fifteenth case from the third on. With `--journal` every case that has ended stands in FILE, a line each, and is not
run again. `--from` runs the cases of a file, a line of JSON each as a journal has them ([[BASE, [KEY=VALUE, ...]], ...]), and no others:
long.jsonl has those that ever took long. `--time` is the limit in place of 60 s, then of every case, whatever it asks for. Prints what fails and a count; appends the count as a line of JSON to the results; exits 1 where a case fails.
"""

import argparse
import collections
import concurrent.futures
import json
import math
import os
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
ROW = 6
WORK = re.compile(r"points|elements|knots|interval|duration|tolerance|max_step|max_order|modes|speeds|travels|window|cases|pulses|every_s|"
                  r"rate_Hz|least_advance")
STIFF = re.compile(r"bending_stiffness|extra_stiffness")  # of a wire in motion: its waves are followed
ASKED = re.compile(r"elements|points|interval|duration|pulses|every_s|rate_Hz|least_advance")  # work that a motion cannot give up, or must not: 0
NUMBER = re.compile(r"(?<![A-Za-z_])[-+]?(nan|inf(inity)?)(?![A-Za-z_])", re.I)

# What is run, made small: the file, the verb, what else is set.
BASES = {
    "push": ("push", "data/experiments/published_static.toml",
             ["solver.elements=16", "series[s40].points=5", "series[s65].points=4", "series[s90].points=4"]),
    "push_supports": ("push", "tests/ranges/supports.toml", []),
    "push_all": ("push", "tests/ranges/everything.toml", []),
    "fit": ("fit", "tests/ranges/readings.toml", []),
    "distil": ("distil", "tests/ranges/wire.toml", []),
    "ringdown": ("ringdown", "data/experiments/ringdown.toml", []),
    "contact": ("simulate", "data/scenarios/air_table.toml", ["duration_s=0.01", "wires[wire].elements=8"]),
    "bodies": ("simulate", "data/scenarios/grapple_shaft.toml",
               ["duration_s=0.005", "wires[lower].elements=8", "wires[right].elements=8", "wires[left].elements=8"]),
    "joint_step": ("simulate", "data/scenarios/jemrms_step.toml", ["duration_s=1.0"]),
    "arm_push": ("simulate", "data/scenarios/ssrms_push.toml", ["duration_s=1.0"]),
    "arm_on_wire": ("simulate", "data/scenarios/jemrms_payload_on_wire.toml", ["duration_s=0.01", "wires[wire].elements=8"]),
    "composed": ("simulate", "tests/ranges/composed.toml", ["duration_s=0.005"]),
    "snare": ("simulate", "data/scenarios/snare_on_pin.toml", ["duration_s=0.02", "snares[snare].wire.elements=12", "phases[close].at_s=0"]),
    "record": ("fit", "tests/ranges/record.toml", []),
    "sweep": ("sweep", "tests/ranges/sweep.toml", []),
    "arm": ("arm show", "data/arms/jemrms_like.toml", []),
}
NOWHERE = "zzzzzzzzzzzzzzzzzzzzzzzzzzzzz"

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


def shape(key):
    """Key without the names of elements."""
    return key.base, re.sub(r"\[[^\]]*\]|joint_\d|J\d", "", key.address)


def first_of_each(keys):
    seen = set()
    return [k for k in keys if not (shape(k) in seen or seen.add(shape(k)))]


def is_work(base, setting):
    key = setting.split("=")[0]
    return bool(WORK.search(key)) or (BASES[base][0] in ("simulate", "distil") and bool(STIFF.search(key)))


def may_be_long(base, setting):
    """Whether what was asked for may take more than LIMIT."""
    return bool(ASKED.search(setting.split("=")[0])) if BASES[base][0] == "simulate" else is_work(base, setting)


def levels(key):
    """The two ends; where there is none a thousand; of what asks for work the one that asks for least."""
    low = -1000.0 if key.low is None else beyond(key.low, True) if key.open else key.low
    high = 1000.0 if key.high is None else key.high
    if is_work(key.base, key.address):
        return [low if STIFF.search(key.address) or key.kind == "integer" else high]
    return [int(low), int(high)] if key.kind == "integer" else [low, high]


def covering_array(keys, rng):
    """Cases of ROW keys of one file, greedily, until every pair of levels of every two keys has been together."""
    items = [(k, v) for k in range(len(keys)) for v in levels(keys[k])]
    n = len(items)
    left = [{j for j in range(n) if items[j][0] != items[i][0]} for i in range(n)]  # partners still to meet
    rows = []
    while True:
        first = max(range(n), key=lambda i: (len(left[i]), rng.random()), default=None)
        if first is None or not left[first]:
            break
        row = [first]
        gain = collections.Counter(left[first])
        while len(row) < min(ROW, len(keys)):
            used = {items[i][0] for i in row}
            free = [(g, len(left[i]), i) for i, g in gain.items() if items[i][0] not in used]
            if not free:
                break
            new = max(free)[2]
            row.append(new)
            gain.update(left[new])
        for a in row:
            for b in row:
                left[a].discard(b)
        rows.append(row)
    together = {frozenset((a, b)) for row in rows for a in row for b in row if a != b}
    wanted = sum(items[a][0] != items[b][0] for a in range(n) for b in range(a))
    assert len(together) == wanted, "the array does not cover every pair"
    return [(keys[0].base, [text(keys[items[i][0]], items[i][1]) for i in row]) for row in rows], wanted


def together(keys, seed):
    """The arrays of all files, and how many pairs they cover."""
    rng = random.Random(seed)
    cases, pairs = [], 0
    for base in BASES:
        own = [k for k in keys if k.base == base]
        rows, covered = covering_array(own, rng) if len(own) > 1 else ([], 0)
        cases += rows
        pairs += covered
    return cases, pairs


def said_within(process, seconds):
    """What it says until it ends. The seconds are its own: where others have the machine it may take longer, not for ever."""
    waited = 0.0
    while True:
        part = max(1.0, 0.5 * seconds)
        try:
            return process.communicate(timeout=part)[1]
        except subprocess.TimeoutExpired:
            waited += part
            try:
                fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
                used = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
            except OSError:
                used = waited
            if used >= seconds or waited >= 10.0 * seconds:
                raise


def run(snare, case, limit=None):
    base, sets = case
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out"
        begin = time.monotonic()
        work = limit is None and any(may_be_long(base, s) for s in sets)
        done = subprocess.Popen(command(snare, base, sets, out), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        long = False
        try:
            said = said_within(done, WORK_LIMIT if work else limit or LIMIT)
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
            return case, "time", f"more than {limit or LIMIT:g} s", seconds
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
    parser.add_argument("--cases", type=int, default=1000000)
    parser.add_argument("--part", type=int, nargs=2, metavar=("FIRST", "EVERY"))
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--results")
    parser.add_argument("--journal")
    parser.add_argument("--from", dest="cases_of")
    parser.add_argument("--time", type=float)
    parser.add_argument("--seconds", type=float, default=math.inf)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only")
    parser.add_argument("--list", action="store_true")
    options = parser.parse_args()
    snare = str(pathlib.Path(options.snare).resolve())
    bases = [b for b in BASES if options.only in (None, b)]
    if options.cases_of:
        with open(options.cases_of, encoding="utf-8") as file:
            listed = [json.loads(line)[0] for line in file]
        return run_all(snare, options, [(base, sets) for base, sets in listed if base in bases], {"bases": len(bases)})
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        keys = [k for found in pool.map(lambda b: find_keys(snare, b), bases) for k in found]
    if options.list:
        for key in keys:
            print(*key)
        return 0
    cases = [case for key in first_of_each(keys) for case in singles(key)]
    alone = len(cases)
    rows, pairs = together(keys, options.seed)
    cases += rows
    random.Random(0).shuffle(cases)
    print(f"{len(keys)} keys, {alone} cases of one, {len(rows)} of {ROW} that cover {pairs} pairs", flush=True)
    return run_all(snare, options, cases, {"keys": len(keys), "bases": len(bases), "pairs": pairs})


def run_all(snare, options, cases, head):
    """Runs those of the cases that the options ask for, prints what fails and the count; the status. head: what the count begins with."""
    cases = cases[:options.cases]
    if options.part:
        cases = cases[options.part[0]::options.part[1]]
    begin = time.monotonic()
    statuses, slowest, failures, ran = collections.Counter(), (0.0, ""), [], 0
    spent = collections.Counter()

    before = {}
    journal = open(options.journal, "a+", encoding="utf-8") if options.journal else None
    if journal:
        journal.seek(0)
        for line in journal:
            try:
                entry = json.loads(line)
            except json.JSONDecodeError:  # was being written when all ended
                continue
            before[json.dumps(entry[0])] = entry

    def one(case):
        known = before.get(json.dumps(case))
        if known and not known[2]:  # what failed is run again
            return known
        return run(snare, case, options.time) if time.monotonic() - begin < options.seconds else None

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for ended in concurrent.futures.as_completed([pool.submit(one, case) for case in cases]):
            result = ended.result()
            if result is None:
                continue
            case, status, wrong, seconds = result
            if journal and result[2] == "" and json.dumps(case) not in before:
                print(json.dumps(result), file=journal, flush=True)
            ran += 1
            statuses[str(status)] += 1
            spent[case[0]] += seconds
            slowest = max(slowest, (seconds, " ".join([case[0], *case[1]])))
            if wrong:
                failures.append({"case": " ".join([case[0], *case[1]]), "wrong": wrong})
                print(f"{failures[-1]['case']}: {wrong}", flush=True)
    summary = {**head, "cases": ran, "asked": len(cases), "statuses": dict(sorted(statuses.items())),
               "failures": failures, "slowest_s": round(slowest[0], 1), "slowest": slowest[1],
               "seconds": {b: round(s) for b, s in spent.items()}, "wall_s": round(time.monotonic() - begin)}
    print(json.dumps({k: v for k, v in summary.items() if k != "failures"}), f"{len(failures)} failed")
    if journal:
        journal.close()
    if options.results:
        with open(options.results, "a", encoding="utf-8") as file:
            file.write(json.dumps(summary) + "\n")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
