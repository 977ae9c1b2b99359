#!/usr/bin/env python3
"""The checker itself: every kind of fault is told, and a sound tree passes."""

import pathlib
import tempfile
import unittest

import theory_tags


class TheoryTags(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.write("README.md", "[theory](docs/theory.md) [why](docs/decisions/x.md)\n"
                                "[map](CONTRIBUTING.md#the-map)\n")
        self.write("CONTRIBUTING.md", "# The map\nRooms: `wire/`, `rod.hpp`.\n")
        self.write("docs/theory.md", "# Theory\n\n[Wire](theory/wire.md)\n")
        self.write("docs/theory/wire.md", "**(W.1)** Tension $T = EA e$.\n\n$$\nM_i = k_i \\phi_i ,\n$$\n\n"
                                          "**(W.2)** More, as (W.1).\n")
        self.write("docs/decisions/x.md", "# Because\n")
        self.write("wire/rod.hpp", "/// Bends.  theory.md (W.1)-(W.2)\n")

    def write(self, file, text):
        path = self.root / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def append(self, file, text):
        self.write(file, (self.root / file).read_text(encoding="utf-8") + text)

    def only_problem(self):
        found = theory_tags.problems(self.root)
        self.assertEqual(len(found), 1, found)
        return found[0]

    def test_sound_tree_passes(self):
        self.assertEqual(theory_tags.problems(self.root), [])

    def test_cited_tag_that_is_not_defined(self):
        self.append("wire/rod.hpp", "// (W.3)\n")
        self.assertEqual(self.only_problem(), "wire/rod.hpp:2: (W.3) is not defined in the theory")

    def test_tag_defined_twice(self):
        self.append("docs/theory.md", "**(W.2)** Again.\n")
        self.assertIn("(W.2) is defined a second time", self.only_problem())

    def test_tag_that_no_code_cites(self):
        self.append("docs/theory/wire.md", "\n**(W.30)** Lonely.\n")
        self.assertIn("(W.30) is cited by no code", self.only_problem())
        self.append("docs/theory.md", "\nBackground: (W.30).\n")
        self.assertEqual(theory_tags.problems(self.root), [])
        self.append("wire/rod.hpp", "// (W.30)\n")
        self.assertIn("which the theory names as background", self.only_problem())

    def test_long_range_cites_its_ends_only(self):
        self.assertEqual(theory_tags.cited_in("(W.1)-(W.3)"), {"W.1", "W.2", "W.3"})
        self.assertEqual(theory_tags.cited_in("(M.1)-(M.17)"), {"M.1", "M.17"})

    def test_formulas_that_hosting_sites_spoil(self):
        for formula in ("a\\,b", "a < b", "a * b", "\\dot{x}_i", "[k](x)", "a\n+ b"):
            self.assertEqual(len(theory_tags.formula_problems(formula)), 1, formula)
        self.assertEqual(theory_tags.formula_problems("\\sum_i x_i' \\lt -b^{-1} ,\n-c"), [])

    def test_long_line(self):
        self.append("docs/theory/wire.md", "x" * 111 + "\n")
        self.assertIn("111 columns", self.only_problem())

    def test_formula_that_does_not_end(self):
        self.append("docs/theory/wire.md", "a $b\nc$ d\n")
        self.assertEqual(len(theory_tags.problems(self.root)), 2)

    def test_name_that_does_not_exist(self):
        self.append("CONTRIBUTING.md", "See `wire/ring.hpp`.\n")
        self.assertEqual(self.only_problem(), "CONTRIBUTING.md:3: `wire/ring.hpp` does not exist")

    def test_links(self):
        self.append("docs/theory.md", "[x](theory/none.md)\n")
        self.assertIn("leads nowhere", self.only_problem())
        self.write("docs/theory.md", "[Wire](theory/wire.md) [x](../CONTRIBUTING.md#no-map)\n")
        self.assertIn("has no heading #no-map", self.only_problem())
        self.write("docs/theory.md", "[Wire](theory/wire.md)\n")
        self.write("docs/alone.md", "# Alone\n")
        self.assertIn("docs/alone.md:1: no link leads here", self.only_problem())

    def test_copy_of_a_file_that_has_changed(self):
        self.append("README.md", "<!-- test: same as wire/rod.hpp -->\n"
                                 "```cpp\n/// Bends.  theory.md (W.1)-(W.2)\n```\n")
        self.assertEqual(theory_tags.problems(self.root), [])
        self.append("wire/rod.hpp", "int x;\n")
        self.assertIn("a block is not same as wire/rod.hpp", self.only_problem())

    def test_part_of_a_file_that_has_changed(self):
        self.append("CONTRIBUTING.md", "<!-- test: part of wire/rod.hpp -->\n```cpp\n/// Bends.  theory.md (W.1)-(W.2)\n```\n")
        self.append("wire/rod.hpp", "int x;\n")
        self.assertEqual(theory_tags.problems(self.root), [])
        self.write("wire/rod.hpp", "int x;  // theory.md (W.1)-(W.2)\n")
        self.assertIn("CONTRIBUTING.md:1: a block is not part of wire/rod.hpp", self.only_problem())


if __name__ == "__main__":
    unittest.main()
