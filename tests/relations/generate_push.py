"""Pushes: every mount, effect and pusher of the experiment file, wires from a hair to a rope."""

import math

from cases import Case, Draw


def wire(draw, span, supports):
    """Slack, straight or stretched; its stiffness that of a section, declared, or of strands."""
    diameter = draw.log(span / 400.0, span / 40.0)
    slack = draw.choice([0.0, draw.log(1e-4, 0.1), draw.log(1e-3, 0.05), -draw.log(1e-4, 8e-3)])
    length = round(span * (1.0 + (abs(slack) if supports else slack)), 6)
    table = {
        "construction": draw.choice(["solid", "solid", "strand"]),
        "diameter_mm": diameter,
        "length_mm": length,
        "youngs_modulus_GPa": draw.log(1.0, 250.0),
        "poisson_ratio": draw.between(0.0, 0.45),
        "density_kg_m3": draw.log(1000.0, 20000.0),
    }
    modulus, metres = table["youngs_modulus_GPa"] * 1e9, diameter * 1e-3
    bending = modulus * math.pi * metres**4 / 64.0
    if table["construction"] == "strand" or draw.maybe(0.3):
        table["bending_stiffness_Nm2"] = bending = float(f"{bending * draw.log(0.01, 1.0):.4g}")
        table["axial_stiffness_N"] = float(f"{modulus * math.pi * metres**2 / 4.0 * draw.between(0.3, 1.0):.4g}")
    if draw.maybe(0.2) and not supports:
        table["natural_curvature_1_m"] = draw.between(-1.0, 1.0) / (1e-3 * span)
    kind = draw.random()
    if kind < 0.12:
        table["strand_extra_stiffness_Nm2"] = float(f"{bending * draw.log(0.1, 3.0):.4g}")
        table["strand_slip_curvature_1_m"] = draw.log(0.1, 5.0) / (1e-3 * span)
        if draw.maybe(0.4):
            table["strand_slip_breadth"] = draw.between(0.0, 2.0)
    elif kind < 0.22:
        table["yield_stress_MPa"] = draw.log(0.001, 0.02) * table["youngs_modulus_GPa"] * 1e3
        table["hardening_ratio"] = draw.log(0.005, 0.5)
    return table


def mount(draw, span, kind, table):
    m = {"kind": kind, "span_mm": span}
    if kind == "supports":
        return {**m, "support_radius_mm": draw.choice([0.0, draw.between(0.5, 0.03 * span)])}
    axial = table.get("axial_stiffness_N", table["youngs_modulus_GPa"] * 1e9 * math.pi / 4.0 * (table["diameter_mm"] * 1e-3) ** 2)
    bending = table.get(
        "bending_stiffness_Nm2", table["youngs_modulus_GPa"] * 1e9 * math.pi / 64.0 * (table["diameter_mm"] * 1e-3) ** 4
    )
    for side in draw.choice([[""], [""], ["left_"], ["right_"], ["left_", "right_"]]):
        if draw.maybe(0.25):
            m[f"translational_stiffness_{side}N_m"] = float(f"{axial / (1e-3 * span) * draw.log(0.05, 100.0):.4g}")
        if kind == "clamped" and draw.maybe(0.25):
            m[f"rotational_stiffness_{side}Nm_rad"] = float(f"{bending / (1e-3 * span) * draw.log(0.1, 100.0):.4g}")
    if draw.maybe(0.12):
        m["slip_tension_N"] = float(f"{axial * draw.log(1e-5, 1e-3):.4g}")
        m["slip"] = draw.choice(["feeds", "slides"])
        m["slip_at"] = draw.choice(["left", "right", "both"])
    return m


def generate(seed):
    draw = Draw(seed)
    span = draw.choice([175.0, draw.log(20.0, 2000.0)])
    kind = draw.choice(["clamped", "clamped", "pinned", "supports"])
    table = wire(draw, span, kind == "supports")
    held = mount(draw, span, kind, table)
    pusher = {
        "shape": "cylinder",
        "radius_mm": draw.choice([0.0, draw.log(1e-3, 0.05) * span]),
        "friction": draw.choice([0.0, 0.0, draw.between(0.0, 0.6)]),
        "direction": draw.choice(["outward", "outward", "inward"]),
    }
    pusher["radius_mm"] = float(f"{min(pusher['radius_mm'], 100.0):.4g}")
    plain = (
        kind != "supports" and not {"yield_stress_MPa", "strand_extra_stiffness_Nm2"} & set(table) and "slip" not in held
    )  # what a tilted pusher may meet
    for name, share, value in (
        ("tilt_deg", 0.2, draw.between(-20.0, 20.0)),
        ("compliance_m_N", 0.15, draw.log(1e-8, 1e-4)),
        ("misalignment_deg", 0.15, draw.between(-15.0, 15.0)),
    ):
        if draw.maybe(share) and (name != "tilt_deg" or plain):
            pusher[name] = value
            plain = False
    main = {"schema": "snare-experiment/1", "title": str(seed), "wire": table, "mount": held, "pusher": pusher}
    if draw.maybe(0.1) and kind != "supports":
        main["bulge"] = {"mode": draw.choice([1, 2, 3])}
    if draw.maybe(0.25):
        main["gravity"] = {
            "vector_m_s2": draw.choice(
                [[0.0, -9.81, 0.0], [0.0, 9.81, 0.0], [draw.between(-9.81, 9.81), draw.between(-9.81, 9.81), 0.0], [0.0, 0.0, 9.81]]
            )
        }
    main["solver"] = {"elements": draw.choice([32, 64, 64, 128])}
    if draw.maybe(0.1):
        main["solver"]["instability"] = "switch_branch"
    main["series"] = [series(draw, k, span) for k in range(draw.choice([1, 1, 2, 3]))]
    return Case("push", main)


def series(draw, number, span):
    travel = float(f"{span * draw.log(2e-3, 4e-2):.4g}")
    one = {
        "name": f"s{number}",
        "contact_position_mm": float(f"{span * draw.choice([0.5, draw.uniform(0.1, 0.9)]):.4g}"),
        "points": draw.choice([3, 5, 8]),
    }
    if draw.maybe(0.3):
        one["path_mm"] = draw.choice([[0.0, travel, 0.0], [0.0, travel, 0.5 * travel, travel], [0.0, travel, 0.25 * travel]])
    else:
        one["travel_mm"] = travel
    return one
