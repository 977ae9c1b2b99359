"""The cases with Newton on the CPU: a rod of capsules and joints, solved by VBD in single precision.

finalize() gives every thin capsule at least 1e-6 kg m2; mass and inertia of the material are set afterwards.
"""

import newton
import numpy as np
import warp as wp

import peer
import references as ref
from references import AREA, BENDING, DENSITY, DIAMETER, LENGTH, POISSON, YOUNG

wp.config.quiet = True


class Cantilever:
    """Segments along x. The first one is fixed with its middle at the clamp, where the chain of hinges is of second order."""

    def __init__(self, segments, iterations=10, defaults=False, bend_damping=0.0):
        beyond = 1.0 if defaults else 0.5
        self.spacing = LENGTH / (segments - beyond)
        rod = newton.Rod.create_straight((-beyond * self.spacing, 0.0, 0.0), (1.0, 0.0, 0.0), segments * self.spacing, segment_count=segments,
                                         radius=DIAMETER / 2, youngs_modulus=YOUNG, poissons_ratio=POISSON)
        builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
        config = newton.ModelBuilder.ShapeConfig(density=DENSITY, has_shape_collision=False)
        self.bodies, _ = builder.add_rod(rod=rod, cfg=config, bend_damping=bend_damping or None)
        builder.color()
        self.model = builder.finalize(device="cpu")
        if not defaults:
            mass = DENSITY * AREA * self.spacing
            across, along = mass * self.spacing**2 / 12 + mass * DIAMETER**2 / 16, mass * DIAMETER**2 / 8
            inertia = np.diag([across, across, along]).astype(np.float32)
            count = len(self.bodies)
            self.model.body_mass.assign(np.full(count, mass, dtype=np.float32))
            self.model.body_inv_mass.assign(np.full(count, 1 / mass, dtype=np.float32))
            self.model.body_inertia.assign(np.broadcast_to(inertia, (count, 3, 3)).copy())
            self.model.body_inv_inertia.assign(np.broadcast_to(np.linalg.inv(inertia), (count, 3, 3)).copy())
        masses = self.model.body_inv_mass.numpy()
        masses[0] = 0.0
        self.model.body_inv_mass.assign(masses)
        inverse = self.model.body_inv_inertia.numpy()
        inverse[0] = 0.0
        self.model.body_inv_inertia.assign(inverse)
        self.solver = newton.solvers.SolverVBD(self.model, iterations=iterations)
        self.state, self.other = self.model.state(), self.model.state()
        self.control = self.model.control()

    def step(self, step, load=0.0):
        self.state.clear_forces()
        if load:  # at the far end of the last segment
            last = self.state.body_q.numpy()[-1]
            arm = self.tip() - last[:3]
            forces = self.state.body_f.numpy()
            force = np.array([0.0, load, 0.0])
            forces[-1, :3], forces[-1, 3:] = force, np.cross(arm, force)
            self.state.body_f.assign(forces)
        self.solver.step(self.state, self.other, self.control, None, step)
        self.state, self.other = self.other, self.state

    def tip(self):
        q = self.state.body_q.numpy()[-1].astype(float)
        u, w = q[3:6], q[6]
        z = np.array([0.0, 0.0, 1.0])
        axis = z + 2 * w * np.cross(u, z) + 2 * np.cross(u, np.cross(u, z))
        return q[:3] + 0.5 * self.spacing * axis


def tip(segments=20, load=4.0, step=1e-3, until=0.5, iterations=100, bend_damping=None, defaults=False):
    """Damped towards rest by the joints' dampers."""
    damping = 0.0 if defaults else 0.05 * BENDING / (LENGTH / segments) if bend_damping is None else bend_damping
    rod = Cantilever(segments, 10 if defaults else iterations, defaults, damping)
    for k in range(round(until / step)):
        rod.step(step, load * BENDING / LENGTH**2)
    place = rod.tip()
    return {"tip": [float(place[0]) / LENGTH, float(place[1]) / LENGTH]}


def frequency(segments=20, step=1e-4, until=0.2, iterations=100, defaults=False):
    """Of a small free vibration, begun in the first mode of the continuous wire."""
    rod = Cantilever(segments, 10 if defaults else iterations, defaults)
    places = rod.state.body_q.numpy()
    middles = places[:, 0].astype(float)
    amplitude = 0.02 * LENGTH
    for k, x in enumerate(middles):
        ends = [amplitude * ref.first_mode((x + d) / LENGTH) for d in (-0.5 * rod.spacing, 0.5 * rod.spacing)]
        places[k, 1] = 0.5 * sum(ends) if k else 0.0
        angle = np.arctan2(ends[1] - ends[0], rod.spacing) if k else 0.0
        # turned about z, then the frame that the straight segment has
        half = np.array([0.0, 0.0, np.sin(angle / 2), np.cos(angle / 2)])
        a, b = half, places[k, 3:7].astype(float)
        places[k, 3:6] = a[3] * b[:3] + b[3] * a[:3] + np.cross(a[:3], b[:3])
        places[k, 6] = a[3] * b[3] - a[:3] @ b[:3]
    rod.state.body_q.assign(places)
    tips = [float(rod.tip()[1])]
    for _ in range(round(until / step)):
        rod.step(step)
        tips.append(float(rod.tip()[1]))
    return {"frequency_Hz": peer.frequency(tips, step), "last_m": tips[-1]}


def warm_up():
    tip(segments=5, until=2e-3)


if __name__ == "__main__":
    peer.main(globals())
