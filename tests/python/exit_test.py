"""The end of a process while other threads work: no crash, whatever they do."""

import subprocess
import sys
import tempfile
import unittest

import setting

SETUP = f"""
import sys, threading, time
import numpy as np
import snare
FILE = {str(setting.SOURCE / "data/experiments/published_static.toml")!r}
def start(function):
    thread = threading.Thread(target=function, daemon=True)
    thread.start()
    return thread
def again_and_again(function):
    def loop():
        while True:
            function()
    return start(loop)
"""

SCRIPTS = {
    "in a verb": "start(lambda: snare.trace(FILE)); time.sleep(0.3)",
    "in a verb that tells its progress": "start(lambda: snare.trace(FILE, progress=lambda text: None)); time.sleep(0.3)",
    "in many verbs": "for _ in range(4): start(lambda: snare.trace(FILE, threads=1))\ntime.sleep(0.3)",
    "at once": "start(lambda: snare.trace(FILE))",
    "in verbs without end": "again_and_again(lambda: snare.push(FILE, threads=1)); time.sleep(0.3)",
    "in a law": "law = snare.Law(sys.argv[1]); d = np.full(10**6, 1e-3); again_and_again(lambda: law.force(d, 0.05)); time.sleep(0.2)",
    "by sys.exit": "start(lambda: snare.trace(FILE)); time.sleep(0.2); sys.exit(0)",
    "with a verb at exit": "import atexit\nstart(lambda: snare.trace(FILE)); time.sleep(0.2)\n"
                           "atexit.register(lambda: snare.push(FILE))",
}


class Exit(unittest.TestCase):
    def test_daemon_threads_end_quietly(self):
        with tempfile.TemporaryDirectory() as folder:
            setting.run_command("distil", str(setting.small_wire(folder)), "--out", folder)
            for name, script in SCRIPTS.items():
                done = subprocess.run([sys.executable, "-B", "-c", SETUP + script, f"{folder}/law.json"], capture_output=True, text=True,
                                      timeout=60)
                self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""), name)


if __name__ == "__main__":
    setting.main()
