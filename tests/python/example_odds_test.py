"""The example that goes from readings on the bench to the odds of a capture, with few captures."""

import json
import re
import subprocess
import sys
import tempfile
import unittest

import setting
import snare

MADE_WITH = {"wire.axial_stiffness_N": 46.8e3, "wire.length_mm": 200.13, "wire.bending_stiffness_Nm2": 0.0056}


class BenchToOdds(unittest.TestCase):
    def test_the_shipped_trace_is_that_of_the_shipped_readings(self):
        traced = snare.trace(setting.SOURCE / "data/experiments/snare_rope.toml")
        shipped = json.loads((setting.SOURCE / "data/sweeps/snare_rope_trace.json").read_text())
        self.assertEqual(traced["verdict_kind"], "nothing_missing")
        for name, truth in MADE_WITH.items():
            now, then = (t["final"]["parameters"][name] for t in (traced, shipped))
            self.assertTrue(now["lower95"] < truth < now["upper95"], f"{name}: {now}")
            self.assertLess(abs(now["value"] - then["value"]), 0.01 * now["stderr"], name)
            self.assertLess(abs(now["stderr"] / then["stderr"] - 1.0), 0.01, name)

    def test_it_goes_the_whole_way(self):
        with tempfile.TemporaryDirectory() as folder:
            picture = f"{folder}/odds.png"
            done = subprocess.run([sys.executable, setting.SOURCE / "examples/bench_to_odds.py", setting.SOURCE / "data", picture,
                                   "--cases", "24"], check=True, capture_output=True, text=True)
            with open(picture, "rb") as file:
                self.assertEqual(file.read(4), b"\x89PNG")
        said = done.stdout
        self.assertRegex(said, r"caught: 2\d of 24")
        low, high = map(float, re.search(r"within (\d+) to (\d+) N", said).groups())
        left_open = float(re.search(r"leaves open of it: ([\d.]+) N", said)[1])
        after = float(re.search(r"of travel, leaves ([\d.]+) N", said)[1])
        # The rope is known to a per cent, so it is a small part of the scatter; one more reading makes it smaller.
        self.assertTrue(0.0 < after < left_open < 0.1 * (high - low), said)


if __name__ == "__main__":
    setting.main()
