"""The verbs in Python give what the command writes, and say what is wrong."""

import multiprocessing
import pathlib
import tempfile
import threading
import time
import unittest

import setting
import snare
import numpy as np

EXPERIMENT = setting.SOURCE / "examples/push.toml"
SCENARIO = setting.SOURCE / "data/scenarios/snare_on_pin.toml"
WIRE = setting.SOURCE / "data/wires/traced_published.toml"

# Times and what hangs on them: nothing else may differ between the module and the command.
TIMES = {"seconds", "wall_s", "real_time_factor", "seconds_per_evaluation"}


def same(test, ours, theirs, where=""):
    """Documents are equal to the last bit, times aside."""
    if isinstance(theirs, dict):
        test.assertEqual(set(ours), set(theirs), where)
        for key in theirs:
            if key not in TIMES:
                same(test, ours[key], theirs[key], f"{where}.{key}")
    elif isinstance(theirs, np.ndarray):
        np.testing.assert_array_equal(ours, theirs, where)
    elif isinstance(theirs, list) and theirs and isinstance(theirs[0], snare.Law):
        test.assertEqual([repr(one) for one in ours], [repr(one) for one in theirs])
    elif isinstance(theirs, list):
        test.assertEqual(len(ours), len(theirs), where)
        for k, one in enumerate(theirs):
            same(test, ours[k], one, f"{where}[{k}]")
    else:
        test.assertEqual(ours, theirs, where)


def last_force(_):
    return snare.push(EXPERIMENT, threads=2)["curves"]["middle"]["force_N"][-1]


class Verbs(unittest.TestCase):
    def written(self, verb, file, *options):
        with tempfile.TemporaryDirectory() as folder:
            setting.run_command(verb, str(file), "--out", folder, *options)
            return snare.load(folder)

    def test_push_gives_the_curves_of_the_command(self):
        result = snare.push(EXPERIMENT, set={"pusher.friction": 0.2})
        self.assertEqual(result["schema"], "snare-push/1")
        written = self.written("push", EXPERIMENT, "--set", "pusher.friction=0.2")
        self.assertEqual(list(result["curves"]), ["quarter", "middle"])
        for series, columns in written["curves"].items():
            self.assertIn("displacement_m", columns)
            same(self, result["curves"][series], columns, series)

    def test_fit_and_trace_give_the_documents_of_the_command(self):
        same(self, snare.fit(EXPERIMENT), self.written("fit", EXPERIMENT))
        result = snare.trace(EXPERIMENT)
        self.assertEqual(result["selected"], ["displacement_offset"])
        same(self, result, self.written("trace", EXPERIMENT))

    def test_simulate_gives_the_summary_and_the_history_of_the_command(self):
        result = snare.simulate(SCENARIO)
        same(self, result, self.written("simulate", SCENARIO))
        self.assertEqual(len(result["history"]["time_s"]), len(result["history"]["pin x_m"]))

    def test_an_arm_alone_is_simulated_too(self):
        file = setting.SOURCE / "data/scenarios/jemrms_step.toml"
        same(self, snare.simulate(file), self.written("simulate", file))

    def test_distil_gives_the_law_of_the_command(self):
        with tempfile.TemporaryDirectory() as folder:
            wire = setting.small_wire(folder)
            same(self, snare.distil(wire), self.written("distil", wire))

    def test_compare_knows_pushes_and_motions(self):
        pushes = snare.compare(EXPERIMENT)
        self.assertEqual([one["case"] for one in pushes["cases"]], ["quarter", "middle"])
        self.assertEqual(pushes["cases"][0]["models"][0]["error_full_wire"]["largest_N"], 0.0)

    def test_records_in_time_are_fitted_and_traced(self):
        with tempfile.TemporaryDirectory() as folder:
            here = pathlib.Path(folder)
            for name in ("pendulum_scenario.toml", "pendulum_arm.toml", "pendulum.urdf"):
                (here / name).write_text((setting.SOURCE / "data/records" / name).read_text())
            bearing = "arms[pendulum].joint.bearing.viscous_Nms_rad"
            swing = snare.simulate(here / "pendulum_scenario.toml", set={"duration_s": 1.5, bearing: 5e-4})["telemetry"]
            random = np.random.default_rng(3)
            rows = zip(swing["time_s"], np.degrees(swing["encoder_rad"]) + 0.01 * random.standard_normal(len(swing["time_s"])))
            (here / "swing.csv").write_text("time_s,angle_deg\n" + "".join(f"{t!r},{a!r}\n" for t, a in rows))
            (here / "record.toml").write_text(f"""schema = "snare-record/1"
title = "a swing"
scenario = "pendulum_scenario.toml"
[[records]]
name = "swing"
file = "swing.csv"
columns = {{ angle_deg = "encoder" }}
[fit]
free = ["{bearing}"]
""")
            fitted = snare.fit(here / "record.toml")
            self.assertAlmostEqual(fitted["fit"]["parameters"][bearing]["value"], 5e-4, delta=2e-6)
            encoder = fitted["curves"]["swing"]["encoder"]
            self.assertEqual(encoder["unit"], "deg")
            self.assertAlmostEqual(np.std(encoder["measured"] - encoder["final"]), 0.01, delta=0.002)
            same(self, fitted, self.written("fit", here / "record.toml"))
            traced = snare.trace(here / "record.toml")
            self.assertEqual(traced["selected"], [])
            same(self, traced, self.written("trace", here / "record.toml"))

    def test_a_sweep_is_that_of_the_command(self):
        with tempfile.TemporaryDirectory() as folder:
            study = pathlib.Path(folder) / "study.toml"
            study.write_text(f"""schema = "snare-sweep/1"
case = "{EXPERIMENT}"
verb = "push"
design = "latin_hypercube"
cases = 6
[[vary]]
key = "pusher.friction"
uniform = [0.0, 0.2]
[collect]
force_N = "series[middle].largest_force_N"
""")
            told = []
            result = snare.sweep(study, threads=2, progress=told.append)
            self.assertTrue(told)
            self.assertEqual(list(result["table"]["case"]), [1, 2, 3, 4, 5, 6])
            self.assertEqual(result["table"]["status"], ["done"] * 6)
            one = snare.push(EXPERIMENT, set={"pusher.friction": result["table"]["pusher.friction"][3]})
            self.assertEqual(one["series"][1]["largest_force_N"], result["table"]["force_N"][3])
            same(self, result, self.written("sweep", study))
            # A sweep that was stopped goes on from its folder.
            kept = pathlib.Path(folder) / "kept"

            def stop(text):
                raise KeyboardInterrupt(text)

            with self.assertRaises(KeyboardInterrupt):
                snare.sweep(study, threads=1, progress=stop, out=kept)
            self.assertGreater((kept / "cases.journal").stat().st_size, 0)
            same(self, snare.sweep(study, out=kept), result)
            with self.assertRaises(snare.InputError):
                snare.sweep(study, set={"cases": 0})

    def test_lengths_of_columns_are_in_metres(self):
        middle = snare.push(EXPERIMENT)["curves"]["middle"]
        # The last line of push_middle.csv has millimetres.
        last = (setting.SOURCE / "examples/push_middle.csv").read_text().strip().splitlines()[-1]
        self.assertAlmostEqual(middle["displacement_m"][-1], 1e-3 * float(last.split(",")[0]), delta=1e-15)
        np.testing.assert_allclose(middle["measured_N"] - middle["force_N"], middle["residual_N"], rtol=0, atol=1e-12)

    def test_threads_change_nothing(self):
        one, two = (snare.push(EXPERIMENT, threads=n)["curves"]["middle"]["force_N"] for n in (1, 2))
        np.testing.assert_array_equal(one, two)


class Mistakes(unittest.TestCase):
    def test_a_wrong_value_names_file_key_and_what_is_allowed(self):
        with self.assertRaises(snare.InputError) as caught:
            snare.push(EXPERIMENT, set={"wire.diameter_mm": -1.5, "wire.colour": "red"})
        self.assertIsInstance(caught.exception, ValueError)
        problems = {one["key"]: one for one in caught.exception.problems}
        self.assertEqual(problems["wire.diameter_mm"]["value"], "-1.5")
        self.assertIn("must be", problems["wire.diameter_mm"]["requirement"])
        self.assertEqual(problems["wire.colour"]["file"], "--set")

    def test_a_missing_file_and_a_folder_without_results_are_told(self):
        with self.assertRaises(snare.InputError):
            snare.push("no such file.toml")
        with tempfile.TemporaryDirectory() as folder, self.assertRaises(FileNotFoundError):
            snare.load(folder)

    def test_files_of_results_that_are_none_are_named(self):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in (("law.json", "{"), ("law.json", "[1]"), ("law.json", '{"schema": "snare-law/1"}'),
                               ("trace.json", "[" * 100000), ("trace.json", ""), ("curves.csv", ""), ("curves.csv", "a,b\n1\n")):
                path = pathlib.Path(folder) / name
                path.write_text(text)
                with self.assertRaisesRegex(ValueError, name):
                    snare.load(path)

    def test_arguments_of_a_wrong_kind_are_refused(self):
        for wrong, says in (({"set": 5}, "set = 5"), ({"set": {5: 5}}, "a key of `set` is 5"), ({"progress": 5}, "progress = 5")):
            with self.assertRaisesRegex(TypeError, says):
                snare.push(EXPERIMENT, **wrong)
        # So many threads are refused: where the system gives none, the process would end.
        for threads in (-1, 1025):
            with self.assertRaisesRegex(ValueError, "from 0 to 1024"):
                snare.push(EXPERIMENT, threads=threads)

    def test_a_process_that_forks_may_work_on_both_sides(self):
        with multiprocessing.get_context("fork").Pool(2) as pool:
            forces = pool.map(last_force, range(4))
        self.assertEqual(forces, [last_force(0)] * 4)

    def test_values_that_toml_has_not_are_refused(self):
        with self.assertRaises(TypeError):
            snare.push(EXPERIMENT, set={"wire.diameter_mm": None})

    def test_a_solver_that_stops_raises_with_what_was_reached(self):
        file = setting.SOURCE / "data/scenarios/air_table.toml"
        with self.assertRaises(snare.SolverError) as caught:
            snare.simulate(file, set={"wires[wire].strength_N": 100.0, "wires[wire].at_strength": "stop", "wires[wire].elements": 32,
                                        "duration_s": 0.01})
        result = caught.exception.result
        self.assertIn("strength", str(caught.exception))
        self.assertLess(result["history"]["time_s"][-1], result["duration_s"])

    def test_a_csv_file_that_is_missing_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "x.toml"
            path.write_text((setting.SOURCE / "examples/push.toml").read_text().replace('"push_', '"nowhere_'))
            with self.assertRaisesRegex(snare.InputError, "nowhere_quarter.csv"):
                snare.trace(path)


class Watching(unittest.TestCase):
    def test_progress_is_told_and_what_it_raises_ends_the_work(self):
        class Enough(Exception):
            pass

        told = []

        def tell(text):
            told.append(text)
            raise Enough

        begin = time.monotonic()
        with self.assertRaises(Enough):
            snare.distil(WIRE, progress=tell)
        self.assertLess(time.monotonic() - begin, 5.0)
        self.assertEqual(len(told), 1)

    def test_other_threads_run_meanwhile(self):
        counted, done = [0], threading.Event()

        def count():
            while not done.is_set():
                counted[0] += 1
                time.sleep(0.001)

        other = threading.Thread(target=count)
        other.start()
        begin = time.monotonic()
        try:
            snare.trace(EXPERIMENT)
        finally:
            took = time.monotonic() - begin
            done.set()
            other.join()
        # Every millisecond if it never waits; a work that held the GIL would let it count once or twice.
        self.assertGreater(counted[0], 20 * took)

    def test_work_may_be_begun_from_several_threads(self):
        forces = [None, None]

        def push(k):
            forces[k] = snare.push(EXPERIMENT)["curves"]["middle"]["force_N"]

        threads = [threading.Thread(target=push, args=(k,)) for k in range(2)]
        for one in threads:
            one.start()
        for one in threads:
            one.join()
        np.testing.assert_array_equal(forces[0], forces[1])


if __name__ == "__main__":
    setting.main()
