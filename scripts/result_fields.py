#!/usr/bin/env python3
"""Writes docs/result_fields.md, every field of every JSON result, from the schemas in data/schemas.

usage: result_fields.py [--check]

--check compares and writes nothing; a test does that.
"""

import json
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs/result_fields.md"
# Schemas, in the order of the page, with what they are.
RESULTS = [("push", "what `snare push --json` prints", "curves_csv"), ("fit", "fit.json of `snare fit`", "trace_json"),
           ("trace", "trace.json of `snare trace`", "trace_json"), ("reproduce", "reproduce.json of `snare reproduce`", "reproduce_json"),
           ("figures", "figures.json of `snare reproduce PAPER`", "papers"),
           ("law", "law.json of `snare distil`", "law_json"), ("comparison", "compare.json of `snare compare`", "law_json"),
           ("summary", "summary.json of `snare simulate`", "summary_json"), ("sweep-summary", "summary.json of `snare sweep`", "sweep_file"),
           ("ringdown-result", "ringdown.json of `snare ringdown`", "ringdown_file"),
           ("arm-show", "what `snare arm show --json` prints", "arm_files"), ("benchmark-result", "benchmark.json of `snare benchmark`", "benchmark_file"),
           ("validation", "validation.json of `snare validate`", None)]
HEAD = """# Every field of every JSON result

Written from the JSON Schemas in [data/schemas](../data/schemas) by `scripts/result_fields.py`; the pages of the formats say more of what
matters. No NaN or infinity occurs; `null` stands where the type has "or null". A field with a question mark is there only where there is
something to say. `*` is a name that the input gives: of a series, a key, a wire.
"""
FORMS = {"of_experiment": "Of an experiment", "of_records": "Of records in time", "one_wire": "One body on one wire", "listed": "A scenario that lists what there is",
         "static": "Static cases", "motion": "A scenario", "arm": "An arm file", "urdf": "A URDF file"}
ARM_OF_SUMMARY = "An arm"
WORDS = {"string": "text"}


def kind(one):
    """The type of a value in words."""
    if "const" in one:
        return f'"{one["const"]}"'
    if "enum" in one:
        return ", ".join(f'"{word}"' for word in one["enum"])
    types = one.get("type", "object")
    types = [types] if isinstance(types, str) else types
    word = next(WORDS.get(t, t) for t in types if t != "null")
    if word == "array":
        inner = one.get("items", {})
        word += f" of {kind(inner)}s" if "type" in inner else ""
        word += f", {one['minItems']}" if "minItems" in one else ""
    return word + (" or null" if "null" in types else "")


def rows(schema, defs, place, shown):
    """Lines of a table; a definition of many fields stands in a table of its own, to which `shown` points."""
    for key, raw in {**schema.get("properties", {}), **schema.get("patternProperties", {})}.items():
        optional = "" if key in schema.get("required", []) else "?"
        name = key.replace("(_[A-Za-z0-9]+)?$", "_UNIT").replace("(declared|base|final)", "STAGE").lstrip("^")
        here, text, inner, reference = f"{place}{name}", raw.get("description", ""), raw, None
        while True:  # down to a table
            if "$ref" in inner:
                reference = inner["$ref"].rsplit("/", 1)[1]
                inner = defs[reference]
                break
            if isinstance(inner.get("items"), dict) and inner["items"].get("type") != "number":
                inner, here = inner["items"], here + "[]"
            elif isinstance(inner.get("additionalProperties"), dict):
                inner, here = inner["additionalProperties"], here + ".*"
            else:
                break
        word = "object" if reference else kind(inner if inner is not raw else raw)
        if reference:
            text += f" See {reference.replace('_', ' ')}."
            shown.append(reference)
        yield f"| `{here}`{optional} | {word} | {text.replace('|', chr(92) + '|')} |"
        if not reference:
            yield from rows(inner, defs, here + ".", shown)


def table(schema, defs, shown):
    return ["| field | type | meaning |", "|---|---|---|", *rows(schema, defs, "", shown), ""]


def section(name, what, page):
    schema = json.loads((ROOT / f"data/schemas/{name}.schema.json").read_text(encoding="utf-8"))
    defs = schema.get("$defs", {})
    lines = ["", f"## {schema['title']}", "", ("The " + what if ".json" in what else "W" + what[1:]) + (f"; [more]({page}.md)." if page else "."), ""]
    shown = []
    if "anyOf" in schema:
        for form in schema["anyOf"]:
            key = form["$ref"].rsplit("/", 1)[1]
            title = ARM_OF_SUMMARY if (name, key) == ("summary", "arm") else FORMS[key]
            lines += [f"### {title}: {schema['title']}", "", *table(defs[key], defs, shown)]
    else:
        lines += table(schema, defs, shown)
    done = []
    while len(done) < len(dict.fromkeys(shown)):
        key = next(k for k in shown if k not in done)
        done.append(key)
        lines += [f"### {key.replace('_', ' ')} of {schema['title']}", "", *table(defs[key], defs, shown)]
    return lines


def page():
    lines = HEAD.splitlines()
    for one in RESULTS:
        lines += section(*one)
    return "\n".join(lines).rstrip("\n").replace("\n\n\n", "\n\n") + "\n"


def main():
    text = page()
    if sys.argv[1:] == ["--check"]:
        if PAGE.read_text(encoding="utf-8") == text:
            return 0
        print("docs/result_fields.md is not what the schemas say: run scripts/result_fields.py")
        return 1
    PAGE.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
