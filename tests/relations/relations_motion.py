"""What must hold between motions: of bodies, wires, arms and snares alike. Numbers are equal within what a tenth of the tolerances changes."""

import csv
import math
import re

import numpy

from cases import Broken, Undecided, column, different, same_numbers

# [solver] of every motion that is compared, at its defaults.
DEFAULTS = {
    "relative_tolerance": 1e-6,
    "position_tolerance_m": 3e-7,
    "velocity_tolerance_m_s": 3e-3,
    "quasi_static_velocity_tolerance_m_s": 1e-4,
    "body_position_tolerance_m": 1e-8,
    "body_velocity_tolerance_m_s": 1e-6,
    "body_angle_tolerance_rad": 1e-7,
    "body_spin_tolerance_rad_s": 1e-5,
}
FLOOR = {"_mm": 3e-4, "_m_s": 3e-5, "_deg": 3e-4, "_rad_s": 3e-4, "_J": 1e-7, "_N": 1e-3, "_Nm": 1e-4}  # some thirty tolerances
LISTS = ("frames", "bodies", "shapes", "snares", "wires", "contacts", "bushings", "loads", "sensors", "welds")
SKIP = re.compile(r"(gap_mm|arc_mm|points|integrator_J| q[wxyz])$")


def group(name):
    return re.sub(r"[xyz](_(?:mm|m_s|rad_s|N|Nm|deg))$", r"\1", name)


def floor(name):
    return next((v for k, v in FLOOR.items() if name.endswith(k)), 1e-6)


def tight(case, share=0.1):
    other = case.changed()
    solver = other.main.setdefault("solver", {})
    for name, value in DEFAULTS.items():
        solver[name] = (
            max(1e-10, solver.get(name, value) * share) if name == "relative_tolerance" else solver.get(name, value) * share
        )
    return other


def errors(case, run):
    """By column what a tenth of the tolerances changes, the largest so far of all axes."""
    one, fine = run(case), run(tight(case))
    if len(one.rows) != len(fine.rows):
        raise Undecided("ends at another time")
    found = {}
    for name in one.names:
        e = numpy.abs(one[name] - fine[name])
        found[group(name)] = numpy.maximum(found.get(group(name), 0.0), numpy.maximum.accumulate(numpy.nan_to_num(e)))
    run.asked = run.asked[:0]
    return found


def size(run, name):
    return max(numpy.nanmax(numpy.abs(run[n])) for n in run.names if group(n) == group(name))


def allowed(run, name, found, share=10.0):
    """Where the error is a tenth of the number itself, it says nothing."""
    e = found[group(name)]
    largest = size(run, name)
    limit = share * e + floor(name) + 1e-5 * largest
    if name.endswith(("_N", "_J")):  # waves: the error of an instant stands for all
        limit = share * numpy.full_like(e, e[-1]) + floor(name) + 1e-3 * largest
    limit[limit > 0.3 * largest + floor(name)] = math.inf
    return limit


def columns(run):
    return [n for n in run.names if n != "time_s" and not SKIP.search(n)]


def alike(case, other, run, expected=None, rows=slice(None), names=None, only=None):
    """Every column of the other motion is what is expected of the first one; a difference must stay at a tenth of the tolerances."""
    found = errors(case, run)
    try:
        hold(run(case), run(other), found, expected, rows, names, only)
    except Broken:
        # The other one may err more, as at another order: its own error counts, too. A difference that stays beyond is none of the tolerance.
        theirs = errors(other, run)
        both = {k: numpy.maximum(e, theirs[k]) if k in theirs and len(theirs[k]) == len(e) else e for k, e in found.items()}
        hold(run(tight(case)), run(tight(other)), both, expected, rows, names, only)
        found = both
        run.asked = []
        hold(run(case), run(other), found, expected, rows, names, only)


def hold(one, two, found, expected, rows, names, only):
    for name in columns(one):
        if only and not only(name):
            continue
        there = names(name) if names else name
        if there not in two.columns:
            raise Broken(name, f"no column {there}")
        want = expected(one, name) if expected else one[name]
        if want is None:
            continue
        a, b = want, two[there][rows]
        n = min(len(a), len(b))
        if abs(len(a) - len(b)) > 1:
            raise Broken("rows", f"{len(a)} and {len(b)} lines")
        different(name, a[:n], b[:n], allowed(one, name, found)[:n])


def twice_the_output_rate(case, run):
    other = case.changed()
    other.main["output_interval_s"] *= 0.5
    one, two = run(case), run(other)
    for name in columns(one):
        a, b = one[name], two[name][::2]
        different(name, a, b[: len(a)], 1e-9 * size(one, name) + 1e-3 * floor(name))


def split_by_checkpoints(case, run):
    other = case.changed()
    other.main.setdefault("output", {})["checkpoint_interval_s"] = case.main["duration_s"] / 3.0
    alike(case, other, run)


def order_of_lists(case, run):
    other = case.changed()
    for name in LISTS:
        if name in other.main:
            other.main[name].reverse()
    alike(case, other, run)


def renamed(main):
    """Other names of everything, in another order of the alphabet."""
    names = [t["name"] for key in LISTS for t in main.get(key, []) if "name" in t]
    new = {n: f"z{len(names) - k}_{n}" for k, n in enumerate(names)}

    def change(value, at=""):
        if isinstance(value, dict):
            return {k: change(v, k) for k, v in value.items()}
        if isinstance(value, list):
            return [change(v, at) for v in value]
        if isinstance(value, str) and at not in ("title", "file", "kind", "model", "pose"):
            return " on ".join(
                "::".join(new.get(w, w) if k == 0 else w for k, w in enumerate(part.split("::"))) for part in value.split(" on ")
            )
        return value

    return change(main), new


def names_of_things(case, run):
    other = case.changed()
    other.main, new = renamed(case.main)
    one, two = run(case), run(other)

    def there(name):
        words = re.split(r"( on |::| )", name)
        return "".join(new.get(w, w) for w in words)

    for name in columns(one):
        if there(name) not in two.columns:
            raise Broken(name, f"no column {there(name)}")
        different(name, one[name], two[there(name)], 0.0)


def far_away(case):
    return [50000.0, 30000.0, -40000.0]


def an_idle_body(case, run):
    other = case.changed()
    other.main.setdefault("bodies", []).append(
        {
            "name": "idle",
            "mass_kg": 3.0,
            "inertia_kg_m2": [0.1, 0.2, 0.15],
            "position_mm": far_away(case),
            "spin_rad_s": [0.3, 0.0, 0.1],
        }
    )
    alike(case, other, run, only=lambda n: not n.endswith("_J"))


def an_idle_wire(case, run):
    if not case.main.get("wires"):
        raise Undecided("no wires")
    x, y, z = far_away(case)
    other = case.changed()
    other.main["wires"].append(
        {
            "name": "idle",
            "construction": "solid",
            "diameter_mm": 1.0,
            "length_mm": 151.0,
            "youngs_modulus_GPa": 200.0,
            "poisson_ratio": 0.3,
            "density_kg_m3": 8000.0,
            "from_mm": [x, y, z],
            "to_mm": [x + 150.0, y, z],
            "elements": 8,
            "model": "quasi_static" if case.main["wires"][0].get("model") != "full" else "full",
        }
    )
    if case.main["wires"][0].get("model") in ("stretched", "quadratic"):
        raise Undecided("a wire beside laws has another order")
    alike(case, other, run, only=lambda n: not n.endswith("_J") and "idle" not in n)


def rotation(vector):
    """Matrix of a rotation vector [deg]."""
    v = numpy.radians(vector)
    angle = numpy.linalg.norm(v)
    if angle == 0.0:
        return numpy.eye(3)
    x, y, z = v / angle
    k = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return numpy.eye(3) + math.sin(angle) * k + (1.0 - math.cos(angle)) * k @ k


def moved(case, turn, shift, carrier=None):
    """All that stands on the world stands on a frame of it; forces in the world's axes turn with it."""
    other = case.changed()
    main = other.main
    matrix = rotation(turn)

    def on(table, name):
        if table.get(name, "world") == "world":
            table[name] = "moved"

    for key in ("frames", "bodies", "snares", "shapes"):
        for table in main.get(key, []):
            if not (key == "shapes" and "body" in table):
                on(table, "frame")
    for w in main.get("wires", []):
        on(w, "from_frame")
        on(w, "to_frame")
    for b in main.get("bushings", []):
        for name in ("frame", "other_frame"):
            if b.get(name) == "world":
                b[name] = "moved"
    for arm in main.get("arms", []):
        if "tip_frame" not in arm and "reach_frame" not in arm:
            on(arm, "base_frame")
        elif arm.get("tip_frame") == "world":
            arm["tip_frame"] = "moved"
    for b in main.get("bodies", []):
        if "force_N" in b:
            b["force_N"] = [float(f) for f in matrix @ b["force_N"]]
    for load in main.get("loads", []):
        if load.get("axes", "frame") == "world":
            for name in ("force_N", "moment_Nm"):
                if name in load:
                    load[name] = [float(f) for f in matrix @ load[name]]
    if "gravity" in main:
        main["gravity"]["vector_m_s2"] = [float(g) for g in matrix @ main["gravity"]["vector_m_s2"]]
    if carrier is None:
        main.setdefault("frames", []).insert(0, {"name": "moved", "position_mm": shift, "rotation_deg": turn})
    else:
        main.setdefault("bodies", []).insert(
            0, {"name": "moved", "driven": True, "position_mm": shift, "rotation_deg": turn, "velocity_m_s": carrier}
        )
    return other


WORLD = re.compile(r"^(.*) ([xyz]_mm|v[xyz]_m_s|f[xyz]_N|m[xyz]_Nm)$")


def triple(run, name):
    """The three columns of a vector in the world's axes, its place among them and its kind; None of anything else."""
    found = WORLD.match(name)
    if not found:
        return None
    what, axis = found.groups()
    letter = axis[0] if axis.endswith("_mm") else axis[1]
    vector = numpy.array(
        [run[f"{what} " + axis.replace(letter, c, 1) if axis.endswith("_mm") else f"{what} {axis[0]}{c}{axis[2:]}"] for c in "xyz"]
    )
    return vector, "xyz".index(letter), "place" if axis.endswith("_mm") else "velocity" if axis.endswith("_m_s") else "force"


def seen(matrix, shift=(0.0, 0.0, 0.0), velocity=(0.0, 0.0, 0.0), acceleration=(0.0, 0.0, 0.0)):
    """Columns of a motion as another observer has them."""

    def expected(run, name):
        vector = triple(run, name)
        if vector is None:
            return run[name]
        values, k, kind = vector
        t = run["time_s"]
        new = matrix @ values
        if kind == "place":
            new = (
                new
                + numpy.outer(shift, numpy.ones_like(t))
                + 1e3 * (numpy.outer(velocity, t) + 0.5 * numpy.outer(acceleration, t**2))
            )
        elif kind == "velocity":
            new = new + numpy.outer(velocity, numpy.ones_like(t)) + numpy.outer(acceleration, t)
        return new[k]

    return expected


def world_turned(case, run):
    turn = [40.0, -70.0, 25.0]
    alike(case, moved(case, turn, [0.0, 0.0, 0.0]), run, expected=seen(rotation(turn)))


def world_shifted(case, run):
    shift = [1300.0, -700.0, 450.0]
    alike(case, moved(case, [0.0, 0.0, 0.0], shift), run, expected=seen(numpy.eye(3), shift), only=lambda n: n != "potential_J")


def plain(case, *keys):
    """Whether nothing drags against the world or has a course of its own."""
    m = case.main
    if (
        any(k in m for k in keys)
        or m.get("damping", {}).get("mass_rate_1_s")
        or any(b.get("drag_Ns_m") for b in m.get("bodies", []))
    ):
        raise Undecided("something holds to the world")


def on_a_standing_carrier(case, run):
    """A driven body that stands still is the world."""
    plain(case, "arms", "snares")
    if any(k.startswith("strand_extra") for w in case.main.get("wires", []) for k in w):
        raise Undecided("not on moving mounts")
    fixed = tuple(
        f"{s['name']} " for s in case.main.get("shapes", []) if s.get("frame", "world") == "world"
    )  # small bodies of the world have columns
    alike(
        case,
        moved(case, [0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
        run,
        only=lambda n: not n.startswith(fixed) or " on " in n,
    )


def galilei(case, run):
    plain(case, "arms", "snares")
    if any(k.startswith("strand_extra") for w in case.main.get("wires", []) for k in w):
        raise Undecided("not on moving mounts")
    speed = [0.7, -0.4, 0.2]
    other = moved(case, [0.0, 0.0, 0.0], [0.0, 0.0, 0.0], speed)
    base = moved(case, [0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0])
    for b in other.main["bodies"][1:]:
        if b.get("frame", "moved") == "moved":
            b["velocity_m_s"] = [v + s for v, s in zip(b.get("velocity_m_s", [0.0] * 3), speed)]
    alike(
        base,
        other,
        run,
        expected=seen(numpy.eye(3), velocity=speed),
        only=lambda n: n not in ("kinetic_J", "potential_J", "work_J"),
    )


def gravity_is_acceleration(case, run):
    """What falls freely together does not see that it falls."""
    m = case.main
    plain(case, "arms", "snares")
    if (
        not m.get("bodies")
        or any(b.get("driven") for b in m["bodies"])
        or any(
            t.get(n, "world") == "world"
            for key, n in (("shapes", "frame"), ("bushings", "frame"), ("wires", "from_frame"), ("wires", "to_frame"))
            for t in m.get(key, [])
        )
    ):
        raise Undecided("something stands on the world")
    other, base = case.changed(), case.changed()
    base.main.pop("gravity", None)
    pull = [3.0, -9.81, 5.0]
    other.main["gravity"] = {"vector_m_s2": pull}
    alike(
        base,
        other,
        run,
        expected=seen(numpy.eye(3), acceleration=pull),
        only=lambda n: n not in ("kinetic_J", "potential_J", "work_J"),
    )


def mirrored(case, run):
    """The world in the mirror x -> -x: places, velocities and forces turn their x, axial vectors the other two."""
    if any(k in case.main for k in ("arms", "snares", "frames")):
        raise Undecided("arms and rings have no mirror image here")
    other = case.changed()

    def flip(v):
        return [-v[0], v[1], v[2]]

    def axial(v):
        return [v[0], -v[1], -v[2]]

    for key in ("bodies", "shapes", "loads", "wires"):
        for t in other.main.get(key, []):
            for name in ("position_mm", "velocity_m_s", "force_N", "com_mm", "from_mm", "to_mm", "bulge"):
                if name in t:
                    t[name] = flip(t[name])
            for name in ("rotation_deg", "spin_rad_s", "moment_Nm"):
                if name in t:
                    t[name] = axial(t[name])
    if "gravity" in other.main:
        other.main["gravity"]["vector_m_s2"] = flip(other.main["gravity"]["vector_m_s2"])
    signs = [(r" (x_mm|vx_m_s|fx_N|dx_mm|my_Nm|mz_Nm|wy_rad_s|wz_rad_s|turn_y_deg|turn_z_deg)$", -1.0)]
    alike(case, other, run, expected=lambda one, n: -one[n] if re.search(signs[0][0], n) else one[n])


UNITS = {
    "mm": (1, 0, 0),
    "m": (1, 0, 0),
    "s": (0, 0, 1),
    "kg": (0, 1, 0),
    "kg_m2": (2, 1, 0),
    "kg_m3": (-3, 1, 0),
    "m_s": (1, 0, -1),
    "m_s2": (1, 0, -2),
    "rad_s": (0, 0, -1),
    "N": (1, 1, -2),
    "Nm": (2, 1, -2),
    "Nm2": (3, 1, -2),
    "N_m": (0, 1, -2),
    "Nm_rad": (2, 1, -2),
    "Ns_m": (0, 1, -1),
    "Nms_rad": (2, 1, -1),
    "1_s": (0, 0, -1),
    "1_m": (-1, 0, 0),
    "GPa": (-1, 1, -2),
    "N_m2": (-1, 1, -2),
    "s_m": (-1, 0, 1),
    "J": (2, 1, -2),
}
SUFFIXES = sorted(UNITS, key=len, reverse=True)
EXPLICIT = {"static_speed_m_s": 0.01, "dynamic_speed_m_s": 1.0, "bristle_displacement_m": 1e-6, "bristle_time_s": 1e-5}


def factor(name, length, mass, time):
    unit = next((u for u in SUFFIXES if name.endswith("_" + u)), None)
    if unit is None:
        return 1.0
    a, b, c = UNITS[unit]
    return length**a * mass**b * time**c


def in_full(case):
    """With the defaults that have a unit written down."""
    base = case.changed()
    m = base.main
    m["solver"] = {**DEFAULTS, "peak_window_s": 1e-4, **m.get("solver", {})}
    m["damping"] = {"bending_time_s": 1e-5, "axial_time_s": 1e-5, "strand_time_s": 1e-5, **m.get("damping", {})}
    for t in [*m.get("shapes", []), *m.get("contacts", [])]:
        if "friction" in t:
            t.update(
                {k: v for k, v in EXPLICIT.items() if k not in t and not (t.get("law") == "smooth" and k.startswith("bristle"))}
            )
        if "model" not in t:
            t["foundation"] = {"damping_s_m": 1000.0, **t.get("foundation", {})}
    for t in m.get("shapes", []):
        if t["kind"] == "grapple_shaft":
            for k, v in (
                ("shaft_radius_mm", 6.0),
                ("shaft_length_mm", 60.0),
                ("cam_radius_mm", 12.0),
                ("underside_length_mm", 6.0),
                ("cam_length_mm", 18.0),
                ("end_radius_mm", 4.0),
                ("bulge_mm", 2.0),
            ):
                t.setdefault(k, v)
    return base


def rescaled(base, length, mass, time):
    other = base.changed()

    def change(value, f):
        return [change(v, f) for v in value] if isinstance(value, list) else value if isinstance(value, (str, bool)) else f * value

    def walk(table):
        for k, v in table.items():
            if isinstance(v, dict):
                walk(v)
            elif isinstance(v, list) and v and isinstance(v[0], dict):
                for t in v:
                    walk(t)
            elif k == "k":
                table[k] = v * mass * length / time**2 / length ** table["p"]
            elif k == "c" and table.get("model") == "power":
                table[k] = v * mass * length / time**2 / length ** table["p"] * time / length
            else:
                f = factor(k, length, mass, time)
                if f != 1.0:
                    table[k] = change(v, f)

    walk(other.main)
    return other


def units_scaled(case, run, length, mass, time):
    """The same motion in other units of length, mass and time: tolerances and all."""
    if any(k in case.main for k in ("arms", "snares")) or case.main["output"].get("modes"):
        raise Undecided("files beside it")
    base = in_full(case)
    other = rescaled(base, length, mass, time)
    alike(base, other, run, expected=lambda one, n: one[n] * factor(n, length, mass, time))


def masses_times_four(case, run):
    units_scaled(case, run, 1.0, 4.0, 1.0)


def lengths_times_two(case, run):
    units_scaled(case, run, 2.0, 1.0, 1.0)


def times_times_four(case, run):
    units_scaled(case, run, 1.0, 1.0, 4.0)


def wires_the_other_way(case, run):
    if not case.main.get("wires"):
        raise Undecided("no wires")
    other = case.changed()
    for w in other.main["wires"]:
        if w.get("from_frame", "world") != w.get("to_frame", "world") and "bulge" in w and w.get("to_frame", "world") != "world":
            pass  # the frames begin parallel
        w["from_mm"], w["to_mm"] = w["to_mm"], w["from_mm"]
        ends = w.pop("from_frame", "world"), w.pop("to_frame", "world")
        w["from_frame"], w["to_frame"] = ends[1], ends[0]
    alike(case, other, run)


def time_reversed(case, run):
    """What loses nothing comes back."""
    m = case.main
    lossless = not any(k in m for k in ("wires", "arms", "snares", "welds", "frames")) and all(
        not any(
            t.get(k)
            for k in (
                "c_Ns_m",
                "c",
                "friction",
                "drag_Ns_m",
                "drag_Nms_rad",
                "translational_damping_Ns_m",
                "rotational_damping_Nms_rad",
            )
        )
        for key in ("bodies", "contacts", "bushings")
        for t in m.get(key, [])
    )
    if (
        not lossless
        or any("com_mm" in b or b.get("driven") for b in m["bodies"])
        or any("shape" in t or "duration_s" in t or t.get("ramp_s") for t in m.get("loads", []))
    ):
        raise Undecided("not lossless")
    base = tight(case)
    for b in base.main.get("bushings", []):
        b["neutral"] = "frames"
    one = run(base)
    back = base.changed()
    for b in back.main["bodies"]:
        end = {
            c: float(one[f"{b['name']} {c}"][-1])
            for c in (
                "x_mm",
                "y_mm",
                "z_mm",
                "qw",
                "qx",
                "qy",
                "qz",
                "vx_m_s",
                "vy_m_s",
                "vz_m_s",
                "wx_rad_s",
                "wy_rad_s",
                "wz_rad_s",
            )
        }
        b["position_mm"] = [end["x_mm"], end["y_mm"], end["z_mm"]]
        q = numpy.array([end["qw"], end["qx"], end["qy"], end["qz"]])
        q *= math.copysign(1.0, q[0])
        s = numpy.linalg.norm(q[1:])
        b["rotation_deg"] = [float(v) for v in math.degrees(2.0 * math.atan2(s, q[0])) * q[1:] / (s or 1.0)]
        b["velocity_m_s"] = [-end["vx_m_s"], -end["vy_m_s"], -end["vz_m_s"]]
        b["spin_rad_s"] = [-end["wx_rad_s"], -end["wy_rad_s"], -end["wz_rad_s"]]
    two = run(back)
    found = {group(n): numpy.abs(run(case)[n] - one[n]) for n in one.names}
    run.asked = run.asked[:2]
    for name in columns(one):
        if re.search(r" ([xyz]_mm|v[xyz]_m_s|w[xyz]_rad_s)$", name):
            sign = 1.0 if name.endswith("_mm") else -1.0
            e = numpy.nanmax(found[group(name)])
            different(name, one[name][0], sign * two[name][-1], 30.0 * e + 3.0 * floor(name) + 1e-4 * size(one, name))


def energy_closes(case, run):
    """Kinetic, strain, potential and dissipated less the work done stays; what is missing is the integrator's, and falls with the tolerance or is less
    than a thousandth, of blows on wires with mass than three: of those the touches leave as much at any tolerance."""
    one, fine = run(case), run(tight(case))
    run.asked = run.asked[:1]
    largest = max(numpy.ptp(one[n]) for n in ("kinetic_J", "strain_J", "potential_J", "dissipated_J", "work_J"))
    total = one["kinetic_J"] + one["strain_J"] + one["potential_J"] + one["dissipated_J"] - one["work_J"]
    different(
        "integrator_J",
        total - total[0],
        one["integrator_J"] - one["integrator_J"][0],
        1e-6 * largest + 1e-12 * max(abs(total)) + 1e-12,
    )
    gap, less = (numpy.nanmax(numpy.abs(r["integrator_J"])) for r in (one, fine))
    share = 3e-3 if any(w["model"] == "full" for w in case.main.get("wires", [])) else 1e-3
    if gap > share * largest + 1e-6 and less > max(0.4 * gap, share * largest):  # places are known to a part of a micrometre
        raise Broken("integrator_J", f"integrator_J: {gap:.4g} of {largest:.4g}, and {less:.4g} at a tenth of the tolerances")


def dissipation_never_falls(case, run):
    d = run(case)["dissipated_J"]
    different("dissipated_J", d, numpy.maximum.accumulate(d), 1e-6 * numpy.nanmax(numpy.abs(d)) + 1e-11)


def momentum_closes(case, run):
    one, fine = run(case), run(tight(case))
    run.asked = run.asked[:1]
    bodies = [b for b in case.main.get("bodies", []) if not b.get("driven")]
    scale = sum(b["mass_kg"] * max(size(one, f"{b['name']} vx_m_s"), 1e-3) for b in bodies) or 1e-3
    scale += 1.0 * ("arms" in case.main)  # some ten kilograms at 0.1 m/s
    for name, arm in (("momentum_error_Ns", 1.0), ("angular_momentum_error_Nms", 0.3)):
        gap, less = (max(map(abs, r.answer[name])) for r in (one, fine))
        if gap > 3e-6 * scale * arm and less > max(0.3 * gap, 3e-6 * scale * arm):
            raise Broken(name, f"{name}: {gap:.4g} of {scale * arm:.4g}, and {less:.4g} at a tenth of the tolerances")


def energy_of_bodies(case, run):
    """The kinetic energy is that of the velocities; of what falls the potential energy is that of the places."""
    m = case.main
    if any(k in m for k in ("wires", "arms", "snares")):
        raise Undecided("not of bodies alone")
    one = run(case)
    bodies = [b for b in m["bodies"] if not b.get("driven")]
    kinetic = sum(
        0.5 * b["mass_kg"] * sum(one[f"{b['name']} v{c}_m_s"] ** 2 for c in "xyz")
        + sum(0.5 * i * one[f"{b['name']} w{c}_rad_s"] ** 2 for i, c in zip(b["inertia_kg_m2"], "xyz"))
        for b in bodies
    )
    different("kinetic_J", one["kinetic_J"], kinetic, 1e-6 * numpy.max(kinetic) + 1e-9)
    pull = m.get("gravity", {"vector_m_s2": [0.0] * 3})["vector_m_s2"]
    potential = -sum(b["mass_kg"] * g * 1e-3 * one[f"{b['name']} {c}_mm"] for b in bodies for g, c in zip(pull, "xyz"))
    different(
        "potential_J", one["potential_J"] - one["potential_J"][0], potential - potential[0], 1e-6 * numpy.ptp(potential) + 1e-9
    )


def summary_is_history(case, run):
    """The last line of the history and the summary tell the same."""
    one = run(case)
    if one.answer["time_s"] != one["time_s"][-1]:
        raise Undecided("no line at the end")
    for b in one.answer["bodies"]:
        for key, cells in (("position_after_mm", "{}_mm"), ("velocity_after_m_s", "v{}_m_s"), ("spin_after_rad_s", "w{}_rad_s")):
            for c, value in zip("xyz", b[key]):
                name = f"{b['body']} " + cells.format(c)
                different(name, one[name][-1:], [value], 1e-9 * abs(value) + 1e-12)
    for key in ("kinetic", "strain", "potential", "dissipated", "work", "integrator"):
        different(key, one[f"{key}_J"][-1:], [one.answer["energy_J"][key]], 1e-9 * abs(one.answer["energy_J"][key]) + 1e-12)


def points_of(file):
    """Points, tensions, curvatures and velocities of a ParaView file, and the numbers of points of its wires."""
    text = file.read_text()

    def numbers(start):
        at = text.index(">", text.index(start)) + 1
        return numpy.array(text[at : text.index("</DataArray>", at)].split(), dtype=float)

    return (
        numbers('Name="Points"').reshape(-1, 3),
        numbers('Name="tension_N"'),
        numbers('Name="curvature_1_m"'),
        numbers('Name="velocity_m_s"').reshape(-1, 3),
    )


def tension_is_stretch(case, run):
    """The tension of a piece of a wire that is straight is what its length and the rate of that say."""
    m = case.main
    if not m.get("wires") or m["wires"][0]["model"] in ("stretched", "quadratic"):
        raise Undecided("no wire with a shape")
    other = case.changed()
    other.main.setdefault("output", {})["paraview"] = True
    files = sorted(run(other).out.glob("motion_*.vtp"))
    w = m["wires"][0]
    section = 1e9 * w["youngs_modulus_GPa"] * math.pi / 4.0 * (1e-3 * w["diameter_mm"]) ** 2
    stretch, n = w.get("axial_stiffness_N", section), w["elements"]
    rest = 1e-3 * w["length_mm"] / n
    for file in files[:: max(1, len(files) // 6)]:
        x, tension, curvature, velocity = (v[: n + 1] for v in points_of(file))
        edge = numpy.diff(x, axis=0)
        chord = numpy.linalg.norm(edge, axis=1)
        rate = numpy.sum(numpy.diff(velocity, axis=0) * edge, axis=1) / chord
        want = stretch * (chord - rest + m["damping"]["axial_time_s"] * rate) / rest
        ends = numpy.array([tension[:-1], tension[1:]])
        bow = stretch * (chord * numpy.maximum(abs(curvature[1:]), abs(curvature[:-1]))) ** 2 / 24.0
        error = 2.0 * bow + numpy.ptp(ends, axis=0) + 5e-8 * stretch + 0.01 * abs(want)
        straight = bow < 0.02 * abs(want)
        if straight.any():
            different("tension_N", ends.mean(axis=0)[straight], want[straight], error[straight], f" of {file.name}")


def force_is_load(case, run):
    """A constant force on a body is a load at its centre of mass in the world's axes."""
    bodies = [b for b in case.main.get("bodies", []) if not b.get("driven")]
    if not bodies:
        raise Undecided("no bodies")
    one, two = case.changed(), case.changed()
    name = bodies[0]["name"]
    next(b for b in one.main["bodies"] if b["name"] == name)["force_N"] = [1.0, -2.0, 0.5]
    b = next(b for b in two.main["bodies"] if b["name"] == name)
    b.pop("force_N", None)
    two.main.setdefault("loads", []).append(
        {"name": "constant", "frame": name, "axes": "world", "position_mm": b.get("com_mm", [0.0] * 3), "force_N": [1.0, -2.0, 0.5]}
    )
    alike(one, two, run)


def weight_is_force(case, run):
    """Of bodies alone."""
    m = case.main
    if any(k in m for k in ("wires", "arms", "snares", "welds")):
        raise Undecided("not of bodies alone")
    pull = [1.0, -9.81, 2.0]
    one, two = case.changed(), case.changed()
    one.main["gravity"] = {"vector_m_s2": pull}
    two.main.pop("gravity", None)
    for b in two.main["bodies"]:
        if not b.get("driven"):
            b["force_N"] = [f + b["mass_kg"] * g for f, g in zip(b.get("force_N", [0.0] * 3), pull)]
    alike(one, two, run, only=lambda n: n not in ("potential_J", "work_J"))


def centre_of_mass(case, run):
    """A frame beside the centre of mass, or on it."""
    m = case.main
    bodies = [b for b in m.get("bodies", []) if not b.get("driven")]
    if not bodies or any(k in m for k in ("arms", "snares", "welds", "frames")):
        raise Undecided("no bodies, or frames on them")
    one = case.changed()
    b = next(b for b in one.main["bodies"] if b["name"] == bodies[0]["name"])
    offset = numpy.array(b.get("com_mm", [4.0, -7.0, 3.0]))
    b["com_mm"] = [float(c) for c in offset]
    two = one.changed()
    c = next(c for c in two.main["bodies"] if c["name"] == b["name"])
    c.pop("com_mm")
    turn = rotation(b.get("rotation_deg", [0.0] * 3))
    c["position_mm"] = [float(x) for x in numpy.array(b["position_mm"]) + turn @ offset]
    spin = turn @ numpy.cross(b.get("spin_rad_s", [0.0] * 3), 1e-3 * offset)
    c["velocity_m_s"] = [float(v) for v in numpy.array(b.get("velocity_m_s", [0.0] * 3)) + spin]
    for key in ("shapes", "loads"):
        for t in two.main.get(key, []):
            if t.get("frame", t.get("body")) == b["name"]:
                t["position_mm"] = [float(x) for x in numpy.array(t.get("position_mm", [0.0] * 3)) - offset]
    for w in two.main.get("wires", []):
        for end in ("from", "to"):
            if w.get(f"{end}_frame") == b["name"]:
                w[f"{end}_mm"] = [float(x) for x in numpy.array(w[f"{end}_mm"]) - offset]
    for s in [s for s in two.main.get("bushings", []) if b["name"] in (s.get("frame"), s.get("other_frame"))]:
        two.main.setdefault("frames", []).append(
            {"name": f"old_{s['name']}", "frame": b["name"], "position_mm": [float(-x) for x in offset]}
        )
        for end in ("frame", "other_frame"):
            if s.get(end) == b["name"]:
                s[end] = f"old_{s['name']}"
    alike(one, two, run)


def in_two_halves(case, run):
    """A body, or two halves of it welded together."""
    m = case.main
    if (
        any(k in m for k in ("arms", "snares"))
        or not m.get("bodies")
        or "com_mm" in m["bodies"][0]
        or m["bodies"][0].get("driven")
        or m.get("welds")
    ):
        raise Undecided("no plain body")
    other = case.changed()
    b = other.main["bodies"][0]
    mass, inertia = b["mass_kg"], b["inertia_kg_m2"]
    d = math.sqrt(0.2 * min(inertia) / mass)
    half = [0.5 * inertia[0], 0.5 * (inertia[1] - mass * d * d), 0.5 * (inertia[2] - mass * d * d)]
    b |= {"mass_kg": 0.5 * mass, "inertia_kg_m2": half, "com_mm": [-1e3 * d, 0.0, 0.0]}
    other.main["bodies"].append(
        {"name": "half", "frame": b["name"], "mass_kg": 0.5 * mass, "inertia_kg_m2": half, "com_mm": [1e3 * d, 0.0, 0.0]}
    )
    if "force_N" in b:
        other.main.setdefault("loads", []).append(
            {"name": "half", "frame": b["name"], "axes": "world", "force_N": b.pop("force_N")}
        )
    for name in ("drag_Ns_m", "drag_Nms_rad"):
        if name in b:
            raise Undecided("drag of a half")
    other.main.setdefault("welds", []).append({"name": "half", "body": "half", "frame": b["name"]})
    spin = [f"{b['name']} w{c}_rad_s" for c in "xyz"]
    alike(
        case,
        other,
        run,
        only=lambda n: n in spin or not n.startswith(b["name"] + " ") and not n.endswith("_J") or n in ("kinetic_J",),
    )


def sensors_watch(case, run):
    """Sensors read and change nothing."""
    other = case.changed()
    names = [b["name"] for b in case.main.get("bodies", [])]
    if not names:
        raise Undecided("nothing to read")
    other.main["sensors"] = [
        {"name": f"see{k}", "kind": kind, "frame": names[0]} for k, kind in enumerate(("position", "velocity", "attitude", "rate"))
    ] + other.main.get("sensors", [])
    same_numbers(run(case), run(other))


def telemetry(found):
    """Columns of telemetry.csv, of the times at which all sensors read."""
    with (found.out / "telemetry.csv").open(newline="") as file:
        rows = [row for row in csv.reader(line for line in file if not line.startswith("#"))]
    full = [row for row in rows[1:] if all(row)]
    return {name: column([row[k] for row in full]) for k, name in enumerate(rows[0])}


def tensions_are_read(case, run):
    """A sensor of tension reads its own wire."""
    wires = [w["name"] for w in case.main.get("wires", [])]
    if not wires:
        raise Undecided("no wires")
    other = case.changed()
    other.main["sensors"] = [{"name": f"of_{w}", "kind": "tension", "wire": w} for w in wires]
    found = run(other)
    read = telemetry(found)
    for w in wires:
        name = next(n for n in read if n.startswith(f"of_{w}"))
        rows = numpy.isin(found["time_s"].round(9), read["time_s"].round(9))
        different(name, read[name], found[f"{w} tension_N"][rows], 1e-9 * size(found, f"{w} tension_N") + 1e-9)


def velocity_is_rate(case, run):
    """What a sensor of velocity reads is the rate of what one of places reads, also with respect to a body that turns: by differences over one and two intervals."""
    free = [b["name"] for b in case.main.get("bodies", []) if not b.get("driven")]
    if len(free) < 2:
        raise Undecided("no two bodies")
    other = case.changed()
    other.main["sensors"] = [
        {"name": kind, "kind": kind, "frame": free[0], "relative_to": free[1]} for kind in ("position", "velocity")
    ]
    other.main["output_interval_s"] = 2e-4  # a fraction of every period
    read = telemetry(run(other))
    step = read["time_s"][1] - read["time_s"][0]
    for c in "xyz":
        place, speed = 1e-3 * read[f"position_{c}_mm"], read[f"velocity_{c}_m_s"][2:-2]
        one, two = (place[3:-1] - place[1:-3]) / (2.0 * step), (place[4:] - place[:-4]) / (4.0 * step)
        different(f"velocity_{c}", speed, one, 2.0 * numpy.abs(one - two) + 0.01 * numpy.max(numpy.abs(speed)) + 1e-4)


def weak(name, change):
    def relation(case, run):
        other = case.changed()
        if change(other.main) is False:
            raise Undecided("it is there, or nothing to be on")
        alike(case, other, run)

    relation.__name__ = f"weak_{name}"
    relation.__doc__ = "What is too weak to be seen changes nothing."
    return relation


def drag(main):
    free = [b for b in main.get("bodies", []) if not b.get("driven")]
    for b in free:
        b.setdefault("drag_Ns_m", 1e-12)
        b.setdefault("drag_Nms_rad", 1e-12)
    return bool(free)


def rub(main):
    bare = [t for t in [*main.get("contacts", []), *main.get("shapes", [])] if "friction" not in t]
    for t in bare:
        t["friction"] = 1e-9
    return bool(bare)


def spring(main):
    if not main.get("bodies") or main["bodies"][0].get("driven"):
        return False
    main.setdefault("bushings", []).append(
        {
            "name": "faint",
            "frame": "world",
            "other_frame": main["bodies"][0]["name"],
            "translational_stiffness_N_m": 1e-9,
            "rotational_stiffness_Nm_rad": 1e-12,
        }
    )
    return None


def pull(main):
    if "gravity" in main:
        return False
    main["gravity"] = {"vector_m_s2": [1e-9, 1e-9, 1e-9]}
    return None


def page(main):
    main.setdefault("output", {})["paraview"] = True


BALANCES = [energy_closes, momentum_closes, dissipation_never_falls]
RELATIONS = BALANCES + [
    twice_the_output_rate,
    split_by_checkpoints,
    order_of_lists,
    names_of_things,
    an_idle_body,
    an_idle_wire,
    world_turned,
    world_shifted,
    on_a_standing_carrier,
    galilei,
    gravity_is_acceleration,
    mirrored,
    masses_times_four,
    lengths_times_two,
    times_times_four,
    wires_the_other_way,
    time_reversed,
    energy_of_bodies,
    summary_is_history,
    tension_is_stretch,
    force_is_load,
    weight_is_force,
    centre_of_mass,
    in_two_halves,
    sensors_watch,
    tensions_are_read,
    velocity_is_rate,
    weak("drag", drag),
    weak("friction", rub),
    weak("spring", spring),
    weak("gravity", pull),
    weak("paraview", page),
]
