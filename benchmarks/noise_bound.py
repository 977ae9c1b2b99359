#!/usr/bin/env python3
"""How near the standard deviation of a reading can be known from replicates: the bound of Cramer and Rao.

usage: noise_bound.py [REPLICATES]

The noise is that of `null_benchmark`'s replicates: white, 0.5 % of the largest force, and smooth, 3 % of the force, correlated over a
quarter of the travel. Known are neither size nor the length of the correlation. Of the replicates' mean nothing is known, so that R - 1
draws are left, whose information on w, h and l is 1/2 (R - 1) tr(V^-1 dV_i V^-1 dV_j). Printed: the smallest standard deviation that an
unbiased estimate of log sigma can have, and in how many of 100 sets such an estimate lies within 20 % of the truth.
"""

import math
import statistics
import sys

import numpy as np

WHITE, SMOOTH, LENGTH = 0.005, 0.03, 0.25


def force(u):
    """Of a loose wire over the share of its travel: flat at first, steep where it is taut."""
    return 0.15 * u + 0.85 * u**3


def covariance(logs, u):
    white, smooth, length = np.exp(logs)
    f = force(u)
    return white * np.eye(len(u)) + smooth * np.outer(f, f) * np.exp(-abs(u[:, None] - u[None, :]) / length)


def bound(readings, replicates):
    u = np.arange(1, readings + 1) / readings
    logs = np.array([2 * math.log(WHITE), 2 * math.log(SMOOTH), math.log(LENGTH)])
    v = covariance(logs, u)
    step = 1e-4
    slopes = [(covariance(logs + step * e, u) - covariance(logs - step * e, u)) / (2 * step) for e in np.eye(3)]
    solved = [np.linalg.solve(v, d) for d in slopes]
    information = np.array([[0.5 * (replicates - 1) * np.trace(a @ b) for b in solved] for a in solved])
    variance = np.trace(v) / readings
    by_log = np.array([np.trace(d) / readings for d in slopes])
    return 0.5 * math.sqrt(by_log @ np.linalg.solve(information, by_log)) / variance


def main():
    normal = statistics.NormalDist()
    for replicates in [int(a) for a in sys.argv[1:]] or [6, 12]:
        for readings in (6, 30, 100, 500):
            deviation = bound(readings, replicates)
            near = normal.cdf(math.log(1.2) / deviation) - normal.cdf(math.log(0.8) / deviation)
            print(f"{replicates} replicates of {readings} readings: {deviation:.3f}, {100 * near:.0f} %")


if __name__ == "__main__":
    main()
