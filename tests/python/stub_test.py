"""The stub says what the compiled module has, and every public function says what it takes and gives, with units."""

import ast
import inspect
import re
import sys
import unittest

import setting
import snare
import snare.plot
from snare import _core

sys.path.insert(0, str(setting.SOURCE / "tests/docs"))
from python_docstrings import says_shapes, says_units  # noqa: E402

STUB = ast.parse((setting.SOURCE / "python/snare/_core.pyi").read_text())


def arguments_of(function: ast.FunctionDef) -> list:
    """Names with whether they have a default."""
    plain = [one.arg for one in function.args.args if one.arg != "self"]
    defaults = [None] * (len(plain) - len(function.args.defaults)) + [ast.unparse(x) for x in function.args.defaults]
    named = [one.arg for one in function.args.kwonlyargs]
    return list(zip(plain + named, defaults + [x and ast.unparse(x) for x in function.args.kw_defaults]))


def signature_of(function) -> list:
    """The same of a compiled function, from the line that pybind11 puts first."""
    line = function.__doc__.strip().splitlines()[0]
    inside = line[line.index("(") + 1:line.rindex(")")]
    found = []
    for part in re.split(r", (?=\w+(?::|$)|\*)", inside):
        name, _, rest = part.partition(":")
        if name.strip() in ("self", "*"):
            continue
        default = rest.rpartition(" = ")[2] if " = " in rest else None
        found.append((name.strip(), default))
    return found


class Stub(unittest.TestCase):
    def test_classes_and_their_members_are_those_of_the_module(self):
        for node in STUB.body:
            if not isinstance(node, ast.ClassDef) or node.name == "InputError":
                continue
            actual = getattr(_core, node.name)
            members = {one.name for one in node.body if isinstance(one, ast.FunctionDef)} - {"__init__"}
            self.assertEqual(members, {name for name in vars(actual) if not name.startswith("_")}, node.name)
            for one in node.body:
                if not isinstance(one, ast.FunctionDef) or one.name == "__init__":
                    continue
                if any(getattr(x, "id", "") == "property" for x in one.decorator_list):
                    self.assertIsInstance(vars(actual)[one.name], property)
                else:
                    self.assertEqual(arguments_of(one), signature_of(getattr(actual, one.name)), one.name)

    def test_functions_are_those_of_the_module(self):
        stubs = {node.name: node for node in STUB.body if isinstance(node, ast.FunctionDef)}
        actual = {name for name, one in vars(_core).items() if inspect.isbuiltin(one)}
        self.assertEqual(set(stubs), actual)
        for name, node in stubs.items():
            self.assertEqual(arguments_of(node), signature_of(getattr(_core, name)), name)


class Docstrings(unittest.TestCase):
    def test_all_is_there_and_documented(self):
        for name in snare.__all__:
            one = getattr(snare, name)
            if name != "__version__":
                self.assertTrue(inspect.getdoc(one), name)

    def test_verbs_name_their_arguments_results_and_errors(self):
        for verb in (snare.push, snare.fit, snare.trace, snare.distil, snare.simulate, snare.compare, snare.sweep):
            text = inspect.getdoc(verb)
            first = list(inspect.signature(verb).parameters)[0]
            self.assertIn("Returns", text, verb.__name__)
            self.assertIn("Raises InputError", text, verb.__name__)
            self.assertTrue(f"{first}:" in text or "Arguments as of" in text, verb.__name__)

    def test_numbers_have_units_and_shapes(self):
        without_numbers = ("name", "formula", "title", "dissipates")
        for actual in (_core.Law, _core.SimpleLaw):
            whole = actual.__doc__
            for name, one in vars(actual).items():
                if name.startswith("_"):
                    continue
                text = one.__doc__ if isinstance(one, property) else one.__doc__.split("\n", 1)[1]
                self.assertTrue(text and text.strip(), name)
                if name in without_numbers:
                    continue
                over = re.search(r"as of `(\w+)`", text)
                texts = [text] + ([getattr(actual, over.group(1)).__doc__] if over else [])
                self.assertTrue(any(says_units(t) for t in texts) or name == "simple", name)
                if not isinstance(one, property):
                    self.assertTrue(any(says_shapes(t) for t in texts + [whole]), name)
        for name, one in vars(snare.plot).items():
            if inspect.isfunction(one) and not name.startswith("_"):
                self.assertTrue(says_units(inspect.getdoc(one)), name)

    def test_functions_of_the_compiled_part_say_what_they_give(self):
        for name, one in vars(_core).items():
            if inspect.isbuiltin(one):
                self.assertTrue(one.__doc__.split("\n", 1)[1].strip(), name)


if __name__ == "__main__":
    setting.main()
