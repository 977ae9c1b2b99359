#!/usr/bin/env python3
"""The comparison of what is stored with what was made finds what differs, and only that."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "scripts"))

import shipped  # noqa: E402
from results_pages import REGION  # noqa: E402

MAKER = shipped.Maker(len, (), relative=1e-2, absolute=1e-6, pixels=0.01, named=((r"(^|\.)p(=|$)", (0.0, 0.02)),), long=False)


def found(path, stored, made):
    return shipped.differences(path, stored.encode(), made.encode(), MAKER)


class Comparison(unittest.TestCase):
    def test_numbers_of_a_table_within_the_tolerance_are_no_difference(self):
        self.assertEqual(found("a.csv", "case,x\n1,100.0\n", "case,x\n1,100.9\n"), [])
        self.assertEqual(found("a.csv", "case,x\n1,100.0\n", "case,x\n1,101.9\n"), ["row 1, x: stored 100.0, made 101.9"])

    def test_words_rows_and_missing_numbers_are_found(self):
        self.assertEqual(len(found("a.csv", "case,status\n1,done\n", "case,status\n1,refused\n")), 1)
        self.assertEqual(len(found("a.csv", "case,x\n1,2.0\n", "case,x\n1,2.0\n2,2.0\n")), 1)
        self.assertEqual(len(found("a.csv", "case,x\n1,2.0\n", "case,x\n1,\n")), 1)

    def test_keys_types_and_values_of_json(self):
        self.assertEqual(found("a.json", '{"a": [1.0, 2.0], "version": "1"}', '{"a": [1.001, 2.0], "version": "2"}'), [])
        for made in ('{"a": [1.0]}', '{"a": [1.0, 2.5]}', '{"b": [1.0, 2.0]}', '{"a": [1.0, null]}', '{"a": [1.0, true]}'):
            self.assertNotEqual(found("a.json", '{"a": [1.0, 2.0]}', made), [], made)

    def test_a_key_may_have_a_tolerance_of_its_own(self):
        self.assertEqual(found("a.json", '{"fit": {"p": 0.01}}', '{"fit": {"p": 0.029}}'), [])
        self.assertEqual(len(found("a.json", '{"fit": {"p": 0.01}}', '{"fit": {"p": 0.031}}')), 1)

    def test_a_column_may_have_a_tolerance_of_its_own(self):
        self.assertEqual(found("a.csv", "case,p\n1,0.01\n", "case,p\n1,0.029\n"), [])
        self.assertEqual(len(found("a.csv", "case,p_1\n1,0.01\n", "case,p_1\n1,0.029\n")), 1)

    def test_numbers_in_a_text_differ_by_the_tolerance_or_the_last_place(self):
        self.assertEqual(found("a.toml", "length_mm = 175.123456", "length_mm = 175.123457"), [])
        self.assertEqual(found("a.txt", "s40 0.079", "s40 0.080"), [])
        self.assertEqual(len(found("a.txt", "s40 0.079", "s40 0.082")), 1)
        self.assertEqual(len(found("a.txt", "s40 0.079", "s41 0.079")), 1, "a digit of a name is no number")
        self.assertEqual(len(found("a.toml", "verdict = explained", "verdict = not explained")), 1)
        self.assertEqual(len(found("a.toml", "zeros = [1, 2]", "zeros = [1, 3]")), 1)

    def test_colours_of_a_map_may_differ_and_its_numbers_not(self):
        self.assertEqual(found("a.svg", '<rect fill="#2f6c8c">403.626</rect>', '<rect fill="#2f6c8d">403.7</rect>'), [])
        self.assertEqual(len(found("a.svg", '<rect fill="#2f6c8c">403.626</rect>', '<rect fill="#2f6c8c">493.7</rect>')), 1)

    def test_what_is_not_stored_is_found(self):
        self.assertEqual(shipped.differences("a.csv", None, b"x", MAKER), ["is not stored"])

    def test_tables_that_were_chosen_by_hand_are_kept(self):
        stored = "[wire]\nlength_mm = 1.0\n\n[laws]\npositions_mm = [1.0]\n\n[damping]\naxial_time_s = 1e-5\n"
        self.assertEqual(shipped.with_chosen_tables("# new\n[wire]\nlength_mm = 2.0\n\n[laws]\npositions_mm = [2.0]\n", stored),
                         "# new\n[wire]\nlength_mm = 2.0\n\n[laws]\npositions_mm = [2.0]\n\n[damping]\naxial_time_s = 1e-5\n")

    def test_a_region_may_be_empty(self):
        self.assertTrue(REGION.search("<!-- numbers: x_y -->\n<!-- end of numbers -->"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
