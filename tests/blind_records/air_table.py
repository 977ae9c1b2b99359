#!/usr/bin/env python3
"""A body that meets the quadratic law of the measured wire head-on, and a force sensor with a lag: air_table.py FILE [--speed V] [--lag T] [--sigma N] [--seed N].

m x'' = -F(x), F = max(0, A x^2 + B x + C) from first touch on, the law of Abiko et al. at 90 mm (Table 4), 8.9 kg (Table 5), by Runge and Kutta's method in
steps of 1e-5 s from 0.1 mm before the touch; the reading y follows T y' = F - y. A reading a millisecond for 0.3 s. Shares no code with the solver.
"""

import argparse
import math

import numpy as np

A, B, C = 890183.0, -1297.6, 0.3457  # N/m^2, N/m, N
MASS = 8.9
STEP, EVERY, DURATION = 1e-5, 100, 0.3


def force(x):
    return max(0.0, (A * x + B) * x + C) if x > 0.0 else 0.0


def readings(speed, lag):
    x, v, told = -1e-4, speed, 0.0
    for k in range(round(DURATION / STEP) + 1):
        here = force(x)
        if k % EVERY == 0:
            yield k * STEP, told if lag > 0.0 else here
        k1, a1 = v, -here / MASS
        k2, a2 = v + 0.5 * STEP * a1, -force(x + 0.5 * STEP * k1) / MASS
        k3, a3 = v + 0.5 * STEP * a2, -force(x + 0.5 * STEP * k2) / MASS
        k4, a4 = v + STEP * a3, -force(x + STEP * k3) / MASS
        x += STEP / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        v += STEP / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)
        if lag > 0.0:  # exact for a force that is straight over the step
            next_force = force(x)
            slope = (next_force - here) / STEP
            told = next_force - lag * slope + (told - here + lag * slope) * math.exp(-STEP / lag)


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
