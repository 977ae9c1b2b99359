#!/usr/bin/env python3
"""Checks every promise about verbs through every entry: the command, the Python module, the C++ library, and ranks of MPI.

    entries.py SNARE [--library PROGRAM] [--entry NAME] [--verb VERB] [--check NAME] [--jobs N] [--times]

promises.toml lists the checks, and the reasons for those that are skipped. PROGRAM is the built library_entry.cpp (default: tests/library_entry
beside SNARE). The Python module is found by PYTHONPATH. Prints a table of ok, skipped and BROKEN by verb, entry and check, then the reasons.
Exits 1 if a promise is broken or an entry has a verb that is not in the table.
"""

import argparse
import collections
import concurrent.futures
import pathlib
import signal
import sys
import tempfile
import time
import traceback

import entry_checks
import entry_points
import promise_table
import small_inputs


def tried(check, entry, verb, template, folder, command):
    """Runs one check. Returns the violations and the time [s]."""
    began = time.monotonic()
    trial = entry_checks.Trial(entry, verb, small_inputs.WORK[verb], template, folder, command)
    try:
        entry_checks.CHECKS[check.name](trial)
    except Exception:
        trial.wrong.append(traceback.format_exc().strip().splitlines()[-1] + " " + traceback.format_exc().strip().splitlines()[-3].strip())
    return trial.wrong, time.monotonic() - began


def main():
    # Runs are interrupted. A background job of a shell ignores SIGINT, and so would its children.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    parser = argparse.ArgumentParser()
    parser.add_argument("snare")
    parser.add_argument("--library")
    parser.add_argument("--entry")
    parser.add_argument("--verb")
    parser.add_argument("--check")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--times", action="store_true", help="how long each check took")
    options = parser.parse_args()
    snare = str(pathlib.Path(options.snare).resolve())
    library = options.library or str(pathlib.Path(snare).parent / "tests/library_entry")
    entries = entry_points.all_entries(snare, library)
    command = entries[0]
    checks = promise_table.checks()
    cells, reasons, broken, seconds = {}, collections.defaultdict(list), [], collections.Counter()
    with tempfile.TemporaryDirectory() as name:
        template = pathlib.Path(name) / "files"
        template.mkdir()
        small_inputs.write(template, snare)
        jobs = {}
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            for entry in entries:
                lacking = entry.lacks()
                if not lacking and sorted(entry.verbs()) != sorted(promise_table.VERBS[entry.name]):
                    broken.append(f"{entry.name} has the verbs {sorted(entry.verbs())}, promise_table.py expects others")
                for verb in promise_table.VERBS[entry.name]:
                    for check in checks:
                        place = (verb, entry.name, check.name)
                        if (options.entry not in (None, entry.name) or options.verb not in (None, verb) or
                                options.check not in (None, check.name)):
                            continue
                        if reason := lacking or check.reason(entry.name, verb):
                            cells[place] = "skipped"
                            reasons[f"{check.name}: {reason}"].append(f"{verb} ({entry.name})")
                        else:
                            folder = pathlib.Path(name) / "-".join(place)
                            jobs[place] = pool.submit(tried, check, entry, verb, template, folder, command)
            for place, job in jobs.items():
                wrong, took = job.result()
                cells[place] = "BROKEN" if wrong else "ok"
                seconds[place] = took
                broken += [f"{place[0]} through {place[1]}, {place[2]}: {one}" for one in wrong]
    shown = [check for check in checks if any(place[2] == check.name for place in cells)]
    for number, check in enumerate(shown, 1):
        print(f"{number:3} {check.promise}: {check.name}")
    print(f"\n{'verb':10} {'entry':8}" + "".join(f"{number:>8}" for number in range(1, len(shown) + 1)))
    for verb, entry in dict.fromkeys(place[:2] for place in sorted(cells)):
        print(f"{verb:10} {entry:8}" + "".join(f"{cells.get((verb, entry, check.name), ''):>8}" for check in shown))
    print("\nskipped:")
    for reason, places in reasons.items():
        print(f"  {reason}: {', '.join(places)}")
    if options.times:
        print("\nseconds:")
        for place, took in seconds.most_common(40):
            print(f"  {took:6.2f} {' '.join(place)}")
    print("\nbroken:" if broken else "\nnone is broken")
    for one in broken:
        print(f"  {one}")
    counts = collections.Counter(cells.values())
    print(f"{counts['ok']} ok, {counts['skipped']} skipped, {counts['BROKEN']} broken, {sum(seconds.values()):.0f} s")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
