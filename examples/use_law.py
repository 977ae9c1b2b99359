"""Distils a wire into a table of its force and uses the table in a simulator of twenty lines: the same as use_law.cpp.

usage: use_law.py WIRE.toml [PICTURE.png]
"""

import sys

import numpy as np
import snare

law = snare.distil(sys.argv[1], set={"table.points": [12, 4, 3], "table.most_points": [12, 4, 3]})["laws"][0]
print(f"stated error of the table: {law.bound:.3g} N")

mass, speed, step = 8.9, 0.05, 1e-5  # kg, m/s, s
middle = 0.5 * law.span
travel, velocity, deepest = 0.0, speed, 0.0
history = []
while travel >= 0.0:  # the leapfrog method; beyond the wire there is no force
    velocity -= 0.5 * step * law.force(travel, middle) / mass
    travel += step * velocity
    velocity -= 0.5 * step * law.force(travel, middle) / mass
    deepest = max(deepest, travel)
    history.append((travel, velocity))
print(f"deepest travel: {1e3 * deepest:.6g} mm")

way = np.linspace(0.0, deepest, 10001)
force = law.force(way, middle)  # a whole array at once
work = np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(way))
print(f"work of the wire to there over the kinetic energy: {work / (0.5 * mass * speed**2):.6g}")
print(f"speed of return over that of approach: {-velocity / speed:.6g}")

if len(sys.argv) > 2:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    travels, velocities = np.array(history).T
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.0, 3.4), constrained_layout=True)
    left.plot(1e3 * way, force, color="k")
    left.set(xlabel="travel [mm]", ylabel="force of the law [N]")
    right.plot(step * np.arange(len(travels)), velocities, color="k")
    right.axhline(-speed, color="0.5", linestyle=":")  # a law without loss gives it back
    right.set(xlabel="time [s]", ylabel="velocity of the mass [m/s]")
    figure.savefig(sys.argv[2])
