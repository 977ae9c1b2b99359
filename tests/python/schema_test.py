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
# Keys that are read only beside others, and those.
BESIDE = {"mount.slip": ["mount.slip_tension_N=5.0"], "mount.slip_at": ["mount.slip_tension_N=5.0"]}
# A schema, a verb that reads such a file, and a file.
READERS = {"experiment": ("push", "data/experiments/published_static.toml"), "wire": ("distil", "data/wires/traced_published.toml")}
# A schema, the verb that reads such a file, and files that have every key between them, in elements of every kind.
EVERY_KEY = {"scenario": (["simulate"], ["scenario"]), "arm": (["arm", "show"], ["arm", "arm_geared"]), "ringdown": (["ringdown"], ["ringdown"]),
             "record": (["fit"], ["record"]), "sweep": (["sweep"], ["sweep", "sweep_grid", "sweep_table"]), "benchmark": (["benchmark"], ["benchmark"])}
KINDS = [*READERS, *EVERY_KEY]
# Keys of a wire and its mounts that motion refuses, which its readers know.
REFUSED = {"natural_curvature_1_m", "strand_slip_breadth", "yield_stress_MPa", "hardening_ratio",
           "slip_tension_N", "slip", "slip_at", "rotational_stiffness_Nm_rad", "translational_stiffness_N_m",
           "translational_stiffness_left_N_m", "translational_stiffness_right_N_m", "rotational_stiffness_left_Nm_rad",
           "rotational_stiffness_right_Nm_rad", "support_radius_mm"}


def schema_of(kind):
    return json.loads((setting.SOURCE / f"data/schemas/{kind}.schema.json").read_text())


def answer(kind, *settings):
    """What the reader says of overrides."""
    verb, file = READERS[kind]
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run([setting.COMMAND, verb, str(setting.SOURCE / file), "--out", folder, "--quiet", *(word for one in settings for word in ("--set", one))],
                             capture_output=True, text=True, timeout=60)
    return run.stderr if run.returncode == 2 else ""


def table_form(schema):
    """Of what may be a name or a table: the table."""
    return next((form for form in schema.get("anyOf", []) if "properties" in form), schema)


def tables_of(schema, address=""):
    """Every table of a schema with its address in the reader's words."""
    yield address, schema
    for key, one in schema["properties"].items():
        if "$ref" in one:
            one = ROOT["$defs"][one["$ref"].rsplit("/", 1)[1]]
            if address:
                continue  # of a series: the same tables
        here = f"{address}.{key}" if address else key
        one = table_form(one)
        if one.get("type") == "object":
            if "properties" in one:
                yield from tables_of(one, here)
            elif "$ref" in one["additionalProperties"]:  # tables whose names the user chose
                yield from tables_of(ROOT["$defs"][one["additionalProperties"]["$ref"].rsplit("/", 1)[1]], f"{here}.NAME")
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
            if kind and kind.group(1) in KINDS:
                seen.add(kind.group(1))
                with self.subTest(path.name):
                    schema = schema_of(kind.group(1))
                    if path.parent.name == "parts":  # of others, which say how long they last
                        schema = {**schema, "required": ["schema"]}
                    jsonschema.Draft202012Validator(schema).validate(document)
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
                    said = answer(kind, f"{full}=[\"x\"]", *BESIDE.get(full, []))
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


def resolve(schema, root):
    return root["$defs"][schema["$ref"].rsplit("/", 1)[1]] if "$ref" in schema else schema


def elements_of(document, schema, root, address=""):
    """Every table of a document with its schema and its address; of tables whose keys the user chose only what is in them."""
    if "properties" in schema:
        yield address, document, schema
    for key, value in document.items():
        inner = resolve(schema.get("properties", {}).get(key, schema["additionalProperties"]), root) if schema["additionalProperties"] else \
            resolve(schema["properties"][key], root)
        here = f"{address}.{key}" if address else key
        inner = table_form(inner)
        if isinstance(value, dict) and "anyOf" not in inner:
            yield from elements_of(value, inner, root, here)
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            for k, element in enumerate(value):
                yield from elements_of(element, inner["items"], root, f"{here}[{element.get('name', k + 1)}]")


def general(address):
    """Without the names of elements and of tables that the user named."""
    return re.sub(r"^(joint|link)\.\w+", r"\1.NAME", re.sub(r"\[[^\]]*\]", "[1]", address))


def complaints(kind, file, settings):
    """What the reader says of overrides of a file with every key, a line each; it takes a hundred at a time."""
    lines = []
    verb = EVERY_KEY[kind][0]
    for begin in range(0, len(settings), 90):
        command = [setting.COMMAND, *verb, str(file)] + ([] if kind == "arm" else ["--quiet", "--out", "/dev/null/none"])
        for one in settings[begin:begin + 90]:
            command += ["--set", one]
        run = subprocess.run(command, capture_output=True, text=True, timeout=60)
        lines += run.stderr.splitlines()
    return lines


class EveryKey(unittest.TestCase):
    def setUp(self):
        self.files = []  # kind, file, document, its schema, its tables
        for kind, (_, names) in EVERY_KEY.items():
            schema = schema_of(kind)
            for name in names:
                file = setting.SOURCE / f"tests/data/keys/{name}.toml"
                document = tomllib.loads(file.read_text())
                tables = [e for e in elements_of(document, schema, schema) if not e[0].startswith("include")]
                self.files.append((kind, file, document, schema, tables))

    def test_the_files_of_every_key_have_them_all_and_are_valid(self):
        global ROOT
        has = {}
        for kind, file, document, schema, _ in self.files:
            jsonschema.Draft202012Validator(schema).validate(document)
            for address, table, _ in elements_of(document, schema, schema):
                where = general(address)
                for alias in (where, "joint.NAME") if where == "every_joint" else (where, "every_joint") if where == "joint.NAME" else (where,):
                    has.setdefault((kind, alias), set()).update(table)
        for kind in EVERY_KEY:
            ROOT = schema_of(kind)
            for address, table in tables_of(ROOT):
                self.assertEqual(set(table["properties"]) - has.get((kind, address), set()), set(), f"{kind}: {address}")

    def test_the_readers_know_the_same_keys(self):
        for kind, file, _, _, tables in self.files:
            lines = complaints(kind, file, [f"{address}.{NOWHERE}=1".lstrip(".") for address, _, _ in tables])
            self.assertEqual(len(lines), len(tables), f"{file}: {lines}")
            known = {}
            for line in lines:
                found = re.match(rf"--set: (?:(.*)\.)?{NOWHERE} = 1, unknown key; known here: (.*)$", line)
                self.assertTrue(found, line)
                known[found.group(1) or ""] = set(found.group(2).split(", "))
            for address, table, schema in tables:
                self.assertEqual(known[address] - set(schema["properties"]) - REFUSED, set(), f"{file}: {address}")
                self.assertEqual(set(table) - known[address], set(), f"{file}: {address}")

    def test_the_readers_allow_the_same_numbers_and_words(self):
        for kind, file, _, root, tables in self.files:
            numbers, words = {}, {}
            for address, table, schema in tables:
                for key in table:
                    one, full = resolve(schema["properties"][key], root), f"{address}.{key}" if address else key
                    if one.get("type") in ("number", "integer"):
                        numbers[full] = one
                    elif "enum" in one:
                        words[full] = one
            compared = 0
            for line in complaints(kind, file, [f"{full}=[\"x\"]" for full in numbers]):
                full = re.match(r"--set: (.*?) = ", line)
                if full and full.group(1) in numbers and re.search(r", must be an? (number|integer)", line):
                    check_number(self, numbers[full.group(1)], line, whole=True)
                    compared += 1
            self.assertGreaterEqual(compared, 0.8 * len(numbers), file)
            for full, one in words.items():
                said = complaints(kind, file, [f"{full}=\"{NOWHERE}\""])
                line = next((x for x in said if f": {full} = " in x), None)
                self.assertIsNotNone(line, f"{file}: {full}: {said}")
                known = line.split(", must be", 1)[1]
                if (kind, full) == ("sweep", "verb"):  # those of the case's schema
                    self.assertLessEqual({"push", "fit", "trace"}, set(one["enum"]), line)
                else:
                    self.assertEqual(set(re.findall(r'"(\w+)"', known)), set(one["enum"]), line)


# Texts that may be names or not, all of them in some list of some file.
TEXTS = ["a", "A_b-c.d", "1", "_x", "a b", "a+(b)", "\u00c4rmel", "\u540d", "", " ", " a", "-a", ".a", "(a", "+", "a<b", "../x", "a/b", "a\\b", "a:b",
         "a::b", "a,b", "a\"b", "a'b", "a#b", "a;b", "a&b", "a=b", "a\nb", "a\n", "\na", "a\rb", "a\tb", "x" * 40, "x" * 41, "x" * 64, "x" * 65]
REFUSAL = re.compile(r"must be (1 to \d+ letters|of letters|a letter|a name (without|that|of its own))|must not have \"::\"")


def patterns_of(schema, root, where=""):
    """Every text of an input that has a pattern: the way to it and the pattern."""
    schema = resolve(schema, root)
    for key, one in schema.get("properties", {}).items():
        here = f"{where}.{key}".lstrip(".")
        one = resolve(one, root)
        if "pattern" in one:
            yield here, one["pattern"]
        if "propertyNames" in one:
            yield f"{here}.NAME", one["propertyNames"]["pattern"]
        yield from patterns_of(one["items"] if one.get("type") == "array" and "properties" in one.get("items", {}) else one, root, here)


class Names(unittest.TestCase):
    """What a name may be is the same in the pattern of a schema and in the reader of its files."""

    def setUp(self):
        self.looked_at = set()

    def compare(self, kind, file, verb, way, pattern, change):
        """change(document, text): the document with this name, as TOML's own tree."""
        more = [] if verb == ["arm", "show"] else ["--quiet", "--out", "/dev/null/none"]
        for text in TEXTS:
            # Beside the file, for the files that it names.
            with tempfile.NamedTemporaryFile("w", dir=file.parent, prefix=".names_", suffix=".toml", encoding="utf-8", newline="") as changed:
                changed.write(toml_of(change(document_of(file), text)))
                changed.flush()
                run = subprocess.run([setting.COMMAND, *verb, changed.name, *more], capture_output=True, text=True, timeout=60)
            refused = [line for line in run.stderr.splitlines() if REFUSAL.search(line)]
            self.assertEqual(re.search(pattern, text) is None, bool(refused), f"{kind}: {way} = {text!r}: {run.stderr}")
        self.looked_at.add((kind, way))

    def test_of_tables_and_columns(self):
        files = [(kind, *READERS[kind]) for kind in READERS]
        files += [(kind, EVERY_KEY[kind][0], f"tests/data/keys/{name}.toml") for kind in EVERY_KEY for name in EVERY_KEY[kind][1]]
        wanted = set()
        for kind, verb, name in files:
            verb, file, schema = [verb] if isinstance(verb, str) else verb, setting.SOURCE / name, schema_of(kind)
            for way, pattern in patterns_of(schema, schema):
                wanted.add((kind, way))
                steps = way.split(".")
                if (kind, way) not in self.looked_at and owners(document_of(file), steps):
                    self.compare(kind, file, verb, way, pattern, lambda document, text, s=steps: renamed(document, s, text))
        self.assertEqual(wanted - self.looked_at, set())
        self.assertGreater(len(wanted), 20)


def document_of(file):
    """A file, with the names that it may leave out."""
    document = tomllib.loads(file.read_text())
    if document["schema"].startswith("snare-wire/"):
        document.setdefault("exports", {}).setdefault("name", "law")
    return document


def owners(document, steps):
    """The first table that holds the last of the steps; None where the document has none."""
    for step in steps[:-1]:
        document = document.get(step)
        if isinstance(document, list):
            document = next((d for d in document if steps[-1] in d or isinstance(d.get(steps[steps.index(step) + 1]), (dict, list))), None)
        if not isinstance(document, dict):
            return None
    return document if steps[-1] == "NAME" and document or steps[-1] in document else None


def renamed(document, steps, text):
    owner = owners(document, steps)
    if steps[-1] == "NAME":
        key = next(iter(owner))
        owner[text] = owner.pop(key)
    else:
        owner[steps[-1]] = text
    return document


def toml_of(value, top=True):
    """A document as text: tables inline, texts and keys in quotes."""
    if isinstance(value, dict):
        items = [f"{toml_of(key, False)} = {toml_of(one, False)}" for key, one in value.items()]
        return "\n".join(items) + "\n" if top else "{ " + ", ".join(items) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(toml_of(one, False) for one in value) + "]"
    if isinstance(value, bool):
        return "true" if value else "false"
    return json.dumps(value) if isinstance(value, str) else repr(value)


if __name__ == "__main__":
    setting.main()
