#!/usr/bin/env python3
"""The check of comments and units in headers."""

import unittest

from docstrings import problems_of


def found(text):
    return [(name, what) for _, name, what in problems_of(text)]


class Docstrings(unittest.TestCase):
    def test_functions_and_types_need_a_comment(self):
        self.assertEqual(found("namespace snare {\nint bare(double x);\n}"), [("bare", "has no comment")])
        self.assertEqual(found("namespace snare {\nstruct Bare {\n};\n}"), [("Bare", "has no comment")])
        self.assertEqual(found("namespace snare {\n/// What it does.\nint fine(double x);\nint with_it(int y);\n}"), [])
        self.assertEqual(found("namespace snare {\nint behind(double x);  ///< what it does\n}"), [])

    def test_public_members_need_one_and_others_do_not(self):
        text = "namespace snare {\n/// A.\nclass A {\n public:\n  [[nodiscard]] int seen() const;\n private:\n  int unseen() const;\n};\n}"
        self.assertEqual(found(text), [("seen", "has no comment")])

    def test_numbers_say_their_unit(self):
        text = "namespace snare {{\n/// A.\nstruct A {{\n  double length = 0.0;{}\n}};\n}}"
        self.assertEqual(found(text.format("")), [("length", "says no unit")])
        self.assertEqual(found(text.format("  ///< of the wire [m]")), [])
        self.assertEqual(found(text.format("  ///< share of the range")), [])


if __name__ == "__main__":
    unittest.main()
