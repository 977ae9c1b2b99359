#!/usr/bin/env python3
"""The checker of promises itself: every kind of fault is told, and a sound page passes."""

import pathlib
import tempfile
import unittest

import promises

HEAD = "| promise | held by |\n|---|---|\n"


class Promises(unittest.TestCase):
    def problems(self, *rows):
        with tempfile.TemporaryDirectory() as folder:
            top = pathlib.Path(folder)
            (top / "tests/app").mkdir(parents=True)
            (top / "tests/app/files_test.cpp").write_text("TEST_F(Files, AreWhole) {\n}\nTEST(SlowFiles, All) {\n}\n")
            (top / "tests/app/empty_test.cpp").write_text("\n")
            (top / "tests/app/quick_test.cpp").write_text("TEST(Quick, One) {\n}\n")
            (top / "tests/app/run.py").write_text("\n")
            (top / "tests/app/forgotten.py").write_text("\n")
            (top / "tests/CMakeLists.txt").write_text("add_test(NAME a COMMAND app/run.py)\n")
            return list(promises.problems(top, HEAD + "".join(f"| {row} |\n" for row in rows) + "\nMore.\n"))

    def test_sound_page_passes(self):
        self.assertEqual(self.problems("whole | `tests/app/files_test.cpp`*, `tests/app/run.py`*, `Files.AreWhole`",
                                       "large | `tests/app/forgotten.py` before a release"), [])

    def test_faults_are_told(self):
        for row, word in (("alone | nothing", "no test is named"), ("gone | `tests/app/gone_test.cpp`", "no file"),
                          ("empty | `tests/app/empty_test.cpp`", "has no test"), ("name | `Files.AreHalf`", "no test Files.AreHalf"),
                          ("star | `tests/app/quick_test.cpp`*", "no slow test"), ("idle | `tests/app/forgotten.py`", "by no test"),
                          ("idle | `tests/app/forgotten.py`*", "not run by a test")):
            found = self.problems(row)
            self.assertEqual(len(found), 1, found)
            self.assertIn(word, found[0])

    def test_a_page_without_a_table_is_a_fault(self):
        self.assertEqual(len(self.problems()), 1)


if __name__ == "__main__":
    unittest.main()
