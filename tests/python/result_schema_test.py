"""The schemas of the results: what every verb writes is valid, and every field of a schema is written by one of the runs here."""

import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import setting

try:
    import jsonschema
except ImportError:
    print("skipped: jsonschema is not installed")
    sys.exit(setting.SKIPPED)

# Numbers that the readings and the record cannot tell apart.
PUSH_TOGETHER = ["tests/ranges/readings.toml", "--set",
                 'fit.free=["wire.bending_stiffness_Nm2","wire.axial_stiffness_N","reading.force_gain"]']
RECORD_TOGETHER = ["WORK/spring_record.toml"]
# Arguments of the command; small things that write between them what there is to write.
RUNS = {
    "push": ["push", "tests/ranges/readings.toml", "--json"],
    "push_law": ["push", "data/experiments/published_static.toml", "--json", "--set", "solver.elements=16"],
    "fit": ["fit", "tests/ranges/readings.toml", "--set", "series[1].contact_position_sigma_mm=0.05"],
    "fit_record": ["fit", "WORK/records.toml", "--set", 'fit.profile=["arms[pendulum].joint.bearing.viscous_Nms_rad"]'],
    "fit_together": ["fit", *PUSH_TOGETHER],
    "trace_together": ["trace", *PUSH_TOGETHER],
    "fit_record_together": ["fit", *RECORD_TOGETHER],
    "trace_record_together": ["trace", *RECORD_TOGETHER],
    "trace": ["trace", "tests/ranges/readings.toml", "--set", "series[1].contact_position_sigma_mm=0.05"],
    "trace_law": ["trace", "data/experiments/published_static.toml", "--set", "solver.elements=16", "--set", "solver.extrapolate=false"],
    "trace_record": ["trace", "tests/ranges/record.toml", "--set", "fit.most_effects=1", "--set",
                     'fit.free=["arms[pendulum].rates_deg_s[1]"]', "--set", "scenario.arms[pendulum].joint.bearing.viscous_Nms_rad=0.0",
                     "--set", 'fit.profile=["arms[pendulum].rates_deg_s[1]"]'],
    "trace_record_families": ["trace", "WORK/records.toml"],
    "trace_outside": ["trace", "WORK/outside.toml", "--set", "wire.diameter_mm=1.5", "--set", "solver.elements=32"],
    "distil": ["distil", "WORK/wire.toml"],
    "compare": ["compare", "tests/ranges/readings.toml"],
    "compare_motion": ["compare", "tests/ranges/composed.toml", "--set", "duration_s=0.02"],
    "ringdown": ["ringdown", "data/experiments/ringdown.toml"],
    "listed": ["simulate", "tests/ranges/composed.toml", "--set", "duration_s=0.02"],
    "swings": ["simulate", "data/scenarios/ssrms_rigidize.toml", "--set", "duration_s=0.05", "--set", "output.modes=true"],
    "one_wire": ["simulate", "data/scenarios/air_table.toml", "--set", "duration_s=0.01", "--set", "wires[wire].elements=8",
                 "--set", "wires[wire].strength_N=100"],
    "arm_on_wire": ["simulate", "data/scenarios/jemrms_payload_on_wire.toml", "--set", "duration_s=0.001", "--set", "output_interval_s=0.0005"],
    "arm_step": ["simulate", "data/scenarios/jemrms_step.toml"],
    "sweep": ["sweep", "WORK/sweep.toml"],
    "sweep_sobol": ["sweep", "WORK/sobol.toml"],
    "sweep_subset": ["sweep", "WORK/subset.toml"],
    "benchmark": ["benchmark", "--case", "push_middle"],
    "arm": ["arm", "show", "data/arms/jemrms_like.toml", "--json"],
    "urdf": ["arm", "show", "data/arms/jemrms_like.urdf", "--json"],
}
# A mass on a spring without damping: the motion depends on their quotient alone.
SPRING = """schema = "snare-scenario/2"
title = "block"
duration_s = 1.0
output_interval_s = 0.02
[[bodies]]
name = "block"
mass_kg = 5.0
inertia_kg_m2 = [1.0, 1.0, 1.0]
velocity_m_s = [0.02, 0.0, 0.0]
[[bushings]]
name = "spring"
frame = "world"
other_frame = "block"
translational_stiffness_N_m = 200.0
rotational_stiffness_Nm_rad = 100.0
[[sensors]]
name = "place"
kind = "position"
frame = "block"
"""
SPRING_RECORD = """schema = "snare-record/1"
title = "block on a spring"
scenario = "spring.toml"
[[records]]
name = "first"
file = "spring.csv"
columns = { x_mm = "place_x_mm" }
sigma = 0.01
[fit]
free = ["bodies[block].mass_kg", "bushings[spring].translational_stiffness_N_m"]
most_effects = 0
"""
# Schemas of results that take longer: the test of the fields does not ask for them.
LONG = {"snare-reproduce/1", "snare-figures/1", "snare-validation/1"}
# What a wire file says of losses and of a record's offset.
LOSSES = """displacement_offsets_mm = [0.1]

[damping]
bending_time_s = 1e-5
axial_time_s   = 1e-5
mass_rate_1_s  = 5.0
impact_speeds_m_s = [0.1]
impact_mass_kg = 8.9
elements       = 20
"""
# What a record file says of another kind of model.
FAMILY = """
[[fit.families]]
name = "fine"
set  = { "solver.relative_tolerance" = 1e-6 }
"""
# Fields that none of the runs has a reason to write.
NOT_HERE = {
    "snare-ringdown-result/1": {f"series[].friction_mm_s.{k}" for k in ("value", "stderr", "lower", "upper")},  # no friction in the record
    "snare-trace/1": {"next_experiment.difference_N", "next_experiment.difference_sigma", "remaining.hangs_on[].sensor",
                      "remaining.hangs_on[].on", "remaining.hangs_on[].share",  # nothing to tell apart, nothing left
                      "outside.variable", "outside.probability",  # the cause is in the catalogue
                      "partial.model", "partial.heldout"},  # of records: nothing that helps without explaining
    "snare-benchmark-result/1": {f"cases[].models[].outcome.*.{k}" for k in ("value", "reference", "same")},  # a push that has none
    "snare-comparison/1": {"models[].from_full.first_touch_s", "models[].from_full.tight_s"},  # too short to touch
}


def schemas():
    found = {}
    for path in sorted((setting.SOURCE / "data/schemas").glob("*.schema.json")):
        schema = json.loads(path.read_text())
        found[schema["title"]] = schema
    return found


def forms_of(schema):
    """The schemas of which a document must fit one."""
    return [{**schema["$defs"][one["$ref"].rsplit("/", 1)[1]], "$defs": schema["$defs"]} for one in schema["anyOf"]] \
        if "anyOf" in schema else [schema]


def resolve(schema, root):
    return root["$defs"][schema["$ref"].rsplit("/", 1)[1]] if "$ref" in schema else schema


def mistakes(document, schema):
    """What the form that fits best objects to."""
    found = [list(jsonschema.Draft202012Validator(form).iter_errors(document)) for form in forms_of(schema)]
    return [f"{'.'.join(map(str, one.absolute_path))}: {one.message[:300]}" for one in min(found, key=len)]


def properties_of(schema, root, place=""):
    """Every field of a schema by its place; those of a definition by its name, wherever it is used."""
    if "$ref" in schema:
        place = schema["$ref"].rsplit("/", 1)[1]
        schema = resolve(schema, root)
    for key, one in {**schema.get("properties", {}), **schema.get("patternProperties", {})}.items():
        here = f"{place}.{key}".lstrip(".")
        yield here
        yield from properties_of(one, root, here)
    if isinstance(schema.get("additionalProperties"), dict):
        yield from properties_of(schema["additionalProperties"], root, place + ".*")
    if "items" in schema:
        yield from properties_of(schema["items"], root, place + "[]")


def fields_of(document, schema, root, place=""):
    """Those of them that a document has."""
    if "$ref" in schema:
        place = schema["$ref"].rsplit("/", 1)[1]
        schema = resolve(schema, root)
    if isinstance(document, list):
        for one in document:
            yield from fields_of(one, schema.get("items", {}), root, place + "[]")
    if not isinstance(document, dict):
        return
    for key, value in document.items():
        pattern = next((p for p in schema.get("patternProperties", {}) if re.search(p, key)), None)
        if key in schema.get("properties", {}) or pattern:
            here = f"{place}.{pattern or key}".lstrip(".")
            yield here
            yield from fields_of(value, schema["patternProperties"][pattern] if pattern else schema["properties"][key], root, here)
        elif isinstance(schema.get("additionalProperties"), dict):
            yield from fields_of(value, schema["additionalProperties"], root, place + ".*")


def prepare(work):
    """Files of runs that write what the shipped ones do not."""
    ranges = setting.SOURCE / "tests/ranges"
    record = (ranges / "record.toml").read_text().replace('"swing.', f'"{ranges}/swing.')
    second = record.split("[[records]]")[1].split("[fit]")[0].replace('"first"', '"second"')
    (work / "records.toml").write_text(record.replace("[fit]", f'[[records]]{second}\n[fit]\nheldout = ["second"]\n') + FAMILY)
    (work / "spring.toml").write_text(SPRING)
    (work / "spring_record.toml").write_text(SPRING_RECORD)
    swing = math.sqrt(200.0 / 5.0)
    (work / "spring.csv").write_text("time_s,x_mm\n" + "".join(
        f"{0.02 * i:.2f},{20.0 / swing * math.sin(swing * 0.02 * i) + 0.01 * math.sin(7.0 * i * i):.6f}\n" for i in range(50)))
    # Forces that nothing in the catalogue has, of a wire three times as stiff as one of its metal can be.
    lines = (ranges / "readings.csv").read_text().splitlines()
    rows = [[float(x) for x in line.split(",")] for line in lines if line[0].isdigit()]
    (work / "outside.csv").write_text("displacement_mm,force_N\n" + "".join(
        f"{d},{3.0 * f * (1.0 + 0.3 * math.sin(3.0 * d)):.3f}\n" for d, f in rows))
    (work / "outside.toml").write_text((ranges / "readings.toml").read_text().replace("readings.csv", "outside.csv"))
    wire = (ranges / "wire.toml").read_text()
    (work / "wire.toml").write_text(wire.replace("friction  = 0.0", "friction  = 0.1") + LOSSES)
    sweep = (ranges / "sweep.toml").read_text().replace('"readings.toml"', f'"{ranges}/readings.toml"')
    sweep = sweep.replace("[collect]", '[collect]\nheld = "series[s60].in_contact_at_end"')
    (work / "sweep.toml").write_text(sweep + '\n[histories]\ncolumns = "all"\n')
    free = sweep.split("[[correlate]]")[0] + "[collect]" + sweep.split("[collect]")[1]
    (work / "sobol.toml").write_text(free.replace('"latin_hypercube"', '"sensitivity"').replace("cases = 4", "cases = 24"))
    (work / "subset.toml").write_text(free.replace('"latin_hypercube"', '"subset"').replace("cases = 4", "cases = 20") +
                                      "\n[subset]\nlevel_probability = 0.5\nlevels = 2\n")


class ResultSchemas(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.schemas = schemas()
        cls.results = {}
        with tempfile.TemporaryDirectory() as folder:
            work = pathlib.Path(folder)
            prepare(work)
            for name, arguments in RUNS.items():
                out = work / name
                command = [setting.COMMAND] + [a.replace("WORK", folder) for a in arguments]
                if arguments[0] != "arm":
                    command += ["--quiet", "--threads", "1", "--out", str(out)]
                run = subprocess.run(command, cwd=setting.SOURCE, capture_output=True, text=True, timeout=300)
                assert run.returncode == 0, f"{name}: {run.stderr}"
                written = sorted(out.glob("*.json")) if out.exists() else []
                cls.results[name] = [json.loads(path.read_text()) for path in written]
                if "--json" in arguments:
                    cls.results[name].append(json.loads(run.stdout))
                assert cls.results[name], f"{name} has no result"

    def test_they_are_schemas(self):
        for schema in self.schemas.values():
            jsonschema.Draft202012Validator.check_schema(schema)

    def test_all_results_are_valid(self):
        for name, documents in self.results.items():
            for document in documents:
                self.assertEqual(mistakes(document, self.schemas[document["schema"]]), [], name)

    def test_a_field_more_or_less_is_seen(self):
        for name, (document, *_) in self.results.items():
            schema = self.schemas[document["schema"]]
            self.assertTrue(mistakes({**document, "more": 1}, schema), name)
            self.assertTrue(mistakes({k: v for k, v in document.items() if k != "title"}, schema), name)

    def test_every_field_of_a_schema_is_written(self):
        missing = {}
        for title in {d["schema"] for documents in self.results.values() for d in documents} - LONG:
            written = [d for documents in self.results.values() for d in documents if d["schema"] == title]
            for k, form in enumerate(forms_of(self.schemas[title])):
                fitting = [d for d in written if not any(jsonschema.Draft202012Validator(form).iter_errors(d))]
                seen = {f for d in fitting for f in fields_of(d, form, form)}
                left = set(properties_of(form, form)) - seen - NOT_HERE.get(title, set())
                if left:
                    missing[f"{title} {k}"] = sorted(left)
        self.assertEqual(missing, {}, json.dumps(missing, indent=1))


if __name__ == "__main__":
    setting.main()
