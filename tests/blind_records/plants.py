"""Machines of their own for blind records: equations of motion written out by hand, integrated by Runge and Kutta's method of the fourth order.

Nothing of the solver is used. Many cases run side by side: every number is an array with one entry a case. Dry friction and sticking are a
half step of the friction alone before and behind every step of the smooth forces (Strang): v -> sgn(v) max(0, |v| - h T/J), exact where it sticks.
Angles are in rad inside and in deg in what sensors read, as the columns of the records have them.
"""

import numpy as np

DEG = np.pi / 180.0


def integrate(rate, state, step, count, every, friction=None):
    """States (unknowns, cases) after every `every` of `count` steps, the first one included: (readings, unknowns, cases)."""
    kept = [state.copy()]
    for k in range(count):
        t = k * step
        if friction is not None:
            state = friction(t, state, 0.5 * step)
        k1 = rate(t, state)
        k2 = rate(t + 0.5 * step, state + 0.5 * step * k1)
        k3 = rate(t + 0.5 * step, state + 0.5 * step * k2)
        k4 = rate(t + step, state + step * k3)
        state = state + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        if friction is not None:
            state = friction(t + step, state, 0.5 * step)
        if (k + 1) % every == 0:
            kept.append(state.copy())
    return np.array(kept)


def dry(velocity, change):
    """The velocity after dry friction has taken `change` of it at most."""
    return np.sign(velocity) * np.maximum(0.0, np.abs(velocity) - change)


def ramped(t, begin, way, rate, ramp):
    """Angle and rate of a course at constant rate that is reached and left within `ramp`."""
    sign, way = np.sign(way), np.abs(way)
    whole = way / rate + ramp
    s = np.clip(t - begin, 0.0, whole)
    a = rate / ramp
    rest = whole - s
    angle = np.where(s < ramp, 0.5 * a * s**2, np.where(rest < ramp, way - 0.5 * a * rest**2, rate * (s - 0.5 * ramp)))
    speed = np.where(s < ramp, a * s, np.where(rest < ramp, a * rest, rate))
    return sign * angle, sign * speed


def pulse(t, begin, length, ramp):
    """1 between begin and begin + length, with straight flanks of `ramp` inside."""
    return np.clip(np.minimum((t - begin) / ramp, (begin + length - t) / ramp), 0.0, 1.0)


def swing(p, record):
    """A pendulum about y, angle from upright; inertia about its centre of mass."""
    mass, arm, g = 0.1478, 0.1476, 9.81
    whole = p["inertia"] + mass * arm**2 + 1e-6
    n = len(whole)
    start = {"first": 90.0, "second": 120.0}[record] * DEG

    def rate(_, y):
        q, v = y
        torque = mass * g * arm * np.sin(q) - p["viscous"] * v - p["viscous_asymmetry"] * np.abs(v) - p["quadratic"] * np.abs(v) * v - p["offset"]
        return np.array([v, torque / whole])

    def friction(_, y, h):
        return np.array([y[0], dry(y[1], h * p["coulomb"] / whole)])

    states = integrate(rate, np.array([np.full(n, start), np.zeros(n)]), 1e-3, 4000, 2, friction)
    return {"encoder_deg": states[:, 0] / DEG}, 2e-3


def step(p, record):
    """A joint with motor, spring and link; the motor's servo follows a course. The link gives by `flex` [rad/(N m)], a tenth of its inertia before that."""
    n = len(p["link"])
    way = {"first": 5.0, "second": -7.0}[record] * DEG
    gap = p["gap"] * DEG

    def rate(t, y):
        motor, w, link, v, outer, outer_rate = y
        target, speed = ramped(t, p["begin"], way, p["course_rate"] * DEG, 0.05)
        x = link - motor
        beyond = np.sign(x) * np.maximum(0.0, np.abs(x) - gap)
        torque = p["stiffness"] * beyond + np.where(np.abs(x) >= gap, p["damping"], 0.0) * (v - w)
        drive = p["proportional"] * (target - motor) + 150.0 * (speed - w)
        bends = p["flex"] > 0.0
        bending = ((outer - link) + 1e-3 * (outer_rate - v)) / np.maximum(p["flex"], 1e-12)
        whole = -torque / p["link"]
        return np.array([w, (drive + torque - p["viscous"] * w) / p["motor"],
                         v, np.where(bends, (bending - torque) / (0.1 * p["link"]), whole),
                         outer_rate, np.where(bends, -bending / (0.9 * p["link"]), whole)])

    def friction(_, y, h):
        return np.array([y[0], dry(y[1], h * p["coulomb"] / p["motor"]), *y[2:]])

    states = integrate(rate, np.zeros((6, n)), 2e-4, 10000, 5, friction)
    return {"motor_deg": states[:, 0] / DEG, "link_deg": states[:, 2] / DEG}, 1e-3


def drive_torque(record):
    """A sum of sines, straight between its points: times [s] and torque [N m]."""
    t = np.arange(0.0, 3.0001, 0.06)
    if record == "first":
        torque = 3.0 * np.sin(2 * np.pi * 0.5 * t) + 2.0 * np.sin(2 * np.pi * 1.25 * t + 1.0) + 1.5 * np.sin(2 * np.pi * 2.75 * t + 2.0)
    else:
        torque = 2.5 * np.sin(2 * np.pi * 0.75 * t + 0.5) + 2.5 * np.sin(2 * np.pi * 1.75 * t) + 1.0 * np.sin(2 * np.pi * 3.25 * t + 1.0)
    return t, torque


def drive(p, record):
    """A drive that runs a recorded torque; its screw is stiff, so what turns is one inertia."""
    whole = p["motor"] + 0.5
    n = len(whole)
    times, torques = drive_torque(record)

    def rate(t, y):
        _, w = y
        torque = np.interp(t, times, torques) - p["viscous"] * w - p["viscous_asymmetry"] * np.abs(w) - p["quadratic"] * np.abs(w) * w - p["offset"]
        return np.array([w, torque / whole])

    # A motor that sticks stays there while no force on it is larger than the friction.
    def friction(t, y, h):
        return np.array([y[0], dry(y[1], h * p["coulomb"] / whole)])

    states = integrate(rate, np.zeros((2, n)), 1e-3, 3000, 2, friction)
    return {"speed_deg_s": states[:, 1] / DEG}, 2e-3


def payload(p, record):
    """A body on a bushing with a pulse on it: along x and about z. `extra` of its mass hangs on a second spring of its own; its centre of mass is `aside`
    [m] along y from where bushing and pulse act."""
    n = len(p["mass"])
    force = {"first": 40.0, "second": -25.0}[record]
    moment = {"first": 5.0, "second": 8.0}[record]
    second = 5.0 * p["extra"]
    spring = second * (2.0 * np.pi * 2.1)**2

    def rate(t, y):
        x, v, a, w, x2, v2, across, across_rate = y  # of the centre of mass
        rx, ry = -p["aside"] * np.sin(a), p["aside"] * np.cos(a)  # from where the forces act
        place, place_rate = x - rx, v + w * ry
        share = pulse(t, 0.1, 0.3, 0.05)
        between = spring * (x2 - place) + 0.02 * np.sqrt(np.maximum(spring * second, 0.0)) * (v2 - place_rate)
        fx = force * share - p["translational"] * place - p["translational_damping"] * place_rate + between
        fy = -p["translational"] * (across - ry) - p["translational_damping"] * (across_rate - w * rx)
        turning = moment * share - p["rotational"] * a - p["rotational_damping"] * w - (rx * fy - ry * fx)
        return np.array([v, fx / (p["mass"] - second), w, turning / p["inertia"], v2,
                         np.where(second > 0.0, -between / np.maximum(second, 1e-12), 0.0), across_rate, fy / (p["mass"] - second)])

    start = np.zeros((8, n))
    start[1] = p["start_velocity"] - p["start_spin"] * p["aside"]
    start[3] = p["start_spin"]
    start[6] = p["aside"]
    states = integrate(rate, start, 1e-3, 3000, 2)
    return {"place_x_mm": (states[:, 0] + p["aside"] * np.sin(states[:, 2])) * 1e3, "gyro_z_deg_s": states[:, 3] / DEG}, 2e-3


def flight(p, record):
    """A free body with pulses of its thrusters, by Euler's equations about principal axes. `slosh` [kg m^2] turns about x inside, held by a spring and
    a dashpot; a thruster leaks by the moment `leak` about y that fades in `6 s`."""
    n = len(p["ix"])
    spin = {"first": [1.0, -0.6, 2.0], "second": [-1.5, 1.0, 1.2]}[record]
    pulses = {"first": [(0, 2.0, 1.2), (1, 6.0, -1.5), (2, 10.0, 1.0), (0, 13.0, -1.0)],
              "second": [(1, 2.0, 1.4), (2, 5.0, -1.2), (0, 9.0, 1.1), (1, 14.0, -1.1)]}[record]
    slosh = np.maximum(p["slosh"], 1e-9)
    omega = 2.0 * np.pi * 0.35
    axes = np.array([p["ix"], p["iy"], p["iz"]])

    def rate(t, y):
        w, inner, inner_rate = y[:3], y[3], y[4]
        moment = np.zeros((3, n))
        for axis, begin, size in pulses:
            moment[axis] += size * pulse(t, begin, 1.0, 0.1)
        moment[1] += p["leak"] * np.exp(-t / 6.0)
        # The inner rotor about x: its angle to the body and its rate beside the body's.
        between = slosh * (omega**2 * inner + 0.1 * omega * inner_rate)
        moment[0] += between
        h = axes * w
        turning = np.array([w[1] * h[2] - w[2] * h[1], w[2] * h[0] - w[0] * h[2], w[0] * h[1] - w[1] * h[0]])
        dw = (moment - turning) / axes
        return np.array([dw[0], dw[1], dw[2], inner_rate, -between / slosh - dw[0]])

    start = np.zeros((5, n))
    start[:3] = np.array(spin)[:, None] * DEG
    start[0] += p["spin_x"]
    states = integrate(rate, start, 0.02, 1000, 1)
    return {f"gyro_{axis}_deg_s": states[:, k] / DEG for k, axis in enumerate("xyz")}, 0.02


def read_off(fine, fine_step, interval, sensors):
    """What sensors tell of a fine signal (readings, cases): after a low-pass filter of the first order, later, times a gain, with zero and drift."""
    count = len(fine)
    times = fine_step * np.arange(count)
    lag = sensors["lag"]
    if np.any(lag > 0.0):
        filtered = fine.copy()
        keep = np.exp(-fine_step / np.maximum(lag, 1e-12))
        for k in range(1, count):
            slope = (fine[k] - fine[k - 1]) / fine_step
            filtered[k] = fine[k] - lag * slope + (filtered[k - 1] - fine[k - 1] + lag * slope) * keep
        fine = np.where(lag > 0.0, filtered, fine)
    every = round(interval / fine_step)
    told = fine[::every].copy()
    at = times[::every]
    for c in np.nonzero(sensors["delay"])[0]:
        # A parabola through three neighbours: between readings a straight line would err by more than the noise.
        s = np.clip(at - sensors["delay"][c], 0.0, times[-1]) / fine_step
        i = np.clip(np.round(s).astype(int), 1, count - 2)
        u = s - i
        a, b, d = fine[i - 1, c], fine[i, c], fine[i + 1, c]
        told[:, c] = b + 0.5 * u * (d - a) + 0.5 * u * u * (a - 2.0 * b + d)
    return at, sensors["gain"] * told + sensors["bias"] + sensors["drift"] * at[:, None]
