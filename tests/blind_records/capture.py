#!/usr/bin/env python3
"""Rates of a visitor that a snare of turning rods captures, by equations written out by hand: capture.py OUT.csv [--flight 1|2] [--seed N]
[--sigma DEG_S] [--half-stiffness N_M] [--gf-stiffness NM_RAD] [--ring-rate DEG_S] [--to S].

Nothing of the solver is used: a visitor and a grapple fixture as rigid bodies, a bushing between them, three rods (Honda et al. 2014, eq. 1, friction of
Table 3) that turn about the mounts of the fixed ring, Runge and Kutta's method of the fourth order. From `HELD` on the fixture stands still. The
numbers that the fit is to find are those of the options; everything else is as data/records/flight_scenario.toml declares it.
"""

import argparse
import math
import sys

import numpy as np

DEG = math.pi / 180.0
STEP = 1e-4            # s: a third of what the bushing's damping allows
EVERY = 500           # steps between readings: 20 Hz
HELD = 2.0             # s
MASS, INERTIA = 16000.0, np.array([147400.0, 147400.0, 38700.0])
FIXTURE_MASS, FIXTURE_INERTIA = 20.0, 0.5
TO_BASE = np.array([0.0, 0.0, -5.0])     # of the fixture on the visitor, from its centre of mass [m]
SHIFT, SHIFT_DAMPING, TURN_DAMPING = 1.0e9, 1.0e5, 1.0e4
RING, REACH, HEIGHTS = 0.1, 0.006 + 0.00075, (-0.003, 0.0, 0.003)  # m
HALF_LENGTH, HALF_SPAN = 0.1, 0.09977
STATIC, DYNAMIC, STATIC_SPEED, DYNAMIC_SPEED = 0.3, 0.1, 0.01, 1.0
BEGIN, START, END, RAMP = 0.2, 115.0, 180.0, 0.1  # s, deg, deg, s

# Where the fixture is, how it drifts [m, m/s], how the visitor turns [rad/s].
FLIGHTS = {1: (np.array([0.006, 0.004, 0.2]), np.array([0.010, -0.004, 0.0]), np.array([0.01, 0.02, 0.03]) * DEG),
           2: (np.array([-0.008, 0.005, 0.2]), np.array([-0.007, 0.009, 0.0]), np.array([-0.02, 0.01, -0.025]) * DEG)}


def cross(a, b):
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def rotation(q):
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def turned(q, w):
    """Rate of a quaternion by an angular velocity in the body's axes."""
    return 0.5 * np.array([-q[1] * w[0] - q[2] * w[1] - q[3] * w[2], q[0] * w[0] + q[2] * w[2] - q[3] * w[1],
                           q[0] * w[1] + q[3] * w[0] - q[1] * w[2], q[0] * w[2] + q[1] * w[1] - q[2] * w[0]])


def ring_angle(t, rate):
    """Angle [rad] and rate [rad/s] of the turning ring: at constant rate, reached and left within RAMP."""
    way, whole = (END - START), (END - START) / rate + RAMP
    s, a = min(max(t - BEGIN, 0.0), (END - START) / rate + RAMP), rate / RAMP
    rest = whole - s
    angle = 0.5 * a * s * s if s < RAMP else way - 0.5 * a * rest * rest if rest < RAMP else rate * (s - 0.5 * RAMP)
    turning = a * s if s < RAMP else a * rest if rest < RAMP else rate
    return (START + angle) * DEG, turning * DEG


def friction(speed):
    if speed < STATIC_SPEED:
        x = speed / STATIC_SPEED
        return STATIC * 0.5 * x * (3.0 - x * x)
    x = min(1.0, (speed - STATIC_SPEED) / (DYNAMIC_SPEED - STATIC_SPEED))
    return STATIC + (DYNAMIC - STATIC) * x * x * (3.0 - 2.0 * x)


def rods(t, p, R, v, w, stiffness, rate):
    """Force and moment about the fixture's centre (p) of the three rods on its shaft; w in the world's axes."""
    force, moment = np.zeros(3), np.zeros(3)
    (theta, turning), axis = ring_angle(t, rate), R[:, 2]
    h = math.sqrt(HALF_LENGTH**2 - HALF_SPAN**2)
    for i, height in enumerate(HEIGHTS):
        a = 2.0 * math.pi * i / 3.0
        px, py = RING * math.cos(a), RING * math.sin(a)
        qx, qy = RING * math.cos(a + theta), RING * math.sin(a + theta)
        length = math.hypot(qx - px, qy - py)
        ux, uy = (qx - px) / length, (qy - py) / length
        c = p + axis * ((height - p[2]) / axis[2])
        behind = -(ux * (c[1] - py) - uy * (c[0] - px))
        rho = math.hypot(c[0] - px, c[1] - py)
        if behind <= -REACH or rho <= REACH:
            continue
        x = math.sqrt(rho**2 - REACH**2) * (math.asin(behind / rho) + math.asin(REACH / rho))
        normal = 2.0 * stiffness * (1.0 - HALF_LENGTH / math.sqrt(HALF_LENGTH**2 + 2.0 * h * x + x * x)) * (h + x)
        across, along = np.array([-uy, ux, 0.0]), np.array([ux, uy, 0.0])
        place = ux * (c[0] - px) + uy * (c[1] - py)
        touch = np.array([px + ux * place, py + uy * place, height])
        # The piece of wire that is touched goes with both mounts, of which one turns.
        slip = v + cross(w, touch - p) - place / length * turning * np.array([-qy, qx, 0.0])
        slip = np.array([slip @ along, slip @ axis])
        speed = math.hypot(*slip)
        f = normal * across
        if speed > 0.0:
            f = f - friction(speed) * normal / speed * (slip[0] * along + slip[1] * axis)
        force += f
        moment += cross(touch - p, f)
    return force, moment


def run(flight, stiffness, gf, ring_rate, to):
    p0, v0, w0 = FLIGHTS[flight]
    y = np.concatenate([p0, [1, 0, 0, 0], v0, w0, p0 - TO_BASE, [1, 0, 0, 0], v0 + cross(w0, -TO_BASE), w0])
    held = None

    def slope(t, y):
        pf, qf, vf, wf, p, q, v, w = y[0:3], y[3:7], y[7:10], y[10:13], y[13:16], y[16:20], y[20:23], y[23:26]
        Rf, R = rotation(qf), rotation(q)
        arm = R @ TO_BASE
        # The bushing, at the base; its turn is that of small angles beside which its square is nothing.
        shift = Rf.T @ (p + arm - pf)
        world_w, world_wf = R @ w, Rf @ wf
        shift_rate = Rf.T @ (v + cross(world_w, arm) - vf - cross(world_wf, p + arm - pf))
        S = Rf.T @ R
        turn = 0.5 * np.array([S[2, 1] - S[1, 2], S[0, 2] - S[2, 0], S[1, 0] - S[0, 1]])
        f = Rf @ -(SHIFT * shift + SHIFT_DAMPING * shift_rate)
        m = Rf @ -(gf * turn + TURN_DAMPING * (Rf.T @ (world_w - world_wf)))
        mw = R.T @ (m + cross(arm, f))
        dv, dw = f / MASS, (mw - cross(w, INERTIA * w)) / INERTIA
        if held:
            return np.concatenate([np.zeros(13), v, turned(q, w), dv, dw])
        fr, mr = rods(t, pf, Rf, vf, world_wf, stiffness, ring_rate)
        mf = Rf.T @ (mr - m - cross(p + arm - pf, f))
        return np.concatenate([vf, turned(qf, wf), (fr - f) / FIXTURE_MASS, mf / FIXTURE_INERTIA, v, turned(q, w), dv, dw])

    told = []
    for k in range(round(to / STEP) + 1):
        t = k * STEP
        if k % EVERY == 0:
            told.append([t, *(y[23:26] / DEG)])
        if held is None and t >= HELD - 0.5 * STEP:
            held = True
            y[7:13] = 0.0
        k1 = slope(t, y)
        k2 = slope(t + 0.5 * STEP, y + 0.5 * STEP * k1)
        k3 = slope(t + 0.5 * STEP, y + 0.5 * STEP * k2)
        y = y + STEP / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + slope(t + STEP, y + STEP * k3))
        y[3:7] /= np.linalg.norm(y[3:7])
        y[16:20] /= np.linalg.norm(y[16:20])
    return np.array(told)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out")
    parser.add_argument("--flight", type=int, choices=(1, 2), default=1)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--sigma", type=float, default=0.002)
    parser.add_argument("--half-stiffness", type=float, default=6.0e5)
    parser.add_argument("--gf-stiffness", type=float, default=0.93e8)
    parser.add_argument("--ring-rate", type=float, default=55.0)
    parser.add_argument("--to", type=float, default=5.0)
    o = parser.parse_args()
    told = run(o.flight, o.half_stiffness, o.gf_stiffness, o.ring_rate, o.to)
    told[:, 1:] += np.random.default_rng([o.seed, o.flight]).normal(0.0, o.sigma, told[:, 1:].shape)
    with open(o.out, "w", encoding="utf-8") as out:
        out.write("time_s,rates_x_deg_s,rates_y_deg_s,rates_z_deg_s\n")
        for row in told:
            out.write(f"{row[0]:.2f}," + ",".join(f"{v:.6f}" for v in row[1:]) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
