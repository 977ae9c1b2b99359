"""Files that are drawn at random, and what the command makes of them."""

import copy
import csv
import hashlib
import json
import math
import pathlib
import random
import shlex
import subprocess

import numpy

LIMIT = 40.0  # [s] of one run; what takes longer decides nothing
VERBS = {"push": "curves.csv", "fit": "curves.csv", "simulate": "history.csv", "sweep": "cases.csv", "distil": "table.csv"}
ANSWERS = {"fit": "fit.json", "simulate": "summary.json", "sweep": "summary.json", "distil": "law.json"}


class Undecided(Exception):
    """This file says nothing about this relation: the relation does not apply to it, or a run took too long."""


class Broken(Exception):
    """The relation does not hold: a word for it and a sentence with both numbers."""

    def __init__(self, what, sentence):
        super().__init__(sentence)
        self.what = what


class Draw(random.Random):
    """What generators draw: numbers of four digits, so that a file can be read."""

    def between(self, low, high):
        return float(f"{self.uniform(low, high):.4g}")

    def log(self, low, high):
        return float(f"{math.exp(self.uniform(math.log(low), math.log(high))):.4g}")

    def maybe(self, share):
        return self.random() < share

    def vector(self, size):
        return [self.between(-size, size) for _ in range(3)]


class Case:
    """A verb and its files by name, the first one the file that is run: a table, or text of any other kind."""

    def __init__(self, verb, main, **files):
        self.verb = verb
        self.main = main
        self.files = files

    def changed(self):
        return copy.deepcopy(self)

    def texts(self):
        return {
            "case.toml": toml(self.main),
            **{name.replace("__", "."): f if isinstance(f, str) else toml(f) for name, f in self.files.items()},
        }


def word(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key(k)} = {word(v)}" for k, v in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(word(v) for v in value) + "]"
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else repr(value)


def key(name):
    return name if all(c.isalnum() or c in "_-" for c in name) else json.dumps(name)


def toml(table):
    """Plain keys first; a list of tables has a head for each, what stands deeper is on one line."""
    plain = {
        k: v for k, v in table.items() if not isinstance(v, dict) and not (isinstance(v, list) and v and isinstance(v[0], dict))
    }
    lines = [f"{key(k)} = {word(v)}" for k, v in plain.items()]
    for name, value in table.items():
        for entry in [] if name in plain else value if isinstance(value, list) else [value]:
            lines.append(f"[[{name}]]" if isinstance(value, list) else f"[{name}]")
            lines += [f"{key(k)} = {word(v)}" for k, v in entry.items()]
    return "\n".join(lines) + "\n"


class Run:
    """What one run has written: status, message, columns of its table, its answer."""

    def __init__(self, verb, status, message, out):
        self.status, self.message = status, message
        self.answer, self.columns = {}, {}
        self.out = out
        if status != 0:
            return
        if verb in ANSWERS and (out / ANSWERS[verb]).exists():
            self.answer = json.loads((out / ANSWERS[verb]).read_text())
        with (out / VERBS[verb]).open(newline="") as file:
            rows = list(csv.reader(line for line in file if not line.startswith("#")))
        self.names = rows[0]
        self.rows = rows[1:]
        self.columns = {name: column([row[k] for row in self.rows]) for k, name in enumerate(self.names)}

    def __getitem__(self, name):
        return self.columns[name]


def column(cells):
    try:
        return numpy.array([float(c) if c else math.nan for c in cells])
    except ValueError:
        return numpy.array(cells)


class Runner:
    """Runs cases in a folder, each once; `asked` has those of the relation at hand in their order."""

    def __init__(self, snare, folder):
        self.snare, self.folder = snare, pathlib.Path(folder)
        self.done, self.asked = {}, []

    def forget(self):
        self.done, self.asked = {}, []

    def __call__(self, case, must=True):
        texts = case.texts()
        name = hashlib.sha256((case.verb + json.dumps(texts)).encode()).hexdigest()[:12]
        self.asked = [a for a in self.asked if a != name] + [name]
        if name not in self.done:
            self.done[name] = self.start(case, texts, self.folder / name)
        found = self.done[name]
        if found.status == -1:
            raise Undecided(f"longer than {LIMIT:g} s")
        if must and found.status != 0:
            if found.status in (2, 3):
                raise Undecided(f"status {found.status}: {found.message[:300]}")
            raise Broken("status", f"status {found.status}: {found.message[:300]}")
        return found

    def start(self, case, texts, folder):
        folder.mkdir(exist_ok=True)
        for name, text in texts.items():
            (folder / name).write_text(text)
        line = [
            self.snare,
            *case.verb.split(),
            str(folder / "case.toml"),
            "--out",
            str(folder / "out"),
            "--quiet",
            "--threads",
            "1",
        ]
        try:
            run = subprocess.run(line, capture_output=True, text=True, timeout=LIMIT)
        except subprocess.TimeoutExpired:
            return Run(case.verb, -1, "", folder / "out")
        return Run(case.verb, run.returncode, run.stderr, folder / "out")

    def commands(self, verb):
        """What shows the relation at hand, by hand."""
        at = [self.folder / name for name in self.asked]
        return [shlex.join([str(self.snare), *verb.split(), f"{folder}/case.toml", "--out", f"{folder}/out"]) for folder in at]


def different(what, first, second, allowed, where=""):
    """Raises where two arrays differ by more than allowed; says so of the worst place."""
    first, second = numpy.atleast_1d(first), numpy.atleast_1d(second)
    if first.shape != second.shape:
        raise Broken(what, f"{what}: {first.shape} and {second.shape} numbers")
    if first.dtype.kind not in "fiu" or second.dtype.kind not in "fiu":
        if list(first) != list(second):
            raise Broken(what, f"{what}: other words")
        return
    over = numpy.abs(first - second) - allowed
    over[numpy.isnan(first) & numpy.isnan(second)] = -1.0
    k = int(numpy.nanargmax(over)) if not numpy.isnan(over).all() else 0
    if not over[k] <= 0.0:
        limit = numpy.broadcast_to(allowed, first.shape)[k]
        raise Broken(what, f"{what}: {first[k]:.9g} and {second[k]:.9g}, {limit:.2g} allowed, in line {k + 1}{where}")


def same_numbers(one, other, but=(), rows=None):
    """The same bytes in every cell, or in those of the lines `rows` of the first."""
    lines = one.rows if rows is None else [one.rows[k] for k in rows]
    if len(lines) != len(other.rows):
        raise Broken("rows", f"{len(lines)} and {len(other.rows)} lines")
    for k, name in enumerate(one.names):
        if name in but:
            continue
        if name not in other.names:
            raise Broken(name, f"no column {name}")
        there = other.names.index(name)
        for number, (a, b) in enumerate(zip(lines, other.rows)):
            if a[k] != b[there]:
                raise Broken(name, f"{name}: {a[k]} and {b[there]} in line {number + 1}, the same bytes expected")
