#!/usr/bin/env python3
"""A body that meets the quadratic law of the measured wire head-on, and a force sensor with a lag: air_table.py FILE [--speed V] [--lag T] [--sigma N] [--seed N].

m x'' = -F(x), F = max(0, A x^2 + B x + C) from first touch on, the law of Abiko et al. at 90 mm (Table 4), 8.9 kg (Table 5), by Runge and Kutta's method in
steps of 1e-5 s from 0.1 mm before the touch; the reading y follows T y' = F - y. A reading a millisecond for 0.3 s. Shares no code with the solver.
"""

import argparse

import numpy as np

from plants import integrate, read_off

A, B, C = 890183.0, -1297.6, 0.3457  # N/m^2, N/m, N
MASS = 8.9
STEP, INTERVAL, DURATION = 1e-5, 1e-3, 0.3


def force(x):
    return np.where(x > 0.0, np.maximum(0.0, (A * x + B) * x + C), 0.0)


def readings(speed, lag):
    states = integrate(lambda _, y: np.array([y[1], -force(y[0]) / MASS]), np.array([[-1e-4], [speed]]), STEP, round(DURATION / STEP), 1)
    sensor = {"gain": np.ones(1), **{what: np.zeros(1) for what in ("bias", "drift", "delay")}, "lag": np.full(1, lag)}
    times, told = read_off(force(states[:, 0]), STEP, INTERVAL, sensor)
    return zip(times, told[:, 0])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file")
    parser.add_argument("--speed", type=float, default=0.1, help="[m/s]")
    parser.add_argument("--lag", type=float, default=0.0, help="[s]")
    parser.add_argument("--sigma", type=float, default=0.1, help="[N]")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    rng = np.random.default_rng(options.seed)
    with open(options.file, "w", encoding="utf-8") as out:
        out.write("time_s,force_N\n")
        for t, f in readings(options.speed, options.lag):
            out.write(f"{t:.5f},{f + rng.normal(0.0, options.sigma):.6g}\n")


if __name__ == "__main__":
    main()
