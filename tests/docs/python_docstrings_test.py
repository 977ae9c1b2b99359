#!/usr/bin/env python3
"""The check of docstrings of the Python package."""

import unittest

from python_docstrings import problems_of, says_shapes, says_units

INIT = '"""The package."""\n__all__ = ["push"]\n'
HEADING = '"""Pictures; every function returns the axes."""\n'
WHOLE = "Push.\n\nlength: of the wire [m].\nReturns columns of one length, ``force_N``."


def found(text, arguments="length", heading='"""Verbs."""\n', file="_verbs.py", name="push"):
    return [what for _, _, what in problems_of({"__init__.py": INIT, file: f'{heading}def {name}({arguments}):\n    """{text}"""\n'})]


class PythonDocstrings(unittest.TestCase):
    def test_what_says_all_is_fine(self):
        self.assertEqual(found(WHOLE), [])
        self.assertEqual(found(WHOLE.replace("Returns columns", "Columns"), heading=HEADING), [])

    def test_what_is_missing_is_found(self):
        self.assertEqual(found(""), ["push has no docstring"])
        self.assertEqual(found(WHOLE.replace("length: of", "size: of")), ["push does not say what length is"])
        self.assertEqual(found(WHOLE, "length, *, threads=0"), ["push does not say what threads is"])
        self.assertEqual(found(WHOLE, "length, *columns"), ["push does not say what columns is"])
        self.assertEqual(found(WHOLE.replace("Returns c", "C")), ["push does not say what it returns"])
        self.assertEqual(found(WHOLE.replace(" [m]", "").replace("``force_N``", "``force``")), ["push says no unit"])
        self.assertEqual(found(WHOLE.replace("columns of one length", "the force")), ["push says no shape"])

    def test_only_public_names_count(self):
        self.assertEqual(found("", name="_hidden"), [])
        self.assertEqual(found("", name="inner"), [])  # of a module of the package's own, not in __all__
        self.assertEqual(found("", name="inner", file="plot.py"), ["inner has no docstring"])

    def test_others_may_be_referred_to(self):
        verbs = f'"""Verbs."""\ndef push(length):\n    """{WHOLE}"""\n\n\ndef pull(length{{}}):\n    """{{}}"""\n'
        files = {"__init__.py": INIT.replace('"push"', '"push", "pull"')}

        def of(text, more=""):
            return [what for _, _, what in problems_of({**files, "_verbs.py": verbs.format(more, text)})]

        self.assertEqual(of("Pull. Arguments as of ``push``. Returns the same."), [])
        self.assertEqual(of("Pull. Arguments as of ``push``. Returns the same.", ", back"), ["pull does not say what back is"])
        self.assertEqual(of("Pull. Arguments as of ``shove``. Returns the same."),
                         ["pull does not say what length is", "pull says no unit", "pull says no shape"])

    def test_units_and_shapes(self):
        for text in ("x[0]", "of the wire", "the ``wire``", "[k] of them"):
            self.assertFalse(says_units(text), text)
        for text in ("force [N]", "dF/dd [N/m], of it", "in SI units", "``contact_arc_m``", "a point [rad, m]"):
            self.assertTrue(says_units(text), text)
        self.assertFalse(says_shapes("the force"))
        self.assertTrue(says_shapes("arrays of any shape"))


if __name__ == "__main__":
    unittest.main()
