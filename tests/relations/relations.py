#!/usr/bin/env python3
"""Relations that must hold between runs, on files drawn at random; what does not hold is shrunk to its smallest form.

    relations.py SNARE [--files N] [--seed S] [--first K] [--subject NAME ...] [--relation NAME ...] [--most M] [--jobs J] [--journal FILE]
                       [--results FILE] [--seconds S] [--keep DIR]

A subject has a generator (generate_SUBJECT.py: a file from a seed, the same everywhere) and relations (relations_SUBJECT.py: a function each, that
runs the file and a changed one and holds their numbers against each other). Where only order or names change the numbers are the same bytes; elsewhere
they differ by no more than the runs say of their own errors: the stated error of a push, of a motion what a tenth of its tolerances changes. Every file
meets the balances of its subject, which any wrong force disturbs, and M of its other relations, drawn with it (0: all). A relation may be undecided: it does not apply to this file, or a run has no result.
A line of FILE of `--journal` for every file that is done, which is not run again. `--results` gets the counts, as JSON. Of a broken relation the smallest file
that still breaks it goes to DIR (else a folder of its own beside the temporary files) with the two commands that show it. What is known, with its reason, stands in KNOWN below: it is counted and
printed, and is no failure. Exits 1 where another relation is broken.
"""

import argparse
import collections
import concurrent.futures
import importlib
import json
import math
import pathlib
import random
import shutil
import sys
import tempfile
import time

from cases import Broken, Runner, Undecided
from shrink import shrink

# Subject: its share of the files.
SUBJECTS = {"push": 5, "motion": 5, "bodies": 3, "arms": 2, "snares": 1, "fit": 2, "records": 1, "sweeps": 1}


def lifted_off_supports(case):
    m = case.main
    towards = 1.0 if m["pusher"]["direction"] == "outward" else -1.0
    return m["mount"]["kind"] == "supports" and "gravity" in m and towards * m["gravity"]["vector_m_s2"][1] < 0.0


def with_a_zero(case):
    return "reading.displacement_offset_mm" in case.main["fit"]["free"]


def curved_across_weight(case):
    m = case.main
    return "gravity" in m and "natural_curvature_1_m" in m["wire"]


def straight_without_weight(case):
    m = case.main
    place = {b["name"]: b["position_mm"] for b in m.get("bodies", [])}

    def span(w):
        return math.dist(w["from_mm"], [x + y for x, y in zip(w["to_mm"], place.get(w.get("to_frame"), [0.0, 0.0, 0.0]))])

    return "gravity" not in m and any(w["model"] == "quasi_static" and w["length_mm"] < span(w) for w in m.get("wires", []))


def tilted(case):
    return "tilt_deg" in case.main["pusher"]


# Subject, relations (none: all of them), of which files, and why it is not mended.
KNOWN = [
    ("push", (), lifted_off_supports, "supports pull a wire that its weight lifts off them, which a warning reports"),
    (
        "push",
        ("weak_natural_curvature_1_m", "weak_vector_m_s2"),
        tilted,
        "a tilted pusher follows a loose wire into a shape that is unstable out of the plane, and says 0 unstable modes",
    ),
    (
        "push",
        ("there_and_back",),
        curved_across_weight,
        "a wire that is curved when free rolls over under a weight across its plane: with few points the path continues in another shape, with many it ends with status 3",
    ),
    (
        "motion",
        ("weak_gravity",),
        straight_without_weight,
        "a straight wire that grows slack bulges to a side that nothing decides",
    ),
    (
        "fit",
        ("start_values",),
        with_a_zero,
        "a fit that ends where a reading is just before the touch has the standard error of one side of that kink",
    ),
]


def relations(subject):
    """The balances that every file meets, and the other relations."""
    module = importlib.import_module("relations_" + ("motion" if subject in ("bodies", "arms", "snares") else subject))
    balances = getattr(module, "BALANCES", [])
    return balances, [r for r in module.RELATIONS if r not in balances]


def verdict(relation, case, run):
    """ "holds", "undecided" or "broken", and what was said."""
    run.asked = []
    try:
        relation(case, run)
    except Undecided as why:
        return "undecided", "", str(why)
    except Broken as why:
        return "broken", why.what, str(why)
    return "holds", "", ""


def known(subject, relation, case):
    return next((why for s, names, holds, why in KNOWN if s == subject and (not names or relation in names) and holds(case)), None)


def one_file(a, subject, number):
    """Verdicts of one file, a dictionary for the journal."""
    seed = f"{subject} {a.seed} {number}"
    case = importlib.import_module(f"generate_{subject}").generate(seed)
    balances, chosen = ([r for r in some if not a.relation or r.__name__ in a.relation] for some in relations(subject))
    random.Random(seed).shuffle(chosen)
    found = {"file": seed, "relations": {}, "broken": []}
    decided = 0
    began = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        for relation in balances + chosen:
            if a.most and decided >= a.most:
                break
            run = Runner(a.snare, folder)
            result, what, said = verdict(relation, case, run)
            found["relations"][relation.__name__] = result
            decided += result != "undecided" and relation in chosen
            if result == "broken":
                found["broken"].append(
                    {"relation": relation.__name__, "what": what, "said": said, "known": known(subject, relation.__name__, case)}
                )
                if not found["broken"][-1]["known"]:
                    found["broken"][-1]["shown"] = keep(a, seed, relation, case, what)
            if result == "undecided" and not decided and said.startswith(("status", "longer")) and len(run.asked) == 1:
                found["relations"] = {relation.__name__: "undecided"}
                found["why"] = said
                break  # the file itself has no result
    found["seconds"] = round(time.monotonic() - began, 2)
    return found


def keep(a, seed, relation, case, what):
    """Leaves the smallest file, and returns what shows it: what was said, and the commands."""
    folder = (a.keep or pathlib.Path(tempfile.gettempdir()) / "snare_relations") / f"{seed.replace(' ', '_')}_{relation.__name__}"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    small = shrink(case, lambda c: broken_alike(a.snare, relation, c, what), a.shrink)
    run = Runner(a.snare, folder)
    said = verdict(relation, small, run)[2]
    for name in run.asked:
        shutil.rmtree(folder / name / "out", ignore_errors=True)
    return [said, *run.commands(case.verb)]


def broken_alike(snare, relation, case, what):
    with tempfile.TemporaryDirectory() as folder:
        try:
            result, other, _ = verdict(relation, case, Runner(snare, folder))
        except (KeyError, IndexError, ValueError, TypeError, ZeroDivisionError):
            return False
    return result == "broken" and other == what


def report(found):
    for b in found["broken"]:
        print(f"{found['file']} {b['relation']}: {b['said']}{'  known: ' + b['known'] if b['known'] else ''}", flush=True)
        for line in b.get("shown", []):
            print(f"    {line}", flush=True)


def counts(journal):
    table = collections.defaultdict(lambda: {"holds": 0, "broken": 0, "known": 0, "undecided": 0})
    for line in journal:
        subject = line["file"].split()[0]
        why = {b["relation"]: b["known"] for b in line["broken"]}
        for name, result in line["relations"].items():
            table[f"{subject}: {name}"]["known" if result == "broken" and why[name] else result] += 1
    return dict(sorted(table.items()))


def without_result(journal):
    """By subject: files that have no result themselves, as where a solver has given up, of all files."""
    table = collections.defaultdict(lambda: [0, 0])
    for line in journal:
        count = table[line["file"].split()[0]]
        count[0] += "why" in line
        count[1] += 1
    return dict(sorted(table.items()))


def files(a):
    """Subjects in turn, by their shares."""
    names = [s for s in SUBJECTS if not a.subject or s in a.subject]
    order = [s for s in names for _ in range(SUBJECTS[s])]
    random.Random(0).shuffle(order)
    numbers = collections.Counter()
    for k in range(a.first + a.files):
        subject = order[k % len(order)]
        if k >= a.first:
            yield subject, numbers[subject]
        numbers[subject] += 1


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("snare", type=lambda p: str(pathlib.Path(p).resolve()))
    parser.add_argument("--files", type=int, default=150)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", default="1")
    parser.add_argument("--subject", nargs="*")
    parser.add_argument("--relation", nargs="*")
    parser.add_argument("--most", type=int, default=4, help="relations a file, 0: all")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=float("inf"), help="no new file after that")
    parser.add_argument("--shrink", type=float, default=60.0, help="seconds for one file")
    parser.add_argument("--journal", type=pathlib.Path)
    parser.add_argument("--results", type=pathlib.Path)
    parser.add_argument("--keep", type=pathlib.Path, help="folder for what breaks a relation")
    a = parser.parse_args()
    journal = [json.loads(line) for line in a.journal.read_text().splitlines()] if a.journal and a.journal.exists() else []
    there = {line["file"] for line in journal}
    began = time.monotonic()

    def work(item):
        return one_file(a, *item) if time.monotonic() - began < a.seconds else None

    todo = [item for item in files(a) if f"{item[0]} {a.seed} {item[1]}" not in there]
    with concurrent.futures.ProcessPoolExecutor(a.jobs) if a.jobs > 1 else concurrent.futures.ThreadPoolExecutor(1) as pool:
        for found in pool.map(work, todo) if a.jobs == 1 else pool.map(one_of, [(a, i, began) for i in todo]):
            if found is None:
                continue
            journal.append(found)
            report(found)
            if a.journal:
                with a.journal.open("a") as file:
                    file.write(json.dumps(found) + "\n")
    finish(a, journal)


def one_of(item):
    a, what, began = item
    return one_file(a, *what) if time.monotonic() - began < a.seconds else None


def finish(a, journal):
    table = counts(journal)
    total = collections.Counter()
    for row in table.values():
        total.update(row)
    new = [dict(b, file=line["file"]) for line in journal for b in line["broken"] if not b["known"]]
    if a.results:
        listed = [
            {"file": line["file"], **{k: v for k, v in b.items() if k != "shown"}} for line in journal for b in line["broken"]
        ]
        result = {
            "files": len(journal),
            "seed": a.seed,
            "seconds": round(sum(line["seconds"] for line in journal)),
            "total": dict(total),
            "without_result": without_result(journal),
            "relations": table,
            "broken": listed,
        }
        a.results.write_text(json.dumps(result, indent=1) + "\n")
    print("without a result: " + ", ".join(f"{name} {some} of {all_}" for name, (some, all_) in without_result(journal).items()))
    print(
        f"{len(journal)} files, {total['holds']} relations hold, {total['broken']} broken, {total['known']} known, {total['undecided']} undecided"
    )
    sys.exit(1 if new else 0)


if __name__ == "__main__":
    main()
