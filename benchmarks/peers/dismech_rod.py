"""The cases with dismech-newton on the CPU: implicit discrete elastic rods in single precision.

Clamps are placed in the middle of the clamped edge, where they are of second order.
"""

import newton
import numpy as np
import warp as wp

# The package annotates with `STRUCT | None`, which Python 3.12 evaluates; the structures of Warp have no such operator.
type(wp.struct(type("Empty", (), {"__annotations__": {}}))).__or__ = lambda self, other: object

from dismech_newton import DiSMechSolver

import peer
import references as ref
from references import AREA, BENDING, DENSITY, DIAMETER, LENGTH, POISSON, YOUNG

wp.config.quiet = True


def straight(edges, both_ends=False, shape=None, twist=0.0, **solver):
    """Solver and two states of a rod along x with uniform twist and a free or clamped tip."""
    beyond = 0.5
    spacing = LENGTH / (edges - beyond * (1 + both_ends))
    points = np.zeros((edges + 1, 3))
    points[:, 0] = (np.arange(edges + 1) - beyond) * spacing
    rod = newton.Rod(points, radius=DIAMETER / 2, youngs_modulus=YOUNG, poissons_ratio=POISSON)
    rod.compute_frames()
    builder = newton.ModelBuilder(gravity=0.0)
    DiSMechSolver.register_custom_attributes(builder)
    config = newton.ModelBuilder.ShapeConfig(density=DENSITY)
    made = DiSMechSolver.add_rod(builder, rod, cfg=config, collide=False)
    for segment in [made[0]] + [made[-1]] * both_ends:
        DiSMechSolver.fix_segment(builder, segment)
    model = builder.finalize(device="cpu")
    mass = np.full(edges + 1, DENSITY * AREA * spacing)
    mass[[0, -1]] *= 0.5
    found = model.particle_mass.numpy()
    assert np.allclose(found[found > 0], mass[found > 0], rtol=1e-3), (found, mass)
    solver = DiSMechSolver(model, self_contact=False, **solver)
    state, other = model.state(), model.state()
    if shape:
        places = state.particle_q.numpy()
        places[:, 1] = [shape(x / LENGTH) for x in points[:, 0]]
        state.particle_q.assign(places)
    if twist:
        state.dismech.edge_q.assign(twist * np.arange(edges, dtype=np.float32) / (edges - 1))
    return solver, state, other


def tip(edges=20, load=4.0, steps=40, step=0.05, iterations=40, exact=True):
    solver, state, other = straight(edges, iterations=iterations, exact=exact)
    force = np.zeros((edges + 1, 3), dtype=np.float32)
    for k in range(steps):
        force[-1, 1] = load * BENDING / LENGTH**2 * min(1.0, 4 * (k + 1) / steps)
        state.particle_f.assign(force)
        solver.step(state, other, None, None, step)
        state, other = other, state
    place = state.particle_q.numpy()[-1]
    return {"tip": [float(place[0]) / LENGTH, float(place[1]) / LENGTH]}


def frequency(edges=20, step=1e-4, until=0.2, theta=0.5, iterations=3, exact=True, amplitude=1e-2):
    """Of a small free vibration, begun in the first mode of the continuous wire."""
    solver, state, other = straight(edges, False, lambda s: amplitude * LENGTH * ref.first_mode(s), iterations=iterations, exact=exact, theta=theta)
    tips = [float(state.particle_q.numpy()[-1, 1])]
    for _ in range(round(until / step)):
        solver.step(state, other, None, None, step)
        state, other = other, state
        tips.append(float(state.particle_q.numpy()[-1, 1]))
    return {"frequency_Hz": peer.frequency(tips, step)}


def twist(edges=20, step=2e-4, until=0.2, theta=0.5, iterations=3, exact=True, amplitude=1e-3):
    """Frequencies of the straight wire, twisted evenly between its clamps."""
    squares = []
    for share in peer.SHARES:
        solver, state, other = straight(edges, True, lambda s: amplitude * LENGTH * np.sin(np.pi * min(max(s, 0.0), 1.0))**2,
                                        share * ref.GREENHILL / ref.TWISTING * LENGTH, iterations=iterations, exact=exact, theta=theta)
        middle = edges // 2
        track = [float(state.particle_q.numpy()[middle, 1])]
        for _ in range(round(until / step)):
            solver.step(state, other, None, None, step)
            state, other = other, state
            track.append(float(state.particle_q.numpy()[middle, 1]))
        squares.append(peer.frequency(track, step)**2)
    return {"critical": peer.critical(squares), "squares": squares}


def warm_up():
    tip(edges=6, steps=1)


if __name__ == "__main__":
    peer.main(globals())
