"""The results that take minutes are valid against their schemas, too."""

import json
import pathlib
import subprocess
import tempfile
import unittest

import setting
from result_schema_test import mistakes, schemas


class LongResults(unittest.TestCase):
    def test_the_reproduction_is_valid(self):
        with tempfile.TemporaryDirectory() as folder:
            setting.run_command("reproduce", "--out", folder)
            document = json.loads((pathlib.Path(folder) / "reproduce.json").read_text())
        self.assertEqual(mistakes(document, schemas()["snare-reproduce/1"]), [])

    def test_a_part_of_the_validation_is_valid(self):
        with tempfile.TemporaryDirectory() as folder:
            run = subprocess.Popen([setting.COMMAND, "validate", "--quiet", "--out", folder])
            try:
                run.wait(timeout=30)
            except subprocess.TimeoutExpired:
                run.terminate()  # what is finished is kept
                run.wait(timeout=120)
            document = json.loads((pathlib.Path(folder) / "validation.json").read_text())
        self.assertGreater(len(document["rows"]), 0)
        self.assertEqual(mistakes(document, schemas()["snare-validation/1"]), [])
        for row in document["rows"]:  # a limit is relative to a reference that is not zero, or has a reason
            absolute = row["error_kind"] == "absolute"
            self.assertEqual(absolute, row["limit_reason"] != "", row)
            self.assertTrue(absolute or row["reference"] != 0.0, row)


if __name__ == "__main__":
    setting.main()
