#!/usr/bin/env python3
"""The checker itself: a number off its value, a word that differs and a line that is missing are told."""

import unittest

from example_output import problems

OUTPUT = "force at 40 mm: 181.25 N, to 1e-3 N\nit lacks: friction\nenergy: nan J\n"


class ExampleOutput(unittest.TestCase):
    def test_numbers_within_the_limit_and_words_pass(self):
        self.assertEqual(problems(OUTPUT, ["force at 40 mm=181.2+-0.1", "it lacks=friction"]), [])

    def test_number_off_its_value_is_told(self):
        self.assertEqual(problems(OUTPUT, ["force at 40 mm=181+-0.1"]),
                         ['"force at 40 mm" is 181.25 N, to 1e-3 N, must be within 0.1 of 181'])

    def test_other_word_missing_line_and_nan_are_told(self):
        found = problems(OUTPUT, ["it lacks=gravity", "torque=1+-1", "energy=0+-1"])
        self.assertEqual(len(found), 3)


if __name__ == "__main__":
    unittest.main()
