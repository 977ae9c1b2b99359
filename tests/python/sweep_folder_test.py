"""A folder that a sweep writes into is refused to others, whoever they are; documents name what was read."""

import fcntl
import hashlib
import pathlib
import subprocess
import tempfile
import threading
import unittest

import setting
import snare

SWEEP = """schema = "snare-sweep/1"
title = "pushes"
case = "CASE"
design = "latin_hypercube"
cases = 3000
[[vary]]
key = "wire.length_mm"
uniform = [179.0, 181.0]
[collect]
force = "series[s40].largest_force_N"
"""


class Folders(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.sweep = pathlib.Path(self.folder.name) / "sweep.toml"
        self.case = setting.SOURCE / "data/experiments/published_static.toml"
        self.sweep.write_text(SWEEP.replace("CASE", str(self.case)))
        self.out = pathlib.Path(self.folder.name) / "out"

    def tearDown(self):
        self.folder.cleanup()

    def test_one_sweep_at_a_time(self):
        began = threading.Event()

        class Enough(Exception):
            pass

        def progress(text):
            began.set()
            if over.is_set():
                raise Enough

        over = threading.Event()

        def first():
            with self.assertRaises(Enough):
                snare.sweep(self.sweep, out=self.out, progress=progress)

        thread = threading.Thread(target=first)
        thread.start()
        self.assertTrue(began.wait(60.0))
        with self.assertRaisesRegex(ValueError, "is writing into this one"):
            snare.sweep(self.sweep, out=self.out)
        command = subprocess.run([setting.COMMAND, "sweep", self.sweep, "--out", self.out], capture_output=True, text=True)
        self.assertEqual(command.returncode, 2, command.stderr)
        self.assertRegex(command.stderr, r"snare.sweep .*is writing into this one")
        over.set()
        thread.join()

    def test_the_folder_of_a_command_is_left_alone(self):
        self.out.mkdir()
        with open(self.out / ".snare.lock", "w", encoding="utf-8") as lock:
            lock.write("snare push other.toml (process 12)\n")
            lock.flush()
            fcntl.flock(lock, fcntl.LOCK_EX)
            with self.assertRaisesRegex(snare.InputError, r"out = .*: snare push other.toml \(process 12\) is writing into this one"):
                snare.sweep(self.sweep, out=self.out)
        self.assertEqual([file.name for file in self.out.iterdir()], [".snare.lock"])

    def test_a_rejected_sweep_leaves_nothing(self):
        with self.assertRaisesRegex(snare.InputError, "nowhere"):
            snare.sweep(self.sweep, out=self.out / "below", set={"collect.force": "nowhere", "cases": 3})
        self.assertFalse(self.out.exists())

    def test_documents_name_their_inputs(self):
        document = snare.push(self.case)
        inputs = {pathlib.Path(one["file"]).name: one["sha256"] for one in document["inputs"]}
        self.assertEqual(inputs, {self.case.name: hashlib.sha256(self.case.read_bytes()).hexdigest()})


if __name__ == "__main__":
    setting.main()
