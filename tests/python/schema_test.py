"""The schemas of the files: all that is shipped is valid, and the readers know the same keys, ranges and words."""

import json
import re
import subprocess
import sys
import tempfile
import tomllib
import unittest

import setting

try:
    import jsonschema
except ImportError:
    print("skipped: jsonschema is not installed")
    sys.exit(setting.SKIPPED)

NOWHERE = "z" * 29
# A schema, a verb that reads such a file, and a file.
READERS = {"experiment": ("push", "data/experiments/published_static.toml"), "wire": ("distil", "data/wires/traced_published.toml")}
KINDS = [*READERS, "scenario"]
# A scenario with every key, whose elements have what their kind takes.
EVERY_KEY = setting.SOURCE / "tests/data/keys/scenario.toml"
# Keys of a wire that motion refuses.
REFUSED = {"natural_curvature_1_m", "strand_extra_stiffness_Nm2", "strand_slip_curvature_1_m", "yield_stress_MPa", "hardening_ratio"}


def schema_of(kind):
    return json.loads((setting.SOURCE / f"data/schemas/{kind}.schema.json").read_text())


def answer(kind, setting_):
    """What the reader says of one override."""
    verb, file = READERS[kind]
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run([setting.COMMAND, verb, str(setting.SOURCE / file), "--out", folder, "--quiet", "--set", setting_],
                             capture_output=True, text=True, timeout=60)
    return run.stderr if run.returncode == 2 else ""


def tables_of(schema, address=""):
    """Every table of a schema with its address in the reader's words."""
    resolved = schema
    yield address, resolved
    for key, one in resolved["properties"].items():
        if "$ref" in one:
            one = ROOT["$defs"][one["$ref"].rsplit("/", 1)[1]]
            if address:
                continue  # of a series: the same tables
        here = f"{address}.{key}" if address else key
        if one.get("type") == "object":
            yield from tables_of(one, here)
        elif one.get("items", {}).get("type") == "object":
            yield from tables_of(one["items"], f"{here}[1]")


def check_number(test, schema, line, whole=False):
    """The range of a schema is what the reader says that a number must be; where not `whole`, a schema may leave a bound out."""
    wanted = line.split(", must be", 1)[1]
    test.assertEqual("an integer" in wanted, schema["type"] == "integer", line)
    low, high = re.search(r"(>=?) (-?[0-9.e+-]+)", wanted), re.search(r"<= (-?[0-9.e+-]+)", wanted)
    for said, ours in ((low and low.group(2), schema.get("exclusiveMinimum", schema.get("minimum"))),
                       (high and high.group(1), schema.get("maximum"))):
        if said and ours is not None:
            test.assertLessEqual(abs(float(said) - ours), 1e-6 * abs(ours), line)  # messages have seven digits
        elif whole:
            test.assertEqual(said, ours, line)
    if low and (whole or "exclusiveMinimum" in schema or "minimum" in schema):
        test.assertEqual(low.group(1) == ">", "exclusiveMinimum" in schema, line)


class Schemas(unittest.TestCase):
    def test_they_are_schemas_and_say_what_every_key_means(self):
        global ROOT
        for kind in KINDS:
            schema = schema_of(kind)
            jsonschema.Draft202012Validator.check_schema(schema)
            ROOT = schema
            for address, table in tables_of(schema):
                for key, one in table["properties"].items():
                    self.assertTrue("description" in one or "$ref" in one or key == "schema", f"{kind}: {address}.{key}")

    def test_all_files_that_are_shipped_are_valid(self):
        seen = set()
        for path in sorted(setting.SOURCE.glob("data/**/*.toml")) + sorted(setting.SOURCE.glob("examples/*.toml")) + \
                sorted(setting.SOURCE.glob("tests/ranges/*.toml")):
            document = tomllib.loads(path.read_text())
            kind = re.match(r"snare-(\w+)/", document.get("schema", "")) if isinstance(document.get("schema"), str) else None
            if kind and kind.group(1) in KINDS and document["schema"] != "snare-scenario/1":
                seen.add(kind.group(1))
                with self.subTest(path.name):
                    jsonschema.Draft202012Validator(schema_of(kind.group(1))).validate(document)
        self.assertEqual(seen, set(KINDS))

    def test_the_readers_know_the_same_keys(self):
        global ROOT
        for kind in READERS:
            ROOT = schema_of(kind)
            for address, table in tables_of(ROOT):
                prefix = f"{address}." if address else ""
                said = answer(kind, f"{prefix}{NOWHERE}=1")
                found = re.search(r"known here: (.*)$", said, re.M)
                self.assertTrue(found, f"{kind}: {address}: {said}")
                self.assertEqual(set(found.group(1).split(", ")), set(table["properties"]), f"{kind}: [{address}]")

    def test_the_readers_allow_the_same_numbers_and_words(self):
        global ROOT
        compared = 0
        for kind in READERS:
            ROOT = schema_of(kind)
            for address, table in tables_of(ROOT):
                for key, one in table["properties"].items():
                    full = f"{address}.{key}" if address else key
                    said = answer(kind, f"{full}=[\"x\"]")
                    line = next((x for x in said.splitlines() if x.startswith("--set: " + re.sub(r"\[1\]", "", full)) or
                                 re.sub(r"\[[^\]]*\]", "[1]", x).startswith(f"--set: {full} = ")), "")
                    if "enum" in one:
                        words = set(re.findall(r'"(\w+)"', line.split(", must be", 1)[-1]))
                        self.assertEqual(words, set(one["enum"]), f"{kind}: {full}: {line}")
                        compared += 1
                    elif one.get("type") in ("number", "integer") and "must be a" in line:
                        if full != "series[1].points":  # at least 4 behind a published fit, as here, and 2 of a prediction
                            check_number(self, one, line)
                        compared += 1
        self.assertGreater(compared, 60)


def elements_of(document, schema, address=""):
    """Every table of a document with its schema and its address."""
    yield address, document, schema
    for key, value in document.items():
        inner, here = schema["properties"][key], f"{address}.{key}" if address else key
        if isinstance(value, dict):
            yield from elements_of(value, inner, here)
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            for k, element in enumerate(value):
                yield from elements_of(element, inner["items"], f"{here}[{element.get('name', k + 1)}]")


def complaints(settings):
    """What the reader says of overrides of the scenario with every key, a line each; it takes a hundred at a time."""
    lines = []
    for begin in range(0, len(settings), 90):
        command = [setting.COMMAND, "simulate", str(EVERY_KEY), "--quiet", "--out", "/dev/null/none"]
        for one in settings[begin:begin + 90]:
            command += ["--set", one]
        run = subprocess.run(command, capture_output=True, text=True, timeout=60)
        lines += run.stderr.splitlines()
    return lines


class ScenarioSchema(unittest.TestCase):
    def setUp(self):
        self.schema = schema_of("scenario")
        self.elements = [e for e in elements_of(tomllib.loads(EVERY_KEY.read_text()), self.schema) if not e[0].startswith("include")]

    def test_the_file_of_every_key_has_them_all_and_is_valid(self):
        document = tomllib.loads(EVERY_KEY.read_text())
        jsonschema.Draft202012Validator(self.schema).validate(document)
        has = {}
        for address, table, _ in elements_of(document, self.schema):
            has.setdefault(re.sub(r"\[[^\]]*\]", "[1]", address), set()).update(table)
        for address, table in tables_of(self.schema):
            self.assertEqual(set(table["properties"]) - has[address], set(), address)

    def test_the_reader_knows_the_same_keys(self):
        lines = complaints([f"{address}.{NOWHERE}=1".lstrip(".") for address, _, _ in self.elements])
        self.assertEqual(len(lines), len(self.elements))
        known = {}
        for line in lines:
            found = re.match(rf"--set: (?:(.*)\.)?{NOWHERE} = 1, unknown key; known here: (.*)$", line)
            self.assertTrue(found, line)
            known[found.group(1) or ""] = set(found.group(2).split(", "))
        for address, table, schema in self.elements:
            self.assertEqual(known[address] - set(schema["properties"]) - REFUSED, set(), address)
            self.assertEqual(set(table) - known[address], set(), address)

    def test_the_reader_allows_the_same_numbers_and_words(self):
        numbers, words = {}, {}
        for address, table, schema in self.elements:
            for key in table:
                one, full = schema["properties"][key], f"{address}.{key}" if address else key
                if one.get("type") in ("number", "integer"):
                    numbers[full] = one
                elif "enum" in one:
                    words[full] = one
        compared = 0
        for line in complaints([f"{full}=[\"x\"]" for full in numbers]):
            full = re.match(r"--set: (.*?) = ", line)
            if full and full.group(1) in numbers and re.search(r", must be an? (number|integer)", line):
                check_number(self, numbers[full.group(1)], line, whole=True)
                compared += 1
        self.assertGreater(compared, 0.8 * len(numbers))
        for full, one in words.items():
            line = next(x for x in complaints([f"{full}=\"{NOWHERE}\""]) if x.startswith(f"--set: {full} = "))
            self.assertEqual(set(re.findall(r'"(\w+)"', line.split(", must be", 1)[1])), set(one["enum"]), line)


if __name__ == "__main__":
    setting.main()
