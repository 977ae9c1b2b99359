"""Motions: bodies with every shape, wires of every model between the world and bodies, contact with friction, weight, damping."""

import math

from cases import Case, Draw


def section(draw, span):
    diameter = draw.log(span / 300.0, span / 60.0)
    table = {
        "construction": draw.choice(["solid", "strand"]),
        "diameter_mm": diameter,
        "youngs_modulus_GPa": draw.log(3.0, 210.0),
        "poisson_ratio": draw.between(0.0, 0.4),
        "density_kg_m3": draw.log(1000.0, 15000.0),
    }
    bending = table["youngs_modulus_GPa"] * 1e9 * math.pi / 64.0 * (1e-3 * diameter) ** 4
    if table["construction"] == "strand":
        table["bending_stiffness_Nm2"] = bending = float(f"{bending * draw.log(0.05, 0.8):.4g}")
        if draw.maybe(0.3):
            table["strand_extra_stiffness_Nm2"] = float(f"{bending * draw.log(0.1, 2.0):.4g}")
            table["strand_slip_curvature_1_m"] = draw.log(0.2, 5.0)
    return table


def friction(draw):
    if draw.maybe(0.5):
        return {}
    table = {"friction": draw.between(0.05, 0.6)}
    kind = draw.random()
    if kind < 0.3:
        table["law"] = "smooth"
    elif kind < 0.6:
        table["static_friction"] = float(f"{table['friction'] * draw.between(1.0, 2.0):.4g}")
    return table


def shape(draw, name, radius, law):
    kind = draw.choice(
        ["capsule", "cylinder", "knife_edge"]
        if law
        else ["capsule", "capsule", "sphere", "cylinder", "knife_edge", "grapple_shaft", "revolved"]
    )
    table = {"name": f"{name}_tip", "frame": name, "kind": kind}
    if kind in ("capsule", "cylinder"):
        table |= {"radius_mm": radius, "length_mm": draw.between(40.0, 90.0)}
    elif kind == "sphere":
        table |= {"radius_mm": max(radius, draw.between(5.0, 20.0))}
    elif kind == "knife_edge":
        table |= {"length_mm": draw.between(40.0, 90.0)}
    elif kind == "revolved":
        table |= {"radius_mm": [0.0, radius, 1.5 * radius, 0.0], "height_mm": [-30.0, -30.0, 30.0, 30.0]}
    else:
        table["position_mm"] = [0.0, 0.0, -30.0]
    return {**table, **friction(draw)}


def body(draw, name, at, reach, speed):
    mass = draw.log(0.05, 50.0)
    size = draw.log(0.02, 0.1)
    table = {
        "name": name,
        "mass_kg": mass,
        "inertia_kg_m2": [float(f"{mass * size**2 * draw.uniform(0.8, 1.2):.4g}") for _ in range(3)],
        "position_mm": at,
    }
    table["velocity_m_s"] = [float(f"{v:.4g}") for v in speed]
    if draw.maybe(0.5):
        table["spin_rad_s"] = draw.vector(2.0)
    if draw.maybe(0.4):
        table["rotation_deg"] = draw.vector(20.0)
    if draw.maybe(0.3):
        table["com_mm"] = draw.vector(reach)
    if draw.maybe(0.2):
        table["force_N"] = draw.vector(0.5 * mass)
    if draw.maybe(0.15):
        table["drag_Ns_m"] = draw.log(0.01, 1.0)
    if draw.maybe(0.15):
        table["drag_Nms_rad"] = draw.log(1e-5, 1e-3)
    return table


def generate(seed):
    draw = Draw(seed)
    main = {"schema": "snare-scenario/2", "title": str(seed), "duration_s": draw.choice([0.02, 0.03]), "output_interval_s": 0.001}
    main["damping"] = {"bending_time_s": draw.choice([1e-4, 1e-3]), "axial_time_s": 1e-5}
    main["output"] = {"checkpoint_interval_s": 10.0}
    span = draw.choice([175.0, draw.log(80.0, 400.0)])
    wires, bodies, shapes, contacts = [], [], [], []
    model = draw.choice(["full", "full", "quasi_static", "quasi_static", "stretched", "quadratic"])
    law = model in ("stretched", "quadratic")
    on_body = draw.maybe(0.2) and model != "quadratic"
    for k in range(draw.choice([1, 1, 2])):
        table = section(draw, span)
        slack = draw.choice([draw.log(1e-3, 0.05), draw.log(1e-3, 0.02), -draw.log(1e-4, 3e-3)])
        one = {
            "name": f"w{k}",
            **table,
            "length_mm": round(span * (1.0 + slack), 4),
            "from_mm": [0.0, 0.0, 40.0 * k],
            "to_mm": [span, 0.0, 40.0 * k],
            "bulge": [0.0, draw.choice([1.0, 1.0, -1.0]), 0.0],
            "elements": draw.choice([8, 12, 16]),
            "mount": draw.choice(["clamped", "pinned"]),
            "model": model,
        }
        if model == "full" and draw.maybe(0.3):
            one["formulation"] = "vertices"
        if law:
            one["mount"] = "pinned"
        if model == "quadratic":
            one["quadratic"] = {
                "position_mm": float(f"{span * draw.uniform(0.3, 0.7):.4g}"),
                "A_N_m2": draw.log(1e4, 1e6),
                "B_N_m": draw.log(10.0, 1e3),
                "C_N": draw.choice([0.0, draw.between(0.05, 0.5)]),
            }
        if on_body:
            one.pop("strand_extra_stiffness_Nm2", None)
            one.pop("strand_slip_curvature_1_m", None)
            one["to_frame"] = "holder"
            one["to_mm"] = [0.0, 0.0, 40.0 * k]
        wires.append(one)
    if model == "full" and not on_body and draw.maybe(0.2):
        main["damping"]["mass_rate_1_s"] = draw.between(0.5, 20.0)
    if on_body:
        bodies.append({**body(draw, "holder", [span, 0.0, 0.0], 0.0, [0.0, 0.0, 0.0]), "mass_kg": draw.between(1.0, 20.0)})
        bodies[-1].pop("rotation_deg", None)
        bodies[-1].pop("com_mm", None)
        if draw.maybe(0.5):
            main.setdefault("bushings", []).append(
                {
                    "name": "stand",
                    "frame": "world",
                    "other_frame": "holder",
                    "translational_stiffness_N_m": draw.log(1e3, 1e6),
                    "rotational_stiffness_Nm_rad": draw.log(10.0, 1e3),
                    "translational_damping_Ns_m": draw.log(1.0, 100.0),
                }
            )
    radius = draw.between(2.0, 8.0)
    sag = span * math.sqrt(max(0.0, wires[0]["length_mm"] / span - 1.0)) * 0.7
    below = wires[0]["bulge"][1] < 0.0 or any(w["bulge"][1] < 0.0 for w in wires)
    start = -(sag if below else 0.0) - 2.5 * radius - 20.0
    speed = draw.log(0.05, 3.0)
    if law or draw.maybe(0.85):
        bodies.append(
            body(
                draw,
                "b",
                [round(span * draw.uniform(0.25, 0.75), 3), round(start, 3), draw.between(-3.0, 3.0)],
                5.0,
                [0.1 * speed * draw.gauss(0, 1), speed, 0.1 * speed * draw.gauss(0, 1)],
            )
        )
        if draw.maybe(0.7):  # begins beside the wire
            bodies[-1]["position_mm"][1] = round(start + 18.0, 3) if not below else bodies[-1]["position_mm"][1]
        shapes.append(shape(draw, "b", radius, law))
    if not law and draw.maybe(0.2):
        shapes.append(
            {
                "name": "post",
                "frame": "world",
                "kind": "capsule",
                "radius_mm": 3.0,
                "length_mm": 60.0,
                "position_mm": [round(0.5 * span, 3), round(sag + 6.0, 3), 0.0],
                **friction(draw),
            }
        )
    if len(wires) == 2 and draw.maybe(0.3) and model in ("full", "quasi_static"):
        wires[1]["from_mm"][2], wires[1]["to_mm"][2] = -2.0 * wires[1]["diameter_mm"] - 2.0, -2.0 * wires[1]["diameter_mm"] - 2.0
        contacts.append({"name": "pair", "wire": "w0", "other_wire": "w1", **friction(draw)})
    if draw.maybe(0.4):
        main["gravity"] = {"vector_m_s2": draw.choice([[0.0, -9.81, 0.0], [0.0, 0.0, -9.81], draw.vector(9.81)])}
    for name, value in (("wires", wires), ("bodies", bodies), ("shapes", shapes), ("contacts", contacts)):
        if value:
            main[name] = value
    return Case("simulate", main)
