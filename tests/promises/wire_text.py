"""Experiment files about the wire of the published tests, as tests/support/wire_text.hpp has them."""


def experiment(title: str, length_mm: float, more_of_wire: str = "") -> str:
    """All but the series and the solver; `more_of_wire` ends the wire's table."""
    return f"""schema = "snare-experiment/1"
title = "{title}"
source = "a test"
[wire]
construction = "solid"
diameter_mm = 1.5
length_mm = {length_mm}
youngs_modulus_GPa = 193.0
poisson_ratio = 0.29
density_kg_m3 = 7930.0
{more_of_wire}[mount]
kind = "clamped"
span_mm = 175.0
[pusher]
shape = "cylinder"
radius_mm = 6.0
friction = 0.0
direction = "outward"
"""
