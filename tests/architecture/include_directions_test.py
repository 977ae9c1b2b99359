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
        text = '#include "coupling/statics/push.hpp"\n#include "wire/rod.hpp"\n#include <vector>\n#include <toml++/toml.h>\n'
        self.assertEqual(self.found("identification/fitting/fit.cpp", text), [])

    def test_upward_include_is_named_with_file_and_line(self):
        found = self.found("numerics/sparse.hpp", '#pragma once\n\n#  include "wire/rod.hpp"\n')
        self.assertEqual(found, ['numerics/sparse.hpp:3: numerics must not include "wire/rod.hpp"; '
                                 "it may include base"])

    def test_wire_and_multibody_do_not_know_each_other(self):
        self.assertEqual(len(self.found("wire/rod.cpp", "#include <multibody/body.hpp>\n")), 1)
        (self.root / "wire/rod.cpp").unlink()
        self.assertEqual(len(self.found("multibody/body.cpp", '#include "wire/rod.hpp"\n')), 1)

    def test_statics_and_dynamics_do_not_know_each_other(self):
        self.assertEqual(len(self.found("coupling/statics/push.cpp", '#include "coupling/dynamics/run/run.hpp"\n')), 1)
        self.assertEqual(len(self.found("coupling/dynamics/run/simulate.cpp", '#include "coupling/statics/push.hpp"\n')), 2)

    def test_a_folder_of_rooms_has_no_files_of_its_own(self):
        found = self.found("coupling/push.cpp", "")
        self.assertEqual(found, ["coupling/push.cpp:1: coupling/ holds rooms and no files of its own"])

    def test_a_circle_is_named_once_with_its_way(self):
        self.found("wire/a.cpp", '#include "wire/b.hpp"\n')
        self.found("wire/b.hpp", '#include "wire/c.hpp"\n')
        found = self.found("wire/c.hpp", '#include "wire/a.hpp"\n')
        self.assertEqual(found, ["wire/a: includes itself by way of wire/b, wire/c"])

    def test_a_header_of_its_own_source_is_no_circle(self):
        self.assertEqual(self.found("wire/a.cpp", '#include "wire/a.hpp"\n'), [])
    def test_nothing_includes_the_application_or_the_tests(self):
        self.assertEqual(len(self.found("validation/check.cpp", '#include "app/options.hpp"\n')), 1)
        self.assertEqual(len(self.found("wire/rod.cpp", '#include "tests/support/x.hpp"\n')), 2)

    def test_includes_are_rooted_at_the_top(self):
        found = self.found("wire/rod.cpp", '#include "rod.hpp"\n')
        self.assertEqual(len(found), 1)
        self.assertIn("wire/rod.cpp:1:", found[0])


if __name__ == "__main__":
    unittest.main()
