"""Reference solutions that share no code with snare: closed forms, and the planar extensible elastica by SciPy's collocation.

SI units. The wire is the declared one of the published static test: solid SUS-304, 1.5 mm thick.
"""

import json
import math

import numpy as np
from scipy.integrate import solve_bvp, solve_ivp
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

DIAMETER, LENGTH, SPAN = 1.5e-3, 0.180, 0.175
YOUNG, POISSON, DENSITY = 193e9, 0.29, 7930.0
AREA = math.pi * DIAMETER**2 / 4
BENDING = YOUNG * math.pi * DIAMETER**4 / 64         # EI [N m^2]
AXIAL = YOUNG * AREA                                 # EA [N]
TWISTING = BENDING / (1 + POISSON)                   # GJ [N m^2]
PROBE = 6e-3 + DIAMETER / 2                          # from the axis of the pusher to the centreline [m]
MASS, SPEED = 8.9, 0.1                               # of the body that strikes the wire
DAMPING = 1e-5                                       # Kelvin-Voigt time of the wire [s]
TRAVELS = tuple(2e-4 * k for k in range(1, 21))      # of the pusher [m]


def buckled(points=20001):
    """Shares of the length, places [m] and angles of the wire between its clamps, as the first mode of a shallow one has them."""
    share = np.linspace(0.0, 1.0, points)
    inner = np.sin(2 * np.pi * (np.arange(2000) + 0.5) / 2000)
    amplitude = brentq(lambda a: np.mean(np.cos(a * inner)) - SPAN / LENGTH, 0.1, 2.0)
    angle = amplitude * np.sin(2 * np.pi * share)
    x, y = (LENGTH * np.concatenate(([0.0], np.cumsum(0.5 * (f[1:] + f[:-1])) / (points - 1))) for f in (np.cos(angle), np.sin(angle)))
    return share, x, y, angle


def chain_touch(places, position):
    """Height of the pusher's axis at a position along the chord where it first touches a chain of straight elements; a place a row."""
    t = np.linspace(0.0, 1.0, 401)
    heights = []
    for a, b in zip(places[:-1], places[1:]):
        x, y = a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])
        near = np.abs(x - position) < PROBE
        if near.any():
            heights.append(np.min(y[near] - np.sqrt(PROBE**2 - (x[near] - position)**2)))
    return float(min(heights))


class Elastica:
    """The loose wire between two clamps, touched by a frictionless cylinder whose axis is at (position, height).

    Extensible and unshearable: x' = (1 + T/EA) cos(theta), EI theta' = M, in the unstretched arc S. Two pieces meet at the arc
    of the contact, which is an unknown. Lengths in units of the wire's length, forces of EI/L^2.
    """

    largest_step = 5e-5  # [m]

    def __init__(self, position, radius=PROBE, tolerance=1e-9):
        self.position, self.radius, self.tolerance = position / LENGTH, radius / LENGTH, tolerance
        self.axial = AXIAL * LENGTH**2 / BENDING
        t = np.linspace(0.0, 1.0, 81)
        share, x, y, angle = buckled(2001)
        arc = self.position * LENGTH / SPAN
        pieces = []
        for first, size in ((0.0, arc), (arc, 1 - arc)):
            at = first + size * t
            pieces += [np.interp(at, share, x / LENGTH), np.interp(at, share, y / LENGTH), np.interp(at, share, angle),
                       np.interp(at, share, np.gradient(angle, share))]
        height = pieces[1][-1] - self.radius
        self.state = (t, np.array(pieces), np.array([arc, -4 * np.pi**2, 0.0, 0.0, height]))
        self._solve(None)
        self.first_touch = self.state[2][4]
        self.state[2][4] = 0.0
        self.travel = 0.0

    def _solve(self, height):
        """Equilibrium at a height of the cylinder; at None at first touch, without force.

        Besides the two pieces unknown: the arc of the contact, the force in the left piece, the angle at the contact, and the
        contact force, at first touch the height of the cylinder.
        """

        def unknowns(p):
            return (*p[:4], 0.0, p[4]) if height is None else (*p, height)

        def slopes(t, y, p):
            arc, nx, ny, contact, force, _ = unknowns(p)
            out = np.empty_like(y)
            for k, size, fx, fy in ((0, arc, nx, ny), (4, 1 - arc, nx + force * np.sin(contact), ny - force * np.cos(contact))):
                angle = y[k + 2]
                stretch = 1 + (fx * np.cos(angle) + fy * np.sin(angle)) / self.axial
                out[k] = size * stretch * np.cos(angle)
                out[k + 1] = size * stretch * np.sin(angle)
                out[k + 2] = size * y[k + 3]
                out[k + 3] = size * stretch * (fx * np.sin(angle) - fy * np.cos(angle))
            return out

        def ends(a, b, p):
            level = unknowns(p)[5]
            return np.array([a[0], a[1], a[2], b[4] - SPAN / LENGTH, b[5], b[6],
                             b[0] - a[4], b[1] - a[5], b[2] - a[6], b[3] - a[7], b[2] - p[3],
                             b[0] - self.position + self.radius * np.sin(b[2]), b[1] - level - self.radius * np.cos(b[2])])

        t, y, p = self.state
        result = solve_bvp(slopes, ends, t, y, p, tol=self.tolerance, max_nodes=20000)
        if result.status:
            raise RuntimeError(result.message)
        self.state, self.solution = (result.x, result.y, result.p), result
        return result

    def push(self, travel):
        """Force against the push [N] at a travel from first touch [m]."""
        while self.travel != travel:
            step = min(max(travel - self.travel, -self.largest_step), self.largest_step)
            to = travel if abs(travel - self.travel) <= self.largest_step else self.travel + step
            self._solve(self.first_touch + to / LENGTH)
            self.travel = to
        p = self.solution.p
        return p[4] * math.cos(p[3]) * BENDING / LENGTH**2

    def strains(self):
        """Weights [m], curvatures [1/m] and stretches at Gauss points along both pieces, to integrate over the wire."""
        nodes, weights = np.polynomial.legendre.leggauss(60)
        t, w = 0.5 * (nodes + 1), 0.5 * weights
        arc, nx, ny, contact, force = self.solution.p
        y = self.solution.sol(t)
        out = []
        for k, size, fx, fy in ((0, arc, nx, ny), (4, 1 - arc, nx + force * np.sin(contact), ny - force * np.cos(contact))):
            stretch = (fx * np.cos(y[k + 2]) + fy * np.sin(y[k + 2])) / self.axial
            out.append((w * size * LENGTH, y[k + 3] / LENGTH, stretch))
        return [np.concatenate(parts) for parts in zip(*out)]


def push_curve(position, travels):
    """Forces [N] on the frictionless cylinder of 6 mm, pushed with the bulge at a position along the chord."""
    wire = Elastica(position)
    return np.array([wire.push(d) for d in travels])


def impact(damping=DAMPING, to=1.0e-3, points=41):
    """Peak force [N] and impulse [N s] of the body on the middle of the wire, which weighs nothing and is damped: m x'' = -(F + tau x' G).

    F is the static force, G the integral of EI (dkappa/dx)^2 + EA (deps/dx)^2 over the wire.
    """
    wire = Elastica(0.5 * SPAN)
    travel = np.linspace(0.0, to, points)
    force = np.empty(points)
    rate = np.empty(points)
    step = 2e-7
    for i, d in enumerate(travel):
        low, high = max(d - step, 0.0), d + step
        wire.push(low)
        weights, curvature, stretch = wire.strains()
        wire.push(high)
        _, curvature_high, stretch_high = wire.strains()
        rate[i] = np.sum(weights * (BENDING * (curvature_high - curvature)**2 + AXIAL * (stretch_high - stretch)**2)) / (high - low)**2
        force[i] = wire.push(d)
    static, viscous = CubicSpline(travel, force), CubicSpline(travel, rate)

    def acting(x, v):
        return static(x) + damping * v * viscous(x)

    def slopes(_, y):
        return [y[1], -acting(y[0], y[1]) / MASS, acting(y[0], y[1])]

    def lifts(_, y):
        return acting(y[0], y[1]) if y[1] < 0 else 1.0

    lifts.terminal = True
    run = solve_ivp(slopes, (0.0, 0.3), [0.0, SPEED, 0.0], events=lifts, rtol=1e-10, atol=1e-13, max_step=1e-4, dense_output=True)
    return {"peak_N": float(np.max(acting(*run.sol(np.linspace(0.0, run.t[-1], 20001))[:2]))), "impulse_Ns": float(run.y[2, -1]), "travel_m": float(run.y[0].max()),
            "lift_off_s": float(run.t[-1])}


def cantilever_tip(load):
    """Place of the tip (along, across) over the length under a dead load F L^2/EI across the undeformed axis: extensible, by collocation."""
    axial = AXIAL * LENGTH**2 / BENDING

    def slopes(_, y):
        stretch = 1 + load * np.sin(y[2]) / axial
        return np.vstack((stretch * np.cos(y[2]), stretch * np.sin(y[2]), y[3], -load * stretch * np.cos(y[2])))

    s = np.linspace(0.0, 1.0, 101)
    guess = np.vstack((s, 0.5 * s**2, s, 1 - s))
    result = solve_bvp(slopes, lambda a, b: np.array([a[0], a[1], a[2], b[3]]), s, guess, tol=1e-10, max_nodes=20000)
    if result.status:
        raise RuntimeError(result.message)
    return float(result.y[0, -1]), float(result.y[1, -1])


def inextensible_tip(load):
    """The same of a wire that does not stretch, by elliptic integrals with k^2 = (1 + sin(tip angle))/2 (Bisshopp and Drucker 1945)."""
    def first(k):
        return math.asin(min(1 / (k * math.sqrt(2)), 1.0))

    k = brentq(lambda k: ellipk(k**2) - ellipkinc(first(k), k**2) - math.sqrt(load), math.sqrt(0.5) + 1e-12, 1 - 1e-12, xtol=1e-15)
    return math.sqrt(2 * (2 * k**2 - 1) / load), float(1 - 2 / math.sqrt(load) * (ellipe(k**2) - ellipeinc(first(k), k**2)))


ROOT = brentq(lambda b: math.cos(b) * math.cosh(b) + 1, 1.8, 2.0, xtol=1e-14)  # of the cantilever's first mode


def cantilever_frequency():
    """First natural frequency of the cantilever of the wire's length [Hz]."""
    return ROOT**2 / (2 * math.pi * LENGTH**2) * math.sqrt(BENDING / (DENSITY * AREA))


def first_mode(s):
    """Its shape at a share of the length, 1 at the tip."""
    b = ROOT * min(max(s, 0.0), 1.0)
    ratio = (math.cosh(ROOT) + math.cos(ROOT)) / (math.sinh(ROOT) + math.sin(ROOT))
    return 0.5 * (math.cosh(b) - math.cos(b) - ratio * (math.sinh(b) - math.sin(b)))


# Twisting moment at which the straight wire between clamps, without tension, leaves its axis: 2 x EI/L with tan x = x (Greenhill) [N m]
GREENHILL = 2 * brentq(lambda x: math.sin(x) - x * math.cos(x), 4.0, 4.7, xtol=1e-14) * BENDING / LENGTH


if __name__ == "__main__":
    print("RESULT " + json.dumps({
        "push": {"force_N": push_curve(0.065, TRAVELS).tolist()},
        "impact": {"damped": impact(DAMPING), "undamped": impact(0.0)},
        "tip": {"tip": cantilever_tip(4.0)},
        "frequency": {"frequency_Hz": cantilever_frequency()},
        "twist": {"moment_Nm": GREENHILL}}))
