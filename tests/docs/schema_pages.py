#!/usr/bin/env python3
"""Every key and field of the JSON Schemas stands in a page of the documentation, and a description says its unit.

usage: schema_pages.py REPOSITORY

A key is documented when its page has it as a word of code. A number whose name carries a unit has that unit, in brackets, in the
description of its schema.
"""

import json
import pathlib
import re
import sys

# The pages in which the keys of an input stand; the first is the page of that format. Results have theirs in one generated page.
PAGES = {
    "experiment": ["experiment_file"], "wire": ["wire_file", "experiment_file", "scenario_file"], "scenario": ["scenario_file", "experiment_file"],
    "arm": ["arm_files"], "ringdown": ["ringdown_file", "experiment_file"], "record": ["record_file"], "sweep": ["sweep_file"],
    "benchmark": ["benchmark_file"],
}
RESULTS = ["result_fields"]
# Ends of names that are units, and what the description has for them.
UNITS = {"mm": "mm", "m": "m", "deg": "deg", "N": "N", "Nm": "N m", "s": "s", "kg": "kg", "J": "J", "Hz": "Hz", "Nm2": "N m^2",
         "m_s": "m/s", "rad_s": "rad/s", "GPa": "GPa", "MPa": "MPa", "kg_m3": "kg/m^3", "kg_m2": "kg m^2", "N_m": "N/m", "Nm_rad": "N m/rad",
         "Nms_rad": "N m s/rad", "Ns_m": "N s/m", "m_s2": "m/s^2", "1_m": "1/m", "1_s": "1/s", "deg_s": "deg/s", "N_m2": "N/m^2", "s_m": "s/m",
         "Ns": "N s", "Nms": "N m s", "N_mm": "N/mm", "mm_s": "mm/s", "m_N": "m/N", "um_N": "um/N", "rad_Nm": "rad/(N m)"}


def unit_of(name):
    """The unit that a name ends in, or None: the longest end that is one."""
    parts = name.split("_")
    for k in range(1, len(parts)):
        unit = "_".join(parts[k:])
        if unit in UNITS:
            return UNITS[unit]
    return None


def properties_of(node):
    """Every (name, schema) of a schema, wherever it stands."""
    if isinstance(node, dict):
        if isinstance(node.get("properties"), dict) and ("type" in node or "additionalProperties" in node):
            yield from node["properties"].items()
        for value in node.values():
            yield from properties_of(value)
    elif isinstance(node, list):
        for value in node:
            yield from properties_of(value)


def problems_of(name, schema, pages):
    """What is missing: of a schema, and of the texts of its pages."""
    words = set()
    for text in pages:
        for code in re.findall(r"```.*?```|`[^`\n]+`", text, re.S):
            words.update(re.findall(r"[A-Za-z0-9_]+", code))
    problems, seen = [], set()
    for key, one in properties_of(schema):
        if key not in words and key not in seen and key != "schema":
            problems.append(f"{name}: {key} is in no page: {PAGES.get(name, RESULTS)[0]}.md")
        seen.add(key)
        if key != "schema" and not one.get("description") and "$ref" not in one:
            problems.append(f"{name}: {key} has no description")
        unit = unit_of(key)
        if unit and one.get("type") in ("number", ["number", "null"]) and f"[{unit}" not in one.get("description", ""):
            problems.append(f"{name}: {key} has no unit in its description, [{unit}]")
    return sorted(set(problems))


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    root = pathlib.Path(sys.argv[1])
    problems = []
    for path in sorted((root / "data/schemas").glob("*.schema.json")):
        name = path.name.removesuffix(".schema.json")
        pages = [root / "docs" / f"{page}.md" for page in PAGES.get(name, RESULTS)]
        problems += [f"{page} is missing" for page in pages if not page.is_file()]
        problems += problems_of(name, json.loads(path.read_text(encoding="utf-8")),
                                [page.read_text(encoding="utf-8") for page in pages if page.is_file()])
    for problem in problems:
        print(problem)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
