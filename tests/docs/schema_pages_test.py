#!/usr/bin/env python3
"""The check of keys and units."""

import unittest

from schema_pages import problems_of, unit_of


def schema(**properties):
    return {"type": "object", "properties": properties}


class SchemaPages(unittest.TestCase):
    def test_units_are_the_longest_end_of_a_name(self):
        self.assertEqual([unit_of(n) for n in ("span_mm", "rate_1_s", "k_N_m", "torque_Nm", "modes", "spin_rad_s")],
                         ["mm", "1/s", "N/m", "N m", None, "rad/s"])

    def test_a_key_that_no_page_has_is_found(self):
        one = schema(span_mm={"type": "number", "description": "Of mounts [mm]."})
        self.assertEqual(problems_of("arm", one, ["| `span_mm` |"]), [])
        self.assertEqual(problems_of("arm", one, ["span_mm in plain text"]), ["arm: span_mm is in no page: arm_files.md"])

    def test_descriptions_and_units_are_asked_for(self):
        self.assertEqual(problems_of("arm", schema(span_mm={"type": "number"}), ["`span_mm`"]),
                         ["arm: span_mm has no description", "arm: span_mm has no unit in its description, [mm]"])


if __name__ == "__main__":
    unittest.main()
