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
        self.assertEqual(found("namespace snare {\n/// What it does.\nint fine(int x);\nint with_it(int y);\n}"), [])
        self.assertEqual(found("namespace snare {\nint behind(int x);  ///< what it does\n}"), [])

    def test_public_members_need_one_and_others_do_not(self):
        text = "namespace snare {\n/// A.\nclass A {\n public:\n  [[nodiscard]] int seen() const;\n private:\n  int unseen() const;\n};\n}"
        self.assertEqual(found(text), [("seen", "has no comment")])

    def test_numbers_say_their_unit(self):
        text = "namespace snare {{\n/// A.\nstruct A {{\n  double length = 0.0;{}\n}};\n}}"
        self.assertEqual(found(text.format("")), [("length", "says no unit")])
        self.assertEqual(found(text.format("  ///< of the wire [m]")), [])
        self.assertEqual(found(text.format("  ///< share of the range")), [])

    def test_functions_of_numbers_say_units(self):
        text = "namespace snare {{\n/// {}\n{}\n}}"
        for says in ("Force of a spring.", "Entry x[i], in [0, 1].", "The number of a thing.", "A force at [k]."):
            for code in ("double f(int k);", "void f(double x);", "[[nodiscard]] std::vector<double> f(int k);", "inline Eigen::Vector3d f() {",
                         "void f(int k,\n       const Eigen::MatrixXd& m);", "template <int N>\nvoid f(const Dual<N>& x) {"):
                self.assertEqual(found(text.format(says, code)), [("f", "says no unit")], (says, code))
        for says in ("Force of a spring [N].", "Slope [-].", "A rate [1/s], > 0.", "Torque [N m] at an angle [rad].", "Share of the whole.",
                     "Number of a key, in the unit of the key.", "A matrix of any unit.", "y in SI units."):
            self.assertEqual(found(text.format(says, "double f(double x);")), [], says)
        self.assertEqual(found(text.format("Waits.", "void f(double time_s);")), [])
        self.assertEqual(found(text.format("Waits.", "void f(double tau, int n);  ///< tau [s]")), [])
        self.assertEqual(found(text.format("An index of many.", "Eigen::Index f(int k);")), [])

    def test_a_comment_with_units_serves_those_that_share_it(self):
        shared = "namespace snare {\n/// Force [N].\ndouble f(double x);\ndouble g(double x);\n"
        self.assertEqual(found(shared + "}"), [])
        self.assertEqual(found(shared + "/// Something else.\ndouble h(double x);\n}"), [("h", "says no unit")])
        self.assertEqual(found(shared + "\n/// Something else.\ndouble h(double x);\n}"), [("h", "says no unit")])

    def test_public_members_and_constructors_say_units(self):
        text = "namespace snare {{\n/// {}\nclass A {{\n public:\n  /// Made of this.\n  explicit A(double x);\n  /// What it is.\n" \
               "  double value() const;\n  double known(double x) const override;\n private:\n  double unseen() const;\n}};\n}}"
        self.assertEqual(found(text.format("A thing.")), [("A", "says no unit"), ("value", "says no unit")])
        # One unit of a class says it of what it is made of, not of all that it can do.
        self.assertEqual(found(text.format("A thing of a length [m].")), [("value", "says no unit")])
        self.assertEqual(found(text.format("A thing. All in SI units.")), [])

    def test_the_heading_of_a_file_may_say_it_for_all(self):
        text = "{}#pragma once\n\nnamespace snare {{\n\n/// Solves.\nvoid solve(Eigen::VectorXd& x);\n\n}}"
        self.assertEqual(found(text.format("")), [("solve", "says no unit")])
        self.assertEqual(found(text.format("/// Dense matrices of any unit.\n")), [])
        self.assertEqual(found(text.format("/// Dense matrices [N].\n")), [("solve", "says no unit")])

    def test_a_definition_below_its_declaration_needs_nothing(self):
        text = "namespace snare {\n/// Twice x [m].\ndouble twice(double x);\n\n// Here, for the compiler.\n\ninline double twice(double x) {\n" \
               "  return 2.0 * x;\n}\n\ninline double thrice(double x) {\n  return 3.0 * x;\n}\n}"
        self.assertEqual(found(text), [("thrice", "has no comment")])


if __name__ == "__main__":
    unittest.main()
