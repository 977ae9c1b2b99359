"""An interrupt ends every verb within a second, and the interpreter goes on."""

import os
import signal
import subprocess
import sys
import unittest

import setting

# Works for much longer than the test waits.
LONG = {
    "push": ("data/experiments/published_static.toml",
             '{"solver.elements": 4096, **{f"series[s{k}].points": 4000 for k in (40, 65, 90)}}'),
    "trace": ("data/experiments/published_static.toml", '{"solver.elements": 4096}'),
    "fit": ("data/experiments/published_static.toml", '{"solver.elements": 4096}'),
    "distil": ("data/wires/traced_published.toml",
               '{"table.points": [60, 60, 30], "table.most_points": [60, 60, 30]}'),
    "simulate": ("data/scenarios/ssrms_htv_capture.toml", "{}"),
    "compare": ("data/scenarios/ssrms_htv_capture.toml", "{}"),
}
PROGRAM = """
import sys, time, snare
begun = time.monotonic()
print("begun", flush=True)
try:
    snare.{verb}({file!r}, set={set}, progress=lambda text: None)
except KeyboardInterrupt:
    print("interrupted", flush=True)
    assert snare.__version__  # the interpreter goes on
    sys.exit(0)
print("ended", time.monotonic() - begun, flush=True)
"""


class Interrupts(unittest.TestCase):
    def test_every_verb_ends_within_a_second(self):
        import time

        for verb, (file, overrides) in LONG.items():
            with self.subTest(verb):
                program = PROGRAM.format(verb=verb, file=str(setting.SOURCE / file), set=overrides)
                process = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
                self.assertEqual(process.stdout.readline(), "begun\n")
                time.sleep(0.8)
                sent = time.monotonic()
                os.kill(process.pid, signal.SIGINT)
                self.assertEqual(process.stdout.readline(), "interrupted\n")
                took = time.monotonic() - sent
                print(f"{verb}: {took:.2f} s", flush=True)
                self.assertLess(took, 1.0)
                self.assertEqual(process.wait(timeout=30), 0)
                process.stdout.close()


if __name__ == "__main__":
    setting.main()
