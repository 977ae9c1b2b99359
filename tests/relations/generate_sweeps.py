"""Sweeps over a push or a motion drawn by the other generators."""

from cases import Case, Draw
import generate_bodies
import generate_push


def generate(seed):
    draw = Draw(seed)
    push = draw.maybe(0.5)
    inner = (generate_push if push else generate_bodies).generate(f"{seed} inside").main
    if push:
        inner["series"] = inner["series"][:1]
        keys = [
            ("wire.diameter_mm", inner["wire"]["diameter_mm"]),
            ("series[s0].contact_position_mm", inner["series"][0]["contact_position_mm"]),
        ]
        collect = {"force": "series[s0].largest_force_N"}
    else:
        b = inner["bodies"][0]
        keys = [("bodies[b0].mass_kg", b["mass_kg"]), ("bodies[b0].velocity_m_s[1]", b["velocity_m_s"][0])]
        collect = {"end": "bodies[b0].position_after_mm[1]", "kinetic": "energy_J.kinetic"}
        inner["duration_s"] = 0.1
    vary = [{"key": key, "values": [float(f"{value * f:.5g}") for f in (0.97, 1.02)]} for key, value in keys]
    return Case(
        "sweep",
        {
            "schema": "snare-sweep/1",
            "title": str(seed),
            "case": "inner.toml",
            "verb": "push" if push else "simulate",
            "design": "grid",
            "vary": vary,
            "collect": collect,
        },
        inner__toml=inner,
    )
