#!/usr/bin/env python3
"""Compares what two builds of the command `snare` write, byte for byte.

usage: compare_results.py OLD NEW [--quick] [--only TEXT] [--keep DIR]

OLD and NEW are two executables. Every shipped experiment, wire and scenario goes through the verbs that read it, and so
do three experiments with readings that OLD generates: with an effect that the declared model lacks, and without.
Tables must be equal to the last byte. Times and versions are left out of JSON files, by their keys, and of pages: a number on a page
may differ where it also differs between two runs of OLD, or where it is followed by "s".

--quick leaves out `reproduce` and `validate`, which take minutes.  --only TEXT: cases whose name contains TEXT.
Prints a line a case, then what differs; status 1 if anything does.
"""

import argparse
import json
import os
import pathlib
import pty
import random
import re
import subprocess
import sys
import tempfile

REPOSITORY = pathlib.Path(__file__).resolve().parent.parent
DATA = REPOSITORY / "data"
# Keys of JSON files whose values are times, or follow from them.
TIMES = re.compile(r"(^|_)(wall|seconds|real_time_factor|wall_s|search_s|cpu|elapsed|version|commit|machine|date)(_|$)")
NUMBER = re.compile(r"-?\d[\d.]*(?:e[-+]?\d+)?")

EXPERIMENT = """schema = "snare-experiment/1"
title  = "generated"
source = "computed by the older of two builds, with noise"

[wire]
construction       = "solid"
diameter_mm        = 1.5
length_mm          = {length}
youngs_modulus_GPa = 193.0
poisson_ratio      = 0.29
density_kg_m3      = 7930.0

[mount]
kind    = "clamped"
span_mm = 175.0
{mount}
[pusher]
shape     = "cylinder"
radius_mm = 6.0
friction  = 0.0
direction = "outward"
"""
SERIES = """
[[series]]
name = "s{position}"
contact_position_mm = {position}.0
force_sigma_N = {sigma}
"""


class Generated:
    """An experiment whose readings come from a wire with an effect, while the file declares none."""

    def __init__(self, name: str, verb: str, length: float = 180.0, mount: str = "", fit: str = ""):
        self.name, self.verb, self.length, self.mount, self.fit = name, verb, length, mount, fit

    def write(self, command: str, folder: pathlib.Path) -> pathlib.Path:
        folder.mkdir(parents=True)
        sigma = 0.2
        truth = EXPERIMENT.format(length=self.length, mount=self.mount)
        declared = EXPERIMENT.format(length=180.0, mount="")
        for position in (40, 65, 90):
            head = SERIES.format(position=position, sigma=sigma)
            truth += head + "travel_mm = 1.5\npoints = 31\n"
            declared += head + f'file = "s{position}.csv"\n'
        (folder / "truth.toml").write_text(truth)
        run(command, ["push", folder / "truth.toml"], folder / "truth")
        noise = random.Random(20)
        rows = {}
        for line in (folder / "truth" / "curves.csv").read_text().splitlines():
            cells = line.split(",")
            if line.startswith("s") and len(cells) > 2 and cells[0] in ("s40", "s65", "s90"):
                rows.setdefault(cells[0], []).append((float(cells[1]), float(cells[2]) + noise.gauss(0.0, sigma)))
        for name, readings in rows.items():
            text = "".join(f"{d!r},{f!r}\n" for d, f in readings)
            (folder / f"{name}.csv").write_text("displacement_mm,force_N\n" + text)
        file = folder / "declared.toml"
        file.write_text(declared + self.fit)
        return file


GENERATED = [
    Generated("length", "trace", length=180.3),
    Generated("nothing missing", "trace"),
    Generated("mounts that give", "fit", mount="translational_stiffness_N_m = 2e6\n",
              fit='\n[fit]\nfree = ["wire.length_mm", "mount_axial_compliance.compliance_m_N"]\n'),
]


def run(command: str, arguments: list, out: pathlib.Path) -> int:
    """The verb's exit status; its console output goes into the folder of its results. Progress, which depends on the clock, is written
    over on a terminal and so known from what is said."""
    terminal, ours = pty.openpty()
    with tempfile.TemporaryFile("w+") as said:
        with subprocess.Popen([command, *map(str, arguments), "--out", out], stdout=said, stderr=ours) as process:
            os.close(ours)
            told = b""
            try:
                while part := os.read(terminal, 65536):
                    told += part
            except OSError:  # Linux ends a terminal so
                pass
        os.close(terminal)
        said.seek(0)
        text = re.sub(r"\r\x1b\[K[^\r\n]*(?=\r\x1b\[K|\Z)", "", told.decode(errors="replace"))
        out.mkdir(parents=True, exist_ok=True)
        (out / "console.txt").write_text(said.read() + text.replace("\r\x1b[K", "").replace("\r\n", "\n"))
    return process.returncode


def cases(quick: bool, generated: dict) -> list:
    found = [(f"simulate {f.stem}", ["simulate", f]) for f in sorted((DATA / "scenarios").glob("*.toml"))]
    found += [(f"distil {f.stem}", ["distil", f]) for f in sorted((DATA / "wires").glob("*.toml"))]
    published = DATA / "experiments" / "published_static.toml"
    found += [(f"{verb} published", [verb, published]) for verb in ("push", "fit", "trace", "compare")]
    found += [(f"{g.verb} {g.name}", [g.verb, generated[g.name]]) for g in GENERATED]
    found += [("ringdown", ["ringdown", DATA / "experiments" / "ringdown.toml"])]
    if not quick:
        found += [("reproduce", ["reproduce"]), ("validate", ["validate"])]
    return found


def without_times(value):
    if isinstance(value, dict):
        return {k: without_times(v) for k, v in value.items() if not TIMES.search(k)}
    if isinstance(value, list):
        return [without_times(v) for v in value]
    return value


def differing_lines(old: str, new: str, again: str, out: tuple) -> list:
    """Lines of a text that differ, numbers aside that vary between two runs of the same build."""

    def lines(text: str, out: pathlib.Path) -> list:
        text = text.replace(str(out), "OUT")
        text = re.sub(r"-?\d[\d.e+-]*(?: s\b|&#8239;s\b| times real time)", "TIME", text)
        return re.sub(r" +", " ", text).splitlines()

    def shape_of(line: str) -> tuple:
        """What rows of one table have in common: their tags, and how many numbers they have."""
        return re.sub(r">[^<]*<", "><", line) if "<" in line else "", len(NUMBER.findall(line))

    texts = [lines(t, o) for t, o in zip((old, new, again), out)]
    if len(texts[0]) != len(texts[1]):
        return [f"{len(texts[0])} lines before, {len(texts[1])} after"]
    varying = set()  # numbers of a line that vary in any line of the same shape: columns of a table
    for a, c in zip(texts[0], texts[2]):
        shape = shape_of(a)
        for place, (x, y) in enumerate(zip(NUMBER.findall(a), NUMBER.findall(c))):
            if x != y:
                varying.add((shape, place))
    shapes = {shape for shape, _ in varying}
    found = []
    for number, (a, b) in enumerate(zip(texts[0], texts[1]), start=1):
        if a == b:
            continue
        shape = shape_of(a)
        pairs = enumerate(zip(NUMBER.findall(a), NUMBER.findall(b)))
        same_words = NUMBER.sub("#", a) == NUMBER.sub("#", b)
        if same_words and shape in shapes and all(x == y or (shape, i) in varying for i, (x, y) in pairs):
            continue
        found.append(f"line {number}: {a[:160]!r} -> {b[:160]!r}")
    return found


def differences(folders: tuple) -> list:
    """What differs between the result folders of OLD, NEW and OLD again."""
    names = [sorted(p.relative_to(f).as_posix() for p in f.rglob("*") if p.is_file()) for f in folders]
    if names[0] != names[1]:
        return [f"files: {sorted(set(names[0]) ^ set(names[1]))}"]
    found = []
    for name in names[0]:
        files = [f / name for f in folders]
        if files[0].read_bytes() == files[1].read_bytes():
            continue
        if name.endswith(".json"):
            old, new = (json.loads(f.read_text()) for f in files[:2])
            if without_times(old) != without_times(new):
                found.append(f"{name} beside its times")
        elif name.endswith((".html", ".txt")) and files[2].exists():
            texts = [f.read_text() for f in files]
            found += [f"{name}, {line}" for line in differing_lines(*texts, folders)]
        else:
            found.append(name)
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", default="")
    parser.add_argument("--keep", type=pathlib.Path)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = given.keep or pathlib.Path(temporary)
        generated = {g.name: g.write(given.old, folder / "generated" / g.name) for g in GENERATED}
        wrong = 0
        for name, arguments in cases(given.quick, generated):
            if given.only not in name:
                continue
            outs = tuple(folder / name / which for which in ("old", "new", "again"))
            status = [run(command, arguments, out) for command, out in zip((given.old, given.new, given.old), outs)]
            found = differences(outs)
            if status[0] != status[1]:
                found.insert(0, f"status {status[0]} before, {status[1]} after")
            print(f"{'same   ' if not found else 'DIFFERS'} {name} (status {status[1]})", flush=True)
            for line in found[:20]:
                print(f"        {line}")
            wrong += bool(found)
    print(f"{wrong} cases differ")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
