#!/usr/bin/env python3
"""The checker itself: each arrow that points the wrong way is named with file and line."""

import pathlib
import tempfile
import unittest

import include_directions


class IncludeDirections(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)

    def found(self, file, text):
        path = self.root / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return include_directions.violations(self.root)

    def test_downward_includes_are_allowed(self):
        text = '#include "coupling/push.hpp"\n#include "wire/rod.hpp"\n#include <vector>\n#include <toml++/toml.h>\n'
        self.assertEqual(self.found("identification/fit.cpp", text), [])

    def test_upward_include_is_named_with_file_and_line(self):
        found = self.found("numerics/sparse.hpp", '#pragma once\n\n#  include "wire/rod.hpp"\n')
        self.assertEqual(found, ['numerics/sparse.hpp:3: numerics must not include "wire/rod.hpp"; '
                                 "it may include no other module"])

    def test_wire_and_multibody_do_not_know_each_other(self):
        self.assertEqual(len(self.found("wire/rod.cpp", "#include <multibody/body.hpp>\n")), 1)
        self.assertEqual(len(self.found("multibody/body.cpp", '#include "wire/rod.hpp"\n')), 2)

    def test_nothing_includes_the_application_or_the_tests(self):
        self.assertEqual(len(self.found("validation/check.cpp", '#include "app/options.hpp"\n')), 1)
        self.assertEqual(len(self.found("wire/rod.cpp", '#include "tests/support/x.hpp"\n')), 2)

    def test_includes_are_rooted_at_the_top(self):
        found = self.found("wire/rod.cpp", '#include "rod.hpp"\n')
        self.assertEqual(len(found), 1)
        self.assertIn("wire/rod.cpp:1:", found[0])


if __name__ == "__main__":
    unittest.main()
