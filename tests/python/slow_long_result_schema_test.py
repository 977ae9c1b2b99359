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

    def test_the_figures_of_the_papers_are_valid(self):
        with tempfile.TemporaryDirectory() as folder:
            setting.run_command("reproduce", "all", "--out", folder)
            pages = [pathlib.Path(folder) / f"{name}.html" for name in ("abiko", "na", "honda")]
            document = json.loads((pathlib.Path(folder) / "figures.json").read_text())
            for page, paper in zip(pages, document["papers"]):
                text = page.read_text()
                for figure in paper["figures"]:
                    self.assertIn(f">{figure['number']}: ", text)
        self.assertEqual(mistakes(document, schemas()["snare-figures/1"]), [])
        for figure in (f for paper in document["papers"] for f in paper["figures"]):
            self.assertEqual(figure["failure"], "", figure["number"])
            for panel in figure["panels"]:
                self.assertTrue(panel["curves"], f"{figure['number']}: {panel['title']}")
                for curve in panel["curves"]:
                    self.assertEqual(len(curve["x"]), len(curve["y"]))
                    self.assertGreater(len(curve["x"]), 1, curve["name"])

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
