"""What must hold between pushes. A relation takes a case and a runner, and raises Broken with both numbers, or Undecided."""

import math

import numpy

from cases import Broken, Undecided, different, same_numbers

SIDES = (
    ("tension_left_N", "tension_right_N", 1.0),
    ("reaction_along_left_N", "reaction_along_right_N", -1.0),
    ("reaction_across_left_N", "reaction_across_right_N", 1.0),
    ("reaction_z_left_N", "reaction_z_right_N", 1.0),
)
PATH = {"strand_extra_stiffness_Nm2", "yield_stress_MPa"}


def errors(run):
    """The stated error of every force, the largest so far of its series: what has happened on the way stays."""
    e = numpy.nan_to_num(run["discretisation_error_N"].copy(), nan=math.inf)  # empty: not known
    for name in set(run["series"]):
        rows = run["series"] == name
        e[rows] = numpy.maximum.accumulate(e[rows])
    return e


def scale(run):
    """The largest force or tension of the series, by line: what rounding and Newton's method are relative to."""
    size = numpy.zeros(len(run["force_N"]))
    for name in set(run["series"]):
        rows = run["series"] == name
        size[rows] = max(
            numpy.nanmax(numpy.abs(run[c][rows])) for c in ("force_N", "tension_left_N", "tension_right_N", "transverse_force_N")
        )
    return size


def stable(*runs):
    """An unstable equilibrium has neighbours: which one a path takes is not said."""
    if any(numpy.nanmax(r["unstable_modes"]) > 0 or numpy.nanmax(r["out_of_plane_modes"]) > 0 for r in runs):
        raise Undecided("unstable")


def path_dependent(case):
    """Whether the path leaves traces: friction, yielding, strands, slip."""
    tables = [case.main, *case.main["series"]]
    return any(
        t.get("pusher", {}).get("friction", 0.0) > 0.0 or PATH & set(t.get("wire", {})) or "slip_tension_N" in t.get("mount", {})
        for t in tables
    )


def forces(one, other, factor=1.0, rows=slice(None), share=3.0, columns=("force_N",), relative=2e-6):
    """Forces of one are those of the other over `factor` within the errors both state."""
    stable(one, other)
    allowed = share * (errors(one)[rows] + errors(other) / abs(factor)) + relative * scale(one)[rows] + 1e-12
    for name in columns:
        different(name, one[name][rows], other[name] / factor, allowed)


def every(case, n=2):
    """The lines of a run that one with n times the steps has in common with it."""
    lines, k = [], 0
    for s in case.main["series"]:
        steps = (s["points"] - 1) * (len(s["path_mm"]) - 1 if "path_mm" in s else 1)
        lines += [k + n * i for i in range(steps + 1)]
        k += n * steps + 1
    return lines


def number_of_points(case, run):
    other = case.changed()
    for s in other.main["series"]:
        s["points"] = 2 * s["points"] - 1
    one, many = run(case), run(other)
    rows = every(case)
    stable(one, many)
    allowed = 3.0 * (errors(one) + errors(many)[rows]) + 2e-6 * scale(one) + 1e-12
    different("force_N", one["force_N"], many["force_N"][rows], allowed)


def finer_mesh(case, run):
    """Where the mesh is all there is to err, twice the elements stay within the stated error."""
    other = case.changed()
    other.main["solver"]["elements"] *= 2
    one = run(case)
    if numpy.any(errors(one) > 0.02 * scale(one)):
        raise Undecided("coarse")
    forces(one, run(other), share=5.0, relative=1e-4)


def order_of_series(case, run):
    if len(case.main["series"]) < 2:
        raise Undecided("one series")
    other = case.changed()
    other.main["series"].reverse()
    one, back = run(case), run(other)
    lines = [k for s in other.main["series"] for k in numpy.flatnonzero(one["series"] == s["name"])]
    same_numbers(one, back, rows=lines)


def names_of_series(case, run):
    other = case.changed()
    for k, s in enumerate(other.main["series"]):
        s["name"] = f"zz{9 - k}"
    same_numbers(run(case), run(other), but=("series",))


def a_series_alone(case, run):
    if len(case.main["series"]) < 2:
        raise Undecided("one series")
    other = case.changed()
    other.main["series"] = other.main["series"][-1:]
    one = run(case)
    same_numbers(one, run(other), rows=numpy.flatnonzero(one["series"] == other.main["series"][0]["name"]))


def keys_of_the_series(case, run):
    """What the file says of all series, or each for itself, is the same."""
    other = case.changed()
    for s in other.main["series"]:
        for table in ("wire", "mount", "pusher", "bulge", "gravity"):
            if table in case.main:
                s[table] = {**other.main[table], **s.get(table, {})}
    for table in ("wire", "mount", "pusher", "bulge", "gravity"):
        other.main.pop(table, None)
    same_numbers(run(case), run(other))


def declared_section(case, run):
    """The stiffnesses of the solid section, written down."""
    other = case.changed()
    w = other.main["wire"]
    d, e = 1e-3 * w["diameter_mm"], 1e9 * w["youngs_modulus_GPa"]
    if "bending_stiffness_Nm2" in w:
        w.setdefault("torsional_stiffness_Nm2", w["bending_stiffness_Nm2"] / (1.0 + w["poisson_ratio"]))
    w.setdefault("bending_stiffness_Nm2", e * math.pi * d**4 / 64.0)
    w.setdefault("axial_stiffness_N", e * math.pi * d**2 / 4.0)
    forces(run(case), run(other), relative=1e-5)


def half_the_path(case, run):
    """What comes later does not change what was before."""
    other = case.changed()
    for s in other.main["series"]:
        if "path_mm" in s:
            s["path_mm"] = s["path_mm"][:2]
        else:
            s["path_mm"] = [0.0, s.pop("travel_mm"), 0.0]
    if case.main["solver"].get("instability"):
        raise Undecided("a branch is chosen")
    one, more = run(case), run(other)
    lines, others = [], []
    for s in case.main["series"]:
        a, b = (numpy.flatnonzero(r["series"] == s["name"])[: s["points"]] for r in (one, more))
        lines += list(a)
        others += list(b)
    stable(one, more)
    different(
        "force_N",
        one["force_N"][lines],
        more["force_N"][others],
        3.0 * (errors(one)[lines] + errors(more)[others]) + 2e-6 * scale(one)[lines],
    )


def the_other_end_first(case, run):
    """The wire from right to left."""
    if case.main.get("bulge", {}).get("mode", 1) % 2 == 0:
        raise Undecided("the bulge of an even mode has another sign")
    other = case.changed()
    m = other.main
    span = m["mount"]["span_mm"]
    turn = {"_left_": "_right_", "_right_": "_left_"}
    m["mount"] = {next((k.replace(a, b) for a, b in turn.items() if a in k), k): v for k, v in m["mount"].items()}
    m["mount"]["span_mm"] = span
    if "slip_tension_N" in m["mount"]:
        m["mount"]["slip_at"] = {"left": "right", "right": "left", "both": "both"}[m["mount"].get("slip_at", "left")]
    for name in ("misalignment_deg", "tilt_deg"):
        if name in m["pusher"]:
            m["pusher"][name] = -m["pusher"][name]
    if "gravity" in m:
        m["gravity"]["vector_m_s2"][0] *= -1.0
    for s in m["series"]:
        s["contact_position_mm"] = span - s["contact_position_mm"]
    one, back = run(case), run(other)
    forces(one, back)
    # The error that is stated is that of the force alone; a path with steps of its own errs in the first order of them.
    allowed = 10.0 * (errors(one) + errors(back)) + (1e-2 if path_dependent(case) else 1e-3) * scale(one)
    different("transverse_force_N", one["transverse_force_N"], -back["transverse_force_N"], allowed)
    for left, right, sign in SIDES:
        different(left, one[left], sign * back[right], allowed)
        different(right, one[right], sign * back[left], allowed)
    different("contact_arc_mm", one["contact_arc_mm"], m["wire"]["length_mm"] - back["contact_arc_mm"], 2e-3 * span)


def mirrored(case, run):
    """A straight wire does not know outward from inward."""
    if (
        case.main["wire"]["length_mm"] > case.main["mount"]["span_mm"]
        or case.main["mount"]["kind"] == "supports"
        or "natural_curvature_1_m" in case.main["wire"]
    ):
        raise Undecided("it bulges")
    other = case.changed()
    p = other.main["pusher"]
    p["direction"] = "inward" if p["direction"] == "outward" else "outward"
    if "gravity" in other.main:
        other.main["gravity"]["vector_m_s2"][1] *= -1.0
    p["misalignment_deg"] = -p.get("misalignment_deg", 0.0)  # the direction against the bulge is turned around as a whole
    one, back = run(case), run(other)
    forces(one, back)


def scaled(case, length, force):
    """The same wire `length` times as long, its forces `force` times as large."""
    other = case.changed()
    modulus = force / length**2
    factors = {
        "diameter_mm": length,
        "length_mm": length,
        "youngs_modulus_GPa": modulus,
        "bending_stiffness_Nm2": force * length**2,
        "axial_stiffness_N": force,
        "torsional_stiffness_Nm2": force * length**2,
        "natural_curvature_1_m": 1.0 / length,
        "strand_extra_stiffness_Nm2": force * length**2,
        "strand_slip_curvature_1_m": 1.0 / length,
        "yield_stress_MPa": modulus,
        "span_mm": length,
        "support_radius_mm": length,
        "slip_tension_N": force,
        "radius_mm": length,
        "compliance_m_N": length / force,
        "vector_m_s2": force / length**3,
        "contact_position_mm": length,
        "travel_mm": length,
        "path_mm": length,
    }
    for table in (
        other.main["wire"],
        other.main["mount"],
        other.main["pusher"],
        other.main.get("gravity", {}),
        *other.main["series"],
    ):
        for k, v in table.items():
            f = factors.get(
                k, force / length if k.startswith("translational") else force * length if k.startswith("rotational") else 1.0
            )
            if f != 1.0:
                table[k] = [f * x for x in v] if isinstance(v, list) else f * v
    return other


def forces_times_sixteen(case, run):
    forces(
        run(case), run(scaled(case, 1.0, 16.0)), 16.0, columns=("force_N", "tension_left_N", "transverse_force_N"), relative=1e-5
    )


def lengths_times_four(case, run):
    forces(
        run(case), run(scaled(case, 4.0, 16.0)), 16.0, columns=("force_N", "tension_left_N", "transverse_force_N"), relative=1e-5
    )


def lengths_over_three(case, run):
    forces(run(case), run(scaled(case, 1.0 / 3.0, 0.1)), 0.1, columns=("force_N",), relative=1e-5)


def plane_of_the_bulge(case, run):
    if "gravity" in case.main or "tilt_deg" in case.main["pusher"] or case.main["mount"]["kind"] == "supports":
        raise Undecided("weight or tilt")
    other = case.changed()
    other.main["bulge"] = {**case.main.get("bulge", {}), "plane_deg": 30.0}
    forces(run(case), run(other))


NEUTRAL = (
    ("pusher", "friction", 1e-9),
    ("pusher", "compliance_m_N", 1e-15),
    ("pusher", "misalignment_deg", 1e-9),
    ("mount", "translational_stiffness_N_m", 1e14),
    ("mount", "rotational_stiffness_Nm_rad", 1e12),
    ("mount", "slip_tension_N", 1e9),
    ("wire", "yield_stress_MPa", 1e9),
    ("wire", "natural_curvature_1_m", 1e-9),
    ("wire", "strand", 1e-9),
    ("gravity", "vector_m_s2", [1e-9, 1e-9, 0.0]),
)


def neutral(case, run, k):
    """An effect too weak to be seen changes nothing."""
    table, name, value = NEUTRAL[k]
    if name in case.main.get(table, {}) and case.main[table][name] not in (0.0, [0.0, 0.0, 0.0]):
        raise Undecided("it is there")
    kind = case.main["mount"]["kind"]
    if (table == "mount" and (kind == "supports" or "rotational" in name and kind != "clamped")) or (
        name == "natural_curvature_1_m" and kind == "supports"
    ):
        raise Undecided("not with these mounts")
    other = case.changed()
    if name == "strand":
        if PATH & set(case.main["wire"]):
            raise Undecided("it is there")
        w = other.main["wire"]
        w["strand_extra_stiffness_Nm2"] = 1e-6 * w.get(
            "bending_stiffness_Nm2", 1e9 * w["youngs_modulus_GPa"] * math.pi / 64.0 * (1e-3 * w["diameter_mm"]) ** 4
        )
        w["strand_slip_curvature_1_m"] = 1.0
    else:
        other.main[table] = {**other.main.get(table, {}), name: value}
    forces(run(case), run(other), share=5.0, relative=3e-5)


def there_and_back(case, run):
    """What is elastic and slides without friction does not know where it comes from."""
    if path_dependent(case) or case.main["solver"].get("instability"):
        raise Undecided("the path leaves traces")
    other = case.changed()
    for s in other.main["series"]:
        travel = s.pop("travel_mm") if "travel_mm" in s else max(s["path_mm"])
        s["path_mm"] = [0.0, travel, 0.0]
    there = run(other)
    stable(there)
    for s in other.main["series"]:
        rows = numpy.flatnonzero(there["series"] == s["name"])
        if len(rows) != 2 * s["points"] - 1:
            raise Broken("rows", f"{len(rows)} lines")
        allowed = 3.0 * errors(there)[rows] + 2e-6 * scale(there)[rows] + 1e-12
        for name in ("force_N", "energy_J"):
            size = (
                allowed
                if name != "energy_J"
                else 2e-3 * numpy.nanmax(numpy.abs(there[name][rows])) + allowed * 1e-3 * max(s["path_mm"])
            )
            different(name, there[name][rows], there[name][rows][::-1], size)


def work_is_energy(case, run):
    """The work of the pusher goes into the energy of the wire, but for what friction takes. The energy has no stated error: two thousandths."""
    m = case.main
    if (
        m["pusher"].get("compliance_m_N")
        or "tilt_deg" in m["pusher"]
        or PATH & set(m["wire"])
        or "gravity" in m
        or any(k.startswith(("transl", "rot", "slip")) for k in m["mount"])
    ):
        raise Undecided("energy goes elsewhere, or a loose wire swings aside")
    other = case.changed()
    for s in other.main["series"]:
        s["points"] = 33
        s["travel_mm"] = s.pop("path_mm")[1] if "path_mm" in s else s["travel_mm"]
    found = run(other)
    stable(found)
    for s in other.main["series"]:
        rows = found["series"] == s["name"]
        d, f = 1e-3 * found["displacement_mm"][rows], found["force_N"][rows]
        h = d[1] - d[0]
        simpson = h / 3.0 * (f[:-2:2] + 4.0 * f[1::2] + f[2::2])
        trapezium = h * (0.5 * f[:-2:2] + f[1::2] + 0.5 * f[2::2])
        gain = (found["energy_J"] + found["dissipated_J"])[rows][2::2]
        start = (found["energy_J"] + found["dissipated_J"])[rows][0]
        allowed = numpy.cumsum(numpy.abs(simpson - trapezium)) * 0.5 + d[2::2] * (
            3.0 * errors(found)[rows][2::2] + 1e-5 * scale(found)[rows][2::2]
        )
        different("work_J", numpy.cumsum(simpson), gain - start, allowed + 1e-5 * abs(start) + 2e-3 * numpy.abs(gain - start))


def dissipation_never_falls(case, run):
    """A slip on and back within one step counts by its net length only: up to some hundredths."""
    one = run(case)
    slips = case.main["pusher"].get("friction", 0.0) > 0.0 or "slip_tension_N" in case.main["mount"]
    for name in set(one["series"]):
        d = one["dissipated_J"][one["series"] == name]
        different(
            "dissipated_J",
            d[1:],
            numpy.maximum.accumulate(d)[1:],
            (2e-2 if slips else 2e-4) * numpy.nanmax(numpy.abs(d)) + 1e-15 * numpy.nanmax(numpy.abs(one["energy_J"])),
        )


def forces_balance(case, run):
    """The three sums of docs/curves_csv.md."""
    one = run(case)
    m = case.main
    a = math.radians(m["pusher"].get("misalignment_deg", 0.0))
    sign = 1.0 if m["pusher"]["direction"] == "outward" else -1.0
    x, y = sign * math.sin(a), sign * math.cos(a)
    w = m["wire"]
    weight = [
        w["density_kg_m3"] * math.pi / 4.0 * (1e-3 * w["diameter_mm"]) ** 2 * 1e-3 * w["length_mm"] * g
        for g in m.get("gravity", {"vector_m_s2": [0.0] * 3})["vector_m_s2"]
    ]
    if any(weight) and (m["mount"]["kind"] == "supports" or "slip_tension_N" in m["mount"]):
        raise Undecided("the length between the mounts is not known")
    f, t, z = one["force_N"], one["transverse_force_N"], numpy.nan_to_num(one["axial_force_N"])
    sums = {"along": f * x + t * y + weight[0], "across": f * y - t * x + weight[1], "z": z + weight[2]}
    for name, rest in sums.items():
        different(
            f"balance_{name}",
            one[f"reaction_{name}_left_N"] + one[f"reaction_{name}_right_N"],
            -rest,
            3.0 * errors(one) + 1e-5 * scale(one) + 1e-9,
        )
    different("imbalance_N", one["imbalance_N"], 0.0 * f, 3.0 * errors(one) + 1e-5 * scale(one) + 1e-9)


def compliance_of_the_machine(case, run):
    """A machine that gives way by c F pushes as far as a rigid one that travels c F less."""
    m = case.main
    if path_dependent(case) or "tilt_deg" in m["pusher"] or "slip_tension_N" in m["mount"] or m["solver"].get("instability"):
        raise Undecided("the path leaves traces")
    soft, hard = case.changed(), case.changed()
    soft.main["series"] = [{k: v for k, v in s.items() if k != "path_mm"} for s in soft.main["series"][:1]]
    s = soft.main["series"][0]
    s.setdefault("travel_mm", 0.01 * m["mount"]["span_mm"])
    s["points"] = 5
    if not m["pusher"].get("compliance_m_N"):
        f = run(soft)
        soft.main["pusher"]["compliance_m_N"] = min(1e-3, 3e-4 * s["travel_mm"] / max(1e-9, abs(f["force_N"][-1])))
    given = run(soft)
    travel = given["displacement_mm"] - 1e3 * soft.main["pusher"]["compliance_m_N"] * given["force_N"]
    if numpy.any(numpy.diff(travel) <= 1e-4 * s["travel_mm"]):
        raise Undecided("the machine gives way by all of it")
    hard.main["pusher"]["compliance_m_N"] = 0.0
    hard.main["series"] = [
        {**{k: v for k, v in s.items() if k != "travel_mm"}, "path_mm": [0.0, *map(float, travel[1:])], "points": 2}
    ]
    if abs(travel[0]) > 1e-9:
        raise Undecided("a force at first touch")
    forces(given, run(hard), share=5.0, relative=1e-5)


def both_mounts_alike(case, run):
    """A stiffness of each mount is one of the left and one of the right."""
    m = case.main["mount"]
    names = [k for k in ("translational_stiffness_N_m", "rotational_stiffness_Nm_rad") if k in m]
    if not names or any("_left_" in k or "_right_" in k for k in m):
        raise Undecided("no compliance of both")
    other = case.changed()
    for k in names:
        stem, unit = k.split("stiffness_")
        value = other.main["mount"].pop(k)
        other.main["mount"][f"{stem}stiffness_left_{unit}"] = other.main["mount"][f"{stem}stiffness_right_{unit}"] = value
    forces(run(case), run(other))


def a_string(case, run):
    """A wire without bending between pins, pushed by an edge, is two straight pieces: its tension is what their stretch says."""
    other = case.changed()
    m = other.main
    m["mount"] = {"kind": "pinned", "span_mm": m["mount"]["span_mm"]}
    m["pusher"] = {"shape": "cylinder", "radius_mm": 0.0, "friction": 1.0, "direction": "outward"}
    w = m["wire"] = {k: v for k, v in m["wire"].items() if not k.startswith(("strand", "yield", "hard", "natural"))}
    span, length = m["mount"]["span_mm"], w["length_mm"]
    if m["wire"]["length_mm"] > span or "gravity" in m:
        raise Undecided("loose")
    stretch = w.setdefault("axial_stiffness_N", 1e9 * w["youngs_modulus_GPa"] * math.pi / 4.0 * (1e-3 * w["diameter_mm"]) ** 2)
    w["bending_stiffness_Nm2"] = max(1e-15, stretch * (1e-3 * span) ** 2 * 1e-10)
    m.pop("bulge", None)
    m["pusher"]["friction"] = 0.0
    m["series"] = [{"name": "mid", "contact_position_mm": 0.5 * span, "travel_mm": 0.02 * span, "points": 5}]
    one = run(other)
    stable(one)
    half = numpy.hypot(0.5 * span, one["displacement_mm"])
    tension = stretch * (2.0 * half - length) / length
    rows = one["displacement_mm"] > 0.005 * span
    for name in ("tension_left_N", "tension_right_N"):
        different(name, one[name][rows], tension[rows], 0.01 * tension[rows])
    different("force_N", one["force_N"][rows], (2.0 * tension * one["displacement_mm"] / half)[rows], 0.02 * tension[rows] * 0.02)


BALANCES = [forces_balance, dissipation_never_falls, work_is_energy]
RELATIONS = BALANCES + [
    number_of_points,
    finer_mesh,
    order_of_series,
    names_of_series,
    a_series_alone,
    keys_of_the_series,
    declared_section,
    half_the_path,
    the_other_end_first,
    mirrored,
    forces_times_sixteen,
    lengths_times_four,
    lengths_over_three,
    plane_of_the_bulge,
    there_and_back,
    compliance_of_the_machine,
    both_mounts_alike,
    a_string,
]


def weak(k):
    def relation(case, run):
        neutral(case, run, k)

    relation.__name__ = f"weak_{NEUTRAL[k][1].removesuffix('_N_m').removesuffix('_Nm_rad')}"
    relation.__doc__ = neutral.__doc__
    return relation


RELATIONS += [weak(k) for k in range(len(NEUTRAL))]
