"""Readers of tables of data as programs read them: a 2-D lookup table, linear with linear extrapolation, and splines of an ADAMS dataset."""

import bisect
import csv
import io
import re


def line(x, y, at):
    """Through points, linear beyond the first and last two."""
    k = min(max(bisect.bisect_right(x, at) - 1, 0), len(x) - 2)
    return y[k] + (y[k + 1] - y[k]) / (x[k + 1] - x[k]) * (at - x[k])


def akima(x, y, at):
    """Akima 1970 between points, linear through the first and last two beyond them."""
    if not x[0] <= at <= x[-1]:
        return line(x, y, at)
    secants = [(y[k + 1] - y[k]) / (x[k + 1] - x[k]) for k in range(len(x) - 1)]
    before = [2 * secants[0] - secants[1]]
    before.insert(0, 2 * before[0] - secants[0])
    after = [2 * secants[-1] - secants[-2]]
    after.append(2 * after[0] - secants[-1])
    m = before + secants + after

    def slope(k):
        left, right = abs(m[k + 3] - m[k + 2]), abs(m[k + 1] - m[k])
        return (left * m[k + 1] + right * m[k + 2]) / (left + right) if left + right > 0 else (m[k + 1] + m[k + 2]) / 2

    k = min(max(bisect.bisect_right(x, at) - 1, 0), len(x) - 2)
    h = x[k + 1] - x[k]
    t = (at - x[k]) / h
    a, b, secant = slope(k), slope(k + 1), m[k + 2]
    return y[k] + h * t * (a + t * (3 * secant - 2 * a - b + t * (a + b - 2 * secant)))


def lookup_table(text):
    """The force as a function of travel and position."""
    rows = list(csv.reader(io.StringIO(text)))
    if rows[0][0] != "":
        raise ValueError("the first cell must be empty")
    position = [float(cell) for cell in rows[0][1:]]
    travel = [float(row[0]) for row in rows[1:]]
    force = [[float(cell) for cell in row[1:]] for row in rows[1:]]
    check(travel)
    check(position)

    def read(d, s):
        k = min(max(bisect.bisect_right(travel, d) - 1, 0), len(travel) - 2)
        return line(travel[k:k + 2], [line(position, row, s) for row in force[k:k + 2]], d)

    return read


def check(knots):
    if any(b <= a for a, b in zip(knots, knots[1:])):
        raise ValueError("knots must ascend")


class Spline:
    """SPLINE/id of a dataset: X, and one list Y, or lists Y that begin with their Z."""

    def __init__(self, statement):
        if "LINEAR_EXTRAPOLATION" not in statement:
            raise ValueError("beyond its points ADAMS continues this spline with parabolas")
        lists = [[float(cell) for cell in text.split(",") if cell.strip()] for text in re.split(r"[XY]=", statement)[1:]]
        self.x, rows = lists[0], lists[1:]
        check(self.x)
        single = len(rows) == 1
        if len(self.x) < 4 or (not single and len(rows) < 4):
            raise ValueError("ADAMS wants four points at least")
        self.z = [0.0, 1.0] if single else [row[0] for row in rows]
        self.y = [rows[0], rows[0]] if single else [row[1:] for row in rows]
        check(self.z)
        if any(len(row) != len(self.x) for row in self.y):
            raise ValueError("every Y must have a number for each X")

    def read(self, along, x, z):
        k = min(max(bisect.bisect_right(self.z, z) - 1, 0), len(self.z) - 2)
        return line(self.z[k:k + 2], [along(self.x, row, x) for row in self.y[k:k + 2]], z)

    def akima(self, x, z):
        return self.read(akima, x, z)

    def linear(self, x, z):
        return self.read(line, x, z)


def adams_splines(text):
    """By their numbers."""
    statements = re.sub(r"^!.*\n", "", text, flags=re.MULTILINE)
    if any(len(one) > 80 for one in statements.splitlines()):
        raise ValueError("a line of a dataset has 80 characters at most")
    joined = re.sub(r"\n,", ",", statements)
    return {int(number): Spline(rest) for number, rest in re.findall(r"SPLINE/(\d+),(.*)", joined)}
