"""Fits of pushes whose forces are known in closed form, with noise: a stretched string, and a beam on supports."""

import math

from cases import Case, Draw


def string(stretch, length, span, at, d):
    """Force of two straight pieces [N], lengths in mm."""
    left, right = math.hypot(at, d), math.hypot(span - at, d)
    tension = stretch * ((left + right) / length - 1.0)
    return tension * (d / left + d / right)


def readings(draw, force, travel, sigma, number):
    rows = [
        f"{travel * k / (number - 1):.6g},{force(travel * k / (number - 1)) + draw.gauss(0.0, sigma):.7g}" for k in range(number)
    ]
    return "displacement_mm,force_N\n" + "\n".join(rows) + "\n"


def generate(seed):
    draw = Draw(seed)
    span = draw.between(100.0, 300.0)
    on_supports = draw.maybe(0.4)
    stretch, bending = draw.log(1e3, 1e5), draw.log(1e-3, 1.0)
    length = round(span * (1.0 if on_supports else 1.0 - draw.log(1e-4, 5e-3)), 5)
    wire = {"construction": "strand", "diameter_mm": draw.between(0.5, 1.5), "length_mm": length, "density_kg_m3": 7000.0}
    factor = draw.log(0.6, 1.6)
    if on_supports:
        wire |= {"length_mm": round(1.2 * span, 5), "bending_stiffness_Nm2": float(f"{bending * factor:.4g}")}
    else:
        wire |= {
            "axial_stiffness_N": float(f"{stretch * factor:.4g}"),
            "bending_stiffness_Nm2": max(1e-15, float(f"{1e-9 * stretch * (1e-3 * span)**2:.3g}")),
        }
    main = {
        "schema": "snare-experiment/1",
        "title": str(seed),
        "wire": wire,
        "mount": (
            {"kind": "supports", "span_mm": span, "support_radius_mm": 0.0} if on_supports else {"kind": "pinned", "span_mm": span}
        ),
        "pusher": {"shape": "cylinder", "radius_mm": 0.0, "friction": 0.0, "direction": "outward"},
        "solver": {"elements": 64},
        "series": [],
    }
    files = {}
    travel = span * (2e-3 if on_supports else draw.between(0.01, 0.03))
    for k in range(draw.choice([1, 2, 3])):
        at = float(f"{span * draw.between(0.25, 0.75):.5g}")

        def force(d, at=at):
            if on_supports:
                return 3.0 * bending * 1e-3 * d * span * 1e-3 / (at * (span - at) * 1e-6) ** 2
            return string(stretch, length, span, at, d)

        sigma = float(f"{draw.log(0.002, 0.02) * force(travel):.3g}")
        files[f"s{k}__csv"] = readings(draw, force, travel, sigma, draw.choice([12, 25]))
        main["series"].append({"name": f"s{k}", "contact_position_mm": at, "file": f"s{k}.csv", "force_sigma_N": sigma})
    free = ["wire.bending_stiffness_Nm2"] if on_supports else ["wire.axial_stiffness_N"]
    extra = draw.random()
    if extra < 0.3:
        free.append("reading.force_offset_N")
    elif extra < 0.5 and not on_supports:
        free.append("wire.length_mm")
    elif extra < 0.6:
        free.append("reading.displacement_offset_mm")
    main["fit"] = {"free": free}
    return Case("fit", main, **files)
