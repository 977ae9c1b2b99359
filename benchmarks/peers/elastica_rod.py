"""The cases with PyElastica: a Cosserat rod in explicit steps (position Verlet), damped to rest in the static cases.

A clamp fixes the first node and the frame of the first element. It is placed in the middle of that element, where it is of second order.
Statics use a larger rotational inertia, so that it does not limit the step; it does not affect the equilibrium.
"""

import math

import elastica as ea
import numpy as np

import peer
import references as ref
from references import AREA, BENDING, DENSITY, DIAMETER, LENGTH, MASS, POISSON, PROBE, SPAN, SPEED, TRAVELS, YOUNG


class Simulator(ea.BaseSystemCollection, ea.Constraints, ea.Forcing, ea.Damping, ea.Contact):
    pass


class Held(ea.ConstraintBase):
    """Nodes and elements that stay where they were put, and a body that moves as its place is set."""

    def __init__(self, nodes=(), elements=(), **kwargs):
        super().__init__(**kwargs)
        self.nodes, self.elements = list(nodes), list(elements)

    def constrain_values(self, system, time):
        pass

    def constrain_rates(self, system, time):
        system.velocity_collection[:, self.nodes] = 0.0
        system.omega_collection[:, self.elements] = 0.0


class Guided(ea.ConstraintBase):
    """A body that moves along y alone."""

    def constrain_values(self, system, time):
        pass

    def constrain_rates(self, system, time):
        system.velocity_collection[0] = 0.0
        system.velocity_collection[2] = 0.0
        system.omega_collection[:] = 0.0


def stable_step(spacing, turning=1.0, share=0.5, defaults=False):
    """Share of the longest step that follows the waves along an element and the shear of a section."""
    if defaults:
        return 0.01 * spacing  # in seconds for metres: the rule in the program's examples
    along = spacing / math.sqrt(YOUNG / DENSITY)
    shear = 2.0 / math.sqrt(YOUNG / (2 * (1 + POISSON)) / DENSITY * 16 / DIAMETER**2 / turning)
    return share * min(along, shear)


class Rod:
    def __init__(self, elements, both_ends, middle=True, turning=1.0):
        beyond = 0.5 if middle else 0.0
        self.spacing = LENGTH / (elements - beyond * (1 + both_ends))
        self.beyond = beyond * self.spacing
        self.simulator = Simulator()
        self.rod = ea.CosseratRod.straight_rod(
            elements, np.array([-self.beyond, 0.0, 0.0]), np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]), elements * self.spacing,
            DIAMETER / 2, DENSITY, youngs_modulus=YOUNG, shear_modulus=YOUNG / (2 * (1 + POISSON)))
        self.simulator.append(self.rod)
        self.rod.mass_second_moment_of_inertia *= turning
        self.rod.inv_mass_second_moment_of_inertia /= turning
        ends = {"nodes": [0, -1] if both_ends else [0], "elements": [0, -1] if both_ends else [0]}
        self.simulator.constrain(self.rod).using(Held, **ends)
        self.stepper = ea.PositionVerlet()
        self.time = 0.0

    def buckle(self):
        """Moves the right clamp to the span and the nodes to a shape of the right length."""
        share, x, y, _ = ref.buckled()
        n = self.rod.n_elems
        s = self.spacing * np.arange(n + 1) - self.beyond
        inside = np.clip(s, 0.0, LENGTH)
        places = self.rod.position_collection
        places[0] = np.interp(inside / LENGTH, share, x) + (s - inside)
        places[1] = np.interp(inside / LENGTH, share, y)
        edges = np.diff(places, axis=1)
        tangents = edges / np.linalg.norm(edges, axis=0)
        frames = self.rod.director_collection
        frames[2] = tangents
        frames[1] = np.array([0.0, 0.0, 1.0])[:, None]
        frames[0] = np.cross(frames[1], frames[2], axis=0)
        if frames[0, 1, 0] < 0:
            frames[0] *= -1.0
            frames[1] *= -1.0

    def run(self, duration, step):
        for _ in range(max(1, round(duration / step))):
            self.time = self.stepper.step(self.simulator, self.time, step)


def cylinder(wire, position, mass, stiffness, damper):
    """A cylinder across the plane, below the wire; it does not touch until it is moved."""
    radius, length = PROBE - DIAMETER / 2, 0.04
    body = ea.Cylinder(np.array([position, -0.1, -length / 2]), np.array([0.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0]), length, radius,
                       mass / (math.pi * radius**2 * length))
    wire.simulator.append(body)
    wire.simulator.detect_contact_between(wire.rod, body).using(ea.RodCylinderContact, k=stiffness, nu=damper)
    return body


def contact_step(wire, turning, share, stiffness, defaults):
    """Step that follows the contact's spring on the mass of a node, too."""
    step = stable_step(wire.spacing, turning, share, defaults)
    return step if defaults else min(step, share * 2.0 / math.sqrt(2 * stiffness / (DENSITY * AREA * wire.spacing)))


def push(elements=40, share=0.5, hold=0.012, rate=2500.0, stiffness=1e8, damper=50.0, defaults=False, position=0.065, travels=TRAVELS):
    turning = 1.0 if defaults else 400.0
    wire = Rod(elements, True, not defaults, turning)
    step = contact_step(wire, turning, share, stiffness, defaults)
    body = cylinder(wire, position, 1.0, stiffness, damper)
    wire.simulator.constrain(body).using(Held, nodes=[0], elements=[0])
    wire.simulator.dampen(wire.rod).using(ea.AnalyticalLinearDamper, uniform_damping_constant=rate, time_step=step)
    wire.simulator.finalize()
    wire.buckle()
    wire.run(hold, step)
    level = ref.chain_touch(wire.rod.position_collection.T, position)
    at, forces = 0.0, []
    for travel in travels:
        chunks = 40
        for c in range(chunks):
            body.position_collection[1, 0] = level + at + (travel - at) * (c + 1) / chunks
            wire.run(0.002 / chunks, step)
        at = travel
        wire.run(hold, step)
        samples = []
        for _ in range(200):
            wire.run(2e-6, step)
            samples.append(reaction(wire, body, stiffness))
        forces.append(float(np.mean(samples)))
    return {"force_N": forces, "step_s": step, "first_touch_m": level}


def reaction(wire, body, stiffness):
    """Force on the held cylinder across the chord, by the contact's own law."""
    wire.rod.external_forces[:] = 0.0
    body.external_forces[:] = 0.0
    ea.RodCylinderContact(k=stiffness, nu=0.0).apply_contact(wire.rod, body)
    force = abs(float(body.external_forces[1, 0]))
    wire.rod.external_forces[:] = 0.0
    body.external_forces[:] = 0.0
    return force


def impact(elements=40, share=0.5, stiffness=1e8, damper=0.0, defaults=False, until=0.3):
    wire = Rod(elements, True, not defaults)
    step = contact_step(wire, 1.0, share, stiffness, defaults)
    body = cylinder(wire, 0.5 * SPAN, MASS, stiffness, damper)
    wire.simulator.constrain(body).using(Guided)
    wire.simulator.dampen(wire.rod).using(Switched, rate=2500.0, time_step=step)
    wire.simulator.finalize()
    wire.buckle()
    Switched.on = True
    wire.run(0.012, step)
    Switched.on = False
    wire.rod.velocity_collection[:] = 0.0
    wire.rod.omega_collection[:] = 0.0
    body.position_collection[1, 0] = ref.chain_touch(wire.rod.position_collection.T, 0.5 * SPAN) - 1e-4
    body.velocity_collection[1, 0] = SPEED
    speeds = [SPEED]
    window = max(1, round(1e-4 / step))
    for _ in range(round(until / step / window)):
        wire.run(window * step, step)
        speeds.append(float(body.velocity_collection[1, 0]))
    return {"peak_N": peer.peak(speeds, window * step, MASS), "impulse_Ns": MASS * (SPEED - speeds[-1]), "damped": False, "step_s": step}


class Switched(ea.DamperBase):
    """Drag in proportion to mass while it is on."""

    on = False

    def __init__(self, rate, time_step, **kwargs):
        super().__init__(**kwargs)
        self.factor = math.exp(-rate * time_step)

    def dampen_rates(self, system, time):
        if Switched.on:
            system.velocity_collection *= self.factor
            system.omega_collection *= self.factor


def tip(elements=20, share=0.5, load=4.0, rate=400.0, until=0.15, defaults=False):
    turning = 1.0 if defaults else 400.0
    wire = Rod(elements, False, not defaults, turning)
    step = stable_step(wire.spacing, turning, share, defaults)
    wire.simulator.add_forcing_to(wire.rod).using(ea.EndpointForces, np.zeros(3), np.array([0.0, load * BENDING / LENGTH**2, 0.0]), ramp_up_time=0.01)
    wire.simulator.dampen(wire.rod).using(ea.AnalyticalLinearDamper, uniform_damping_constant=rate, time_step=step)
    wire.simulator.finalize()
    wire.run(until, step)
    place = wire.rod.position_collection[:, -1]
    return {"tip": [float(place[0]) / LENGTH, float(place[1]) / LENGTH], "step_s": step}


def frequency(elements=20, share=0.5, until=0.2, defaults=False):
    """Of a small free vibration, begun in the first mode of the continuous wire."""
    wire = Rod(elements, False, not defaults)
    step = stable_step(wire.spacing, 1.0, share, defaults)
    wire.simulator.finalize()
    places = wire.rod.position_collection
    places[1] = [1e-4 * LENGTH * ref.first_mode(x / LENGTH) for x in places[0]]
    edges = np.diff(places, axis=1)
    tangents = edges / np.linalg.norm(edges, axis=0)
    frames = wire.rod.director_collection
    third = frames[1].copy()
    frames[2, :, 1:] = tangents[:, 1:]
    frames[0] = np.cross(third, frames[2], axis=0)
    frames[1] = np.cross(frames[2], frames[0], axis=0)
    window = max(1, round(1e-4 / step))
    tips = [float(places[1, -1])]
    for _ in range(round(until / step / window)):
        wire.run(window * step, step)
        tips.append(float(wire.rod.position_collection[1, -1]))
    return {"frequency_Hz": peer.frequency(tips, window * step), "step_s": step}


def twist(elements=20, share=0.5, until=0.2):
    """Frequencies of the straight wire, twisted between its clamps by turned frames; the enlarged rotational inertia leaves where they vanish."""
    turning = 100.0
    squares = []
    for part in peer.SHARES:
        wire = Rod(elements, True, True, turning)
        step = stable_step(wire.spacing, turning, share)
        wire.simulator.finalize()
        angles = part * ref.GREENHILL / ref.TWISTING * LENGTH * np.arange(elements) / (elements - 1)
        places = wire.rod.position_collection
        inside = np.clip(places[0] / LENGTH, 0.0, 1.0)
        places[1] = 1e-5 * LENGTH * np.sin(np.pi * inside) ** 2
        edges = np.diff(places, axis=1)
        tangents = edges / np.linalg.norm(edges, axis=0)
        second = np.cross(tangents, np.array([0.0, 0.0, 1.0])[:, None], axis=0) * -1.0
        third = np.cross(tangents, second, axis=0)
        frames = wire.rod.director_collection
        frames[2] = tangents
        frames[0] = np.cos(angles) * second + np.sin(angles) * third
        frames[1] = np.cross(frames[2], frames[0], axis=0)
        middle = elements // 2
        window = max(1, round(2e-4 / step))
        track = [float(places[1, middle])]
        for _ in range(round(until / step / window)):
            wire.run(window * step, step)
            track.append(float(wire.rod.position_collection[1, middle]))
        squares.append(peer.frequency(track, window * step)**2)
    return {"critical": peer.critical(squares)}


def warm_up():
    tip(elements=5, until=1e-4)


if __name__ == "__main__":
    peer.main(globals())
