#!/usr/bin/env python3
"""How often the tracing of records in time names the right class: blind_records.py SNARE [--kinds a,b] [--effects TEXT] [--seeds N] [--first SEED]
[--sizes 5,10,30] [--nothing N] [--sets FILE] [--out FILE] [--fresh SEED] [--require] [--keep FOLDER].

Machines of plants.py, which share no code with the solver, give two records each, one of which is held out; the declared model lacks one effect, or
none, or something that is in no catalogue, and its fitted numbers are up to a tenth off. Prints a line a set and the figures with their bounds of
95 % (Clopper and Pearson). --sets keeps every set's answer, a line of JSON each; a run that finds the file goes on where it ended.
--fresh gives the figures of the sets from that seed on besides, as those of one state of the tracing. --require ends with 1 where a figure is worse
than asked.
"""

import argparse
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import time

from kinds import KINDS, RECORDS
from sets import Batch

OUTSIDE_SIZES = (30, 100)


def trace(snare, folder):
    """trace.json of a set, or what went wrong."""
    begin = time.time()
    done = subprocess.run([snare, "trace", str(folder / "record.toml"), "--quiet", "--threads", "1", "--out", str(folder / "out")],
                          capture_output=True, text=True, timeout=600)
    if done.returncode != 0:
        return {"fault": f"status {done.returncode}: " + " ".join(done.stderr.split())[-300:]}, time.time() - begin
    return json.loads((folder / "out" / "trace.json").read_text()), time.time() - begin


def class_of(found):
    """Members of the class of the first effect that was named."""
    named = found["selected_places"][0]
    for members in found["rounds"][0]["classes"]:
        if named in members:
            return members
    return [named]


def judge(batch, c, found):
    effect = batch.cases[c][0]
    label = effect.label if effect else "none"
    outside = effect in batch.kind.outside
    selected = found["selected_places"]
    answer = "+".join(selected) if selected else ("nothing" if found["explained"] else f"unexplained:{found['channel']}")
    result = {"answer": answer, "verdict": found["verdict_kind"], "chi2_dof": found["final"]["chi2_dof"], "class": class_of(found) if selected else []}
    if effect is None:
        result["right"] = not selected and found["explained"]
    elif outside:
        result["right"] = not selected and not found["explained"]
        result["channel"] = result["right"] and found["channel"] == label
    else:
        result["right"] = len(selected) == 1 and label in result["class"] and found["explained"]
        result["first"] = bool(selected) and label in result["class"]
    if effect is None or (not outside and selected == [label]):
        inside = []
        for key, number in batch.kind.free.items():
            told = found["final"]["parameters"][key]
            inside.append(told["lower"] is not None and told["lower"] <= batch.truth[number][c] <= told["upper"])
        result["covered"], result["intervals"] = int(sum(inside)), len(inside)
    if selected == [label]:
        told = [n for key, n in found["final"]["parameters"].items() if key not in batch.kind.free]
        truth = true_amount(batch, c)
        if len(told) == 1:
            result["effect_covered"] = bool(told[0]["lower"] is not None and told[0]["lower"] <= truth <= told[0]["upper"])
    return result


def true_amount(batch, c):
    """The effect's number in the unit of its key."""
    effect = batch.cases[c][0]
    if ":" in effect.number:
        return batch.amount[c] + (1.0 if effect.number.endswith("gain") else 0.0)
    null = batch.declared[effect.number][c]
    value = null * (1.0 + batch.amount[c]) if effect.share else null + batch.amount[c]
    return value / null if effect.label.startswith("body_inertia") else value


def bounds(hits, count):
    """Clopper and Pearson's interval of 95 %, by bisection of the binomial's tails."""
    ways = [math.lgamma(count + 1) - math.lgamma(i + 1) - math.lgamma(count - i + 1) for i in range(count + 1)]  # logarithms

    def tail(p, k):  # P(X >= k)
        return sum(math.exp(ways[i] + i * math.log(p) + (count - i) * math.log1p(-p)) for i in range(k, count + 1))

    def solve(k, goal):
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if tail(middle, k) < goal else (low, middle)
        return 0.5 * (low + high)

    return [0.0 if hits == 0 else solve(hits, 0.025), 1.0 if hits == count else solve(hits + 1, 0.975)]


def share(lines, key):
    told = [line for line in lines if key in line]
    if not told:
        return None
    hits = sum(bool(line[key]) for line in told)
    return {"share": hits / len(told), "of": len(told), "bounds_95": [round(b, 4) for b in bounds(hits, len(told))]}


def summary(lines):
    result = {"matrix": {}}
    for line in lines:
        cell = result["matrix"].setdefault(line["kind"], {}).setdefault(line["effect"], {}).setdefault(str(line["size"]), {"right": 0, "sets": 0, "answers": {}})
        cell["sets"] += 1
        cell["right"] += bool(line.get("right"))
        cell["answers"][line["answer"]] = cell["answers"].get(line["answer"], 0) + 1
    inside = [line for line in lines if line["effect"] != "none" and not line["outside"]]
    for size in sorted({line["size"] for line in inside}):
        result[f"right_class_{size}_sigma"] = share([line for line in inside if line["size"] == size], "right")
        result[f"named_first_{size}_sigma"] = share([line for line in inside if line["size"] == size], "first")
    alarms = [{"alarm": not line.get("right")} for line in lines if line["effect"] == "none"]
    result["false_alarms"] = share(alarms, "alarm")
    for size in sorted({line["size"] for line in lines if line["outside"]}):
        some = [line for line in lines if line["outside"] and line["size"] == size]
        result[f"outside_nothing_named_{size}_sigma"] = share([{"right": not line.get("class")} for line in some], "right")
        result[f"outside_not_explained_{size}_sigma"] = share(some, "right")
        result[f"outside_right_channel_{size}_sigma"] = share(some, "channel")
    numbers = [{"covered": k < line["covered"]} for line in lines if "intervals" in line for k in range(line["intervals"])]
    result["intervals_of_fitted_numbers"] = share(numbers, "covered")
    result["intervals_of_effects"] = share(lines, "effect_covered")
    seconds = sorted(line["seconds"] for line in lines)
    result["seconds_a_trace"] = {"median": seconds[len(seconds) // 2], "longest": seconds[-1]} if seconds else None
    return result


def good(result):
    """The figures asked, as far as these sets speak of them."""
    asked = [("right_class_10_sigma", 0.90, True), ("right_class_30_sigma", 0.97, True), ("false_alarms", 0.05, False),
             ("outside_nothing_named_30_sigma", 0.90, True), ("outside_right_channel_100_sigma", 0.75, True),
             ("intervals_of_fitted_numbers", 0.90, True)]
    fine = True
    for name, limit, least in asked:
        told = result.get(name)
        if told and (told["share"] < limit if least else told["share"] > limit):
            print(f"{name}: {told['share']:.3f}, asked {limit}")
            fine = False
    return fine


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("snare", type=lambda path: str(pathlib.Path(path).resolve()))
    parser.add_argument("--kinds", default=",".join(KINDS))
    parser.add_argument("--effects", default="")
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--sizes", default="5,10,30")
    parser.add_argument("--nothing", type=int, default=None, help="sets of a kind without an effect (3 times the seeds)")
    parser.add_argument("--sets", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("--fresh", type=int)
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("--require", action="store_true")
    options = parser.parse_args()
    os.environ["OMP_NUM_THREADS"] = "1"
    lines = []
    if options.sets and options.sets.exists():
        lines = [json.loads(line) for line in options.sets.read_text().splitlines()]
    known = {(line["kind"], line["effect"], line["size"], line["seed"]) for line in lines}
    nothing = 3 * options.seeds if options.nothing is None else options.nothing
    for name in options.kinds.split(","):
        kind = KINDS[name]
        seeds = range(options.first, options.first + options.seeds)
        cases = [(None, 0, seed) for seed in range(options.first, options.first + nothing)]
        cases += [(effect, int(size), seed) for seed in seeds for effect in kind.effects for size in options.sizes.split(",") if size]
        cases += [(effect, size, seed) for seed in seeds for effect in kind.outside for size in OUTSIDE_SIZES]
        cases = [case for case in cases if (name, case[0].label if case[0] else "none", case[1], case[2]) not in known]
        if options.effects:
            cases = [case for case in cases if options.effects in (case[0].label if case[0] else "none")]
        if not cases:
            continue
        batch = Batch(name, cases)
        readings = {record: batch.readings(batch.amount, record) for record in RECORDS}
        for c, (effect, size, seed) in enumerate(cases):
            with tempfile.TemporaryDirectory() as temporary:
                folder = pathlib.Path(temporary)
                if options.keep:
                    label = (effect.label if effect else "none").replace(" ", "_").replace(":", "_").replace("(", "").replace(")", "")
                    folder = options.keep / f"{name}_{label}_{size}_{seed}"
                    folder.mkdir(parents=True, exist_ok=True)
                batch.write(c, folder, readings)
                found, seconds = trace(options.snare, folder)
            line = {"kind": name, "effect": effect.label if effect else "none", "outside": effect in kind.outside, "size": size, "seed": seed,
                    "amount": float(f"{batch.amount[c]:.6g}"), "seconds": round(seconds, 2)}
            if "fault" in found:
                line.update({"answer": "fault", "right": False, "fault": found["fault"]})
            else:
                line.update(judge(batch, c, found))
            lines.append(line)
            print(f"{'ok   ' if line['right'] else 'WRONG'} {name:8} {line['effect']:52} {size:4} {seed:3} {line['answer']}  {line.get('verdict')} "
                  f"{line.get('chi2_dof', 0):.3f} {seconds:.1f}s", flush=True)
            if options.sets:
                with options.sets.open("a") as out:
                    out.write(json.dumps(line) + "\n")
    result = summary(lines)
    if options.fresh is not None:
        some = [line for line in lines if line["seed"] >= options.fresh]
        result[f"seeds_from_{options.fresh}"] = summary(some) if some else None
    if options.out:
        options.out.write_text(json.dumps(result, indent=1) + "\n")
    told = result if options.fresh is None else result[f"seeds_from_{options.fresh}"] or {}
    print(json.dumps({key: value for key, value in told.items() if key != "matrix"}, indent=1))
    return 1 if options.require and not good(result) else 0


if __name__ == "__main__":
    sys.exit(main())
