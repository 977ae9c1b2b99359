#!/usr/bin/env python3
"""Times the set-up of revisions of this repository from clean clones, in one run.

usage: set_up.py [--test] [--results FILE] [--keep FOLDER] REVISION [REVISION ...]

Clones each revision in a temporary folder, one after the other, and runs `./run` without a compiler cache: seconds to the first line of
the result ("rms distance"), seconds of the whole call, processor seconds of all its processes, and seconds of a second call, which has
nothing to set up. With --test `./test` follows in the same clone, so that only its own build is timed. The packages must be installed;
benchmarks/results/set_up.json has their sizes, and --results adds the times there. With --keep the clones stay in a folder, by their
commits, for comparisons of both builds.
"""

import argparse
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]


def timed(clone, command):
    """Seconds to the first result, of the whole, and of the processors; the command must end with status 0."""
    before, begin, first = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic(), None
    environment = {**os.environ, "CCACHE_DISABLE": "1"}
    with subprocess.Popen(command, cwd=clone, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as process:
        words = []
        for line in process.stdout:
            words.append(line)
            if first is None and line.startswith("rms distance"):
                first = time.monotonic() - begin
    if process.returncode != 0:
        raise SystemExit(f"{' '.join(command)} ended with status {process.returncode}:\n{''.join(words[-40:])}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return {"first_result_s": first and round(first, 1), "whole_s": round(time.monotonic() - begin, 1),
            "processor_s": round(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, 1)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--test", action="store_true")
    parser.add_argument("--results", type=pathlib.Path)
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("revisions", nargs="+", metavar="REVISION")
    options = parser.parse_args()
    times = {}
    for revision in options.revisions:
        commit = subprocess.run(["git", "rev-parse", revision], cwd=ROOT, check=True, capture_output=True, text=True).stdout.strip()
        with tempfile.TemporaryDirectory() as folder:
            clone = (options.keep.resolve() if options.keep else pathlib.Path(folder)) / commit[:10]
            subprocess.run(["git", "clone", "--quiet", str(ROOT), str(clone)], check=True)
            subprocess.run(["git", "checkout", "--quiet", commit], cwd=clone, check=True)
            one = {"./run": timed(clone, ["./run"]), "./run again": timed(clone, ["./run"])}
            if options.test:
                one["./test"] = timed(clone, ["./test"])
        times[commit[:10]] = one
        print(json.dumps({commit[:10]: one}, indent=1), flush=True)
    first, last = (times[c] for c in (next(iter(times)), next(reversed(times))))
    for command in last:
        for what in ("first_result_s", "whole_s", "processor_s"):
            if first[command][what] and last[command][what]:
                print(f"{command}, {what}: {last[command][what] / first[command][what]:.2f} of the first revision's")
    if options.results:
        stored = json.loads(options.results.read_text(encoding="utf-8"))
        stored["times"] = {"processors": os.cpu_count(), "date": time.strftime("%Y-%m-%d"), "revisions": times}
        options.results.write_text(json.dumps(stored, indent=1), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
