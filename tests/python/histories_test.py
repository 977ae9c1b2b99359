"""Histories of sweeps as h5py reads them, against the tables that the same cases write alone."""

import csv
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import setting

try:
    import h5py
except ImportError:
    print("skipped: h5py is not installed (Debian: python3-h5py)")
    sys.exit(setting.SKIPPED)

import snare

HEAD = """schema = "snare-sweep/1"
title = "histories"
source = "a test"
case = "{case}"
design = "grid"
{set}
[[vary]]
{vary}
[collect]
what = "{field}"
[histories]
{histories}
"""
PUSH = (setting.SOURCE / "examples/push.toml").read_text().split("[[series]]")[0]  # its wire, mounts and pusher


def push_of(**places):
    """An experiment of six points at each place along the chord [mm]."""
    return PUSH + "".join(f'[[series]]\nname = "{name}"\ncontact_position_mm = {place}\ntravel_mm = 0.5\npoints = 6\n'
                          for name, place in places.items())


def table_of(file):
    with open(file, newline="") as stream:
        return list(csv.DictReader(line for line in stream if not line.startswith("#")))


class Histories(unittest.TestCase):
    def setUp(self):
        held = tempfile.TemporaryDirectory()
        self.addCleanup(held.cleanup)
        self.folder = pathlib.Path(held.name)

    def sweep(self, histories, case, set="", vary="", field=""):
        """The folder of a sweep that was run."""
        file = self.folder / "sweep.toml"
        file.write_text(HEAD.format(case=case, set=set, vary=vary, field=field, histories=histories))
        setting.run_command("sweep", str(file), "--out", str(self.folder / "out"))
        return self.folder / "out"

    def check_case(self, out, number, table, every=1, columns=None):
        """A group of the file against the table of the case, run alone."""
        setting.run_command("sweep", str(self.folder / "sweep.toml"), "--out", str(out), "--case", str(number))
        rows = table_of(out / f"case_{number}" / table)
        with h5py.File(out / "histories.h5") as file:
            group = file[f"case_{number:06}"]
            self.assertEqual(group.attrs["case"], number)
            self.assertEqual(group.attrs["status"], "done")
            self.assertEqual(set(group), set(columns or rows[0]))
            for name, data in group.items():
                expected = [row[name] for row in rows][::every]
                self.assertEqual(len(data), len(expected), name)
                if h5py.check_string_dtype(data.dtype):
                    self.assertEqual(list(data.asstr()[:]), expected, name)
                    continue
                for got, text in zip(data[:], expected):  # to the last bit: the table has all digits
                    self.assertTrue(math.isnan(got) if text == "" else got == float(text), f"{name}: {got} {text}")

    def test_a_motion_of_parts(self):
        out = self.sweep('columns = "all"', setting.SOURCE / "data/scenarios/snare_on_pin.toml",
                         '[set]\n"shapes[pin].position_mm" = [0.0, 0.0, 0.0]\n"duration_s" = 0.05',
                         'key = "shapes[pin].position_mm[1]"\nname = "x_mm"\nvalues = [0.0, 10.0]', "max outcome.peak_tension_N[*]")
        self.check_case(out, 2, "history.csv")
        with h5py.File(out / "histories.h5") as file:
            self.assertEqual(file.attrs["schema"], "snare-sweep-histories/1")
            self.assertEqual(file.attrs["title"], "histories")
            self.assertEqual(file.attrs["version"], snare.__version__)
            self.assertEqual(list(file.attrs["variables"]), ["x_mm"])
            self.assertEqual([case.attrs["x_mm"] for case in file.values()], [0.0, 10.0])
            case = file["case_000001"]
            self.assertEqual(case["time_s"].attrs["unit"], "s")
            self.assertEqual({data.attrs.get("unit") for name, data in case.items() if name.endswith("tension_N")}, {"N"})

    def test_pushes_with_rows_left_out_and_words(self):
        (self.folder / "one.toml").write_text(push_of(a=40.0, b=87.5))
        columns = ["series", "force_N", "displacement_mm", "discretisation_error_N"]
        out = self.sweep(f"columns = {columns}\nevery = 3", "one.toml", "",
                         'key = "wire.length_mm"\nvalues = [179.9, 180.0]', "series[a].largest_force_N")
        self.check_case(out, 1, "curves.csv", every=3, columns=columns)  # six points a series, of which the first and the fourth are kept
        with h5py.File(out / "histories.h5") as file:
            self.assertEqual(list(file["case_000002/series"].asstr()[:]), ["a", "a", "b", "b"])
            self.assertEqual(file.attrs["every"], 3)

    def test_the_package_says_where_the_file_is(self):
        (self.folder / "one.toml").write_text(push_of(a=40.0))
        file = self.folder / "sweep.toml"
        file.write_text(HEAD.format(case="one.toml", set="", vary='key = "wire.length_mm"\nvalues = [180.0, 180.1]',
                                    field="series[a].largest_force_N", histories='columns = ["force_N"]'))
        with self.assertRaisesRegex(snare.InputError, "histories, must have a folder"):
            snare.sweep(file)
        result = snare.sweep(file, out=self.folder / "out")
        self.assertEqual(result["histories"], str(self.folder / "out/histories.h5"))
        with h5py.File(result["histories"]) as kept:
            largest = [case["force_N"][:].max() for case in kept.values()]
        self.assertEqual(largest, list(result["table"]["what"]))

    def test_one_process_and_two_ranks_write_the_same_bytes(self):
        if shutil.which("mpirun") is None or not (pathlib.Path(setting.COMMAND).parent / "snare_mpi.so").exists():
            self.skipTest("no mpirun, or built without MPI")
        (self.folder / "one.toml").write_text(push_of(a=40.0))
        out = self.sweep('columns = "all"', "one.toml", "", f'key = "wire.length_mm"\nvalues = {[180 + 0.01 * k for k in range(40)]}',
                         "series[a].largest_force_N")
        environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")
        subprocess.run(["mpirun", "--oversubscribe", "-n", "2", setting.COMMAND, "sweep", "sweep.toml", "--out", "ranks", "--quiet"],
                       cwd=self.folder, env=environment, check=True, timeout=300)
        self.assertEqual((self.folder / "ranks/histories.h5").read_bytes(), (out / "histories.h5").read_bytes())


if __name__ == "__main__":
    setting.main()
