"""Snares that close on a pin: rings, carriages, walls, friction, any model of the wires that a snare may have."""

from cases import Case, Draw


def generate(seed):
    draw = Draw(seed)
    radius = draw.choice([100.0, draw.between(40.0, 150.0)])
    diameter = float(f"{radius * draw.between(0.01, 0.02):.4g}")
    wire = {
        "construction": "solid",
        "diameter_mm": diameter,
        "length_mm": float(f"{2.0 * radius * draw.between(0.99, 1.02):.5g}"),
        "youngs_modulus_GPa": draw.log(20.0, 200.0),
        "poisson_ratio": 0.3,
        "density_kg_m3": draw.between(2000.0, 8000.0),
        "model": draw.choice(["quasi_static", "stretched", "stretched"]),
        "elements": 16,
        "bending_stiffness_Nm2": draw.log(1e-4, 1e-2),
    }
    snare = {
        "name": "snare",
        "ring_radius_mm": radius,
        "wires": draw.choice([1, 2, 3, 3]),
        "turns": draw.choice(["left", "right"]),
        "first_wire_deg": draw.between(-90.0, 90.0),
        "ring": {
            "start_deg": draw.between(110.0, 150.0),
            "inertia_kg_m2": draw.log(0.005, 0.05),
            "motor_inertia_kg_m2": draw.log(0.05, 0.5),
        },
        "wire": wire,
    }
    if draw.maybe(0.3):
        snare["carriage"] = {"mass_kg": draw.log(0.5, 5.0)}
    if wire["model"] != "stretched" and draw.maybe(0.5):
        snare["wire_contact"] = {"friction": draw.between(0.05, 0.4)}
    if wire["model"] == "stretched" and snare["wires"] > 1:
        wire["touch_each_other"] = False
    mass = draw.log(0.5, 50.0)
    pin = {
        "name": "pin",
        "frame": "visitor",
        "kind": "capsule",
        "radius_mm": float(f"{0.06 * radius:.4g}"),
        "length_mm": float(f"{0.8 * radius:.4g}"),
    }
    if draw.maybe(0.5):
        pin["friction"] = draw.between(0.05, 0.4)
    off = 0.15 * radius
    body = {
        "name": "visitor",
        "mass_kg": mass,
        "inertia_kg_m2": [float(f"{mass * 0.01 * draw.uniform(0.8, 1.2):.4g}") for _ in range(3)],
        "position_mm": [draw.between(-off, off), draw.between(-off, off), 0.0],
        "velocity_m_s": [draw.between(-0.1, 0.1), draw.between(-0.1, 0.1), 0.0],
    }
    end = draw.between(170.0, 180.0)
    main = {
        "schema": "snare-scenario/2",
        "title": str(seed),
        "duration_s": 0.15,
        "output_interval_s": 0.003,
        "output": {"checkpoint_interval_s": 10.0},
        "snares": [snare],
        "bodies": [body],
        "shapes": [pin],
        "phases": [
            {
                "name": "close",
                "at_s": 0.01,
                "drives": [{"joint": "snare::ring", "mode": "course", "to_deg": end, "rate_deg_s": draw.between(300.0, 700.0)}],
            }
        ],
    }
    if draw.maybe(0.3):
        main["gravity"] = {"vector_m_s2": draw.vector(3.0)}
    return Case("simulate", main)
