#!/usr/bin/env python3
"""Tests promise_table.py: it finds every kind of fault, and writes tables that it accepts."""

import unittest

import promise_table
from promise_table import Check


class PromiseTable(unittest.TestCase):
    def faults(self, only, without):
        return list(Check("id", "name", only, without).faults())

    def test_a_complete_check_has_no_fault(self):
        self.assertEqual(self.faults({}, {}), [])
        self.assertEqual(self.faults({"mpi": ["sweep"]}, {"cpp": "prints nothing"}), [])
        self.assertEqual(self.faults({"command": ["push"]}, {"command": {"arm": "has no folder", "others": "has no cases"}}), [])

    def test_faults_are_found(self):
        for only, without, word in (({"fortran": ["push"]}, {}, "no entry fortran"), ({"cpp": ["sweep"]}, {}, "no verb sweep"),
                                    ({}, {"mpi": {"push": "a reason"}}, "no verb push"),
                                    ({"cpp": ["push", "fit", "trace", "distil"]}, {}, "simulate of cpp has neither")):
            found = self.faults(only, without)
            self.assertTrue(any(word in fault for fault in found), (only, without, found))

    def test_reasons(self):
        check = Check("id", "name", {"python": ["sweep"]}, {"python": {"push": "one", "others": "other"}, "mpi": "all"})
        self.assertEqual([check.reason("python", verb) for verb in ("sweep", "push", "fit")], ["", "one", "other"])
        self.assertEqual((check.reason("mpi", "sweep"), check.reason("command", "push")), ("all", ""))

    def test_the_page_is_written_from_the_table(self):
        text = "# Title\n\n| promise | held by |\n|---|---|\n| old | `old` |\n\nText.\n\n| check | command |\n|---|---|\n| old | yes |\n\nEnd.\n"
        page = promise_table.page(text)
        self.assertEqual(promise_table.page(page), page)
        self.assertNotIn("| old |", page)
        for kept in ("# Title", "Text.", "End."):
            self.assertIn(f"{kept}\n", page)
        self.assertIn(promise_table.promises()[0]["promise"], page)

    def test_a_page_without_a_table_is_a_fault(self):
        with self.assertRaises(SystemExit):
            promise_table.page("# Title\n")


if __name__ == "__main__":
    unittest.main()
