"""Laws in Python: the numbers of the file, NumPy's shapes, and what is outside the range."""

import copy
import importlib.util
import json
import multiprocessing
import pathlib
import pickle
import tempfile
import unittest
import warnings

import setting
import snare
import numpy as np


class Laws(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = pathlib.Path(cls.folder.name)
        setting.run_command("distil", str(setting.small_wire(cls.out)), "--out", cls.folder.name)
        cls.law = snare.Law(cls.out / "law.json")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def exported(self):
        """law.py of the command: a table of its own that shares no code with the module."""
        specification = importlib.util.spec_from_file_location("law", self.out / "law.py")
        module = importlib.util.module_from_spec(specification)
        specification.loader.exec_module(module)
        return module

    def test_force_is_that_of_the_exported_python_module(self):
        exported, law = self.exported(), self.law
        random = np.random.default_rng(1)
        d, s, e = (random.uniform(*range_, 200) for range_ in (law.travel, law.position, law.slack))
        ours = law.force(d, s, e)
        theirs = [exported.force(*point) for point in zip(d, s, e)]
        np.testing.assert_allclose(ours, theirs, rtol=1e-12, atol=1e-12)  # round-off of either
        mirrored = law.force(d, law.span - s, e)
        np.testing.assert_allclose(mirrored, ours, rtol=1e-12, atol=1e-12)

    def test_nodes_of_the_file_are_met(self):
        table = json.loads((self.out / "law.json").read_text())["cases"][0]["table"]
        nodes = np.reshape(table["nodes"], (len(table["slack"]), len(table["position"]), len(table["travel"]), 8))
        span = table["span_m"]
        e, s, d = np.meshgrid(table["slack"], table["position"], table["travel"], indexing="ij")
        force = self.law.force(d * span, s * span, e * span, outside="extrapolate")
        np.testing.assert_allclose(force, table["force_scale_N"] * nodes[..., 0], rtol=1e-9, atol=1e-9)
        stiffness = self.law.stiffness(d * span, s * span, e * span, outside="extrapolate")
        np.testing.assert_allclose(stiffness, table["force_scale_N"] / span * nodes[..., 1], rtol=1e-6, atol=1e-3)

    def test_stiffness_is_the_slope_of_the_force(self):
        d = np.linspace(0.2e-3, 3.9e-3, 50)
        h = 1e-8
        slope = (self.law.force(d + h, 0.06) - self.law.force(d - h, 0.06)) / (2 * h)
        np.testing.assert_allclose(self.law.stiffness(d, 0.06), slope, rtol=1e-4)  # differences of 1e-8 m: h^2 and knots

    def test_shapes_are_numpys(self):
        law = self.law
        self.assertIsInstance(law.force(1e-3, 0.04), float)
        self.assertEqual(law.force([], 0.04).shape, (0,))
        grid = law.force(np.array([[1e-3], [2e-3]]), np.array([0.04, 0.05, 0.06]))
        self.assertEqual(grid.shape, (2, 3))
        self.assertEqual(grid[1, 2], law.force(2e-3, 0.06))
        line = np.linspace(0, 4e-3, 9)
        np.testing.assert_array_equal(law.force(line[::2], 0.04), law.force(line, 0.04)[::2])  # strides
        with self.assertWarns(snare.OutsideRange):
            self.assertEqual(law.force(1, 0.04), law.force(1.0, 0.04))
        with self.assertRaises(ValueError):
            law.force([1e-3, 2e-3], [0.04, 0.05, 0.06])

    def test_without_contact_there_is_no_force(self):
        self.assertEqual(self.law.force(-1.0, 0.04), 0.0)
        np.testing.assert_array_equal(self.law.simple[0].force([-1e-3, -1.0]), [0.0, 0.0])

    def test_outside_the_range_is_refused_or_extrapolated(self):
        law = self.law
        beyond = 1.1 * law.travel[1]
        with self.assertRaisesRegex(ValueError, "point 1: travel of 4.4 mm is outside the range"):
            law.force([1e-3, beyond], 0.04, outside="refuse")
        end = law.travel[1]
        straight = law.force(end, 0.04) + law.stiffness(end, 0.04) * (beyond - end)
        with self.assertWarns(snare.OutsideRange):
            self.assertAlmostEqual(law.force(beyond, 0.04), straight, delta=1e-9)
        self.assertEqual(list(law.in_range([1e-3, beyond], 0.04)), [True, False])
        with self.assertRaises(ValueError):
            law.force(1e-3, 0.04, outside="maybe")
        with self.assertRaises(ValueError):
            law.force(1e-3, 0.04, unloading=True)

    def test_nan_never_comes_back(self):
        for bad in (np.nan, np.inf):
            with self.assertRaisesRegex(ValueError, "must be finite"):
                self.law.force([1e-3, bad], 0.04, outside="extrapolate")

        with self.assertRaisesRegex(ValueError, "beyond all numbers"):
            self.law.force(1e308, 1e308, 1e308, outside="extrapolate")
        simple = self.law.simple[0]
        for bad in (np.nan, np.inf):
            with self.assertRaisesRegex(ValueError, "must be finite"):
                simple.force(bad)
        with self.assertRaisesRegex(ValueError, "point 1: at 1e\\+308: the result is beyond all numbers"):
            simple.energy([1e-3, 1e308])

    def test_what_is_no_real_number_is_refused_by_name(self):
        law = self.law
        for bad in ("x", np.array(["1e-3"]), 1e-3 + 2j, np.array([1e-3 + 2j]), np.datetime64("2020-01-01"), b"1"):
            with self.assertRaisesRegex(TypeError, "s = .*, must be a number or an array of real numbers"):
                law.force(1e-3, bad)
        with self.assertRaises(TypeError):
            law.force({}, 0.04)
        with self.assertRaises(ValueError):
            law.force([[1e-3], [1e-3, 2e-3]], 0.04)
        with self.assertRaises(MemoryError):
            law.force(np.broadcast_to(1e-3, 10**15), 0.04)

    def test_any_layout_of_an_array_is_read(self):
        law, d = self.law, np.array([[1e-3, 2e-3], [3e-3, 0.5e-3]])
        force = law.force(d, 0.04)
        fixed = d.copy()
        fixed.setflags(write=False)
        odd = np.zeros((2, 2), dtype=[("a", "i1"), ("d", "f8")])  # not aligned
        odd["d"] = d
        for other in (np.asfortranarray(d), fixed, d.astype(">f8"), d.astype(object), odd["d"], d[::-1, ::-1][::-1, ::-1]):
            np.testing.assert_array_equal(law.force(other, 0.04), force)

    def test_masks_stay_masks(self):
        law, simple = self.law, self.law.simple[0]
        d = np.ma.array([1e-3, np.nan, 2e-3, 1e9], mask=[False, True, False, True])
        for force, plain in ((law.force(d, 0.04), law.force([1e-3, 2e-3], 0.04)), (simple.force(d), simple.force([1e-3, 2e-3]))):
            self.assertIsInstance(force, np.ma.MaskedArray)
            np.testing.assert_array_equal(np.ma.getmaskarray(force), d.mask)
            np.testing.assert_array_equal(force.compressed(), plain)
        s = np.ma.array([[0.04], [0.05]], mask=[[False], [True]])
        grid = law.force(np.array([1e-3, 2e-3, 3e-3]), s)
        np.testing.assert_array_equal(np.ma.getmaskarray(grid), [[False] * 3, [True] * 3])
        self.assertIs(law.force(np.ma.masked, 0.04), np.ma.masked)
        self.assertIsInstance(law.force(np.ma.array([1e-3]), 0.04), np.ma.MaskedArray)
        self.assertFalse(np.ma.isMaskedArray(law.force(np.array([1e-3]), 0.04)))
        np.testing.assert_array_equal(np.ma.getmaskarray(law.in_range(d, 0.04)), d.mask)

    def test_laws_are_pickled_and_copied_to_the_last_bit(self):
        random = np.random.default_rng(3)
        d, s, e = random.uniform(-1e-3, 8e-3, 100), random.uniform(0.0, self.law.span, 100), random.uniform(0.0, 1e-3, 100)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", snare.OutsideRange)
            for other in [pickle.loads(pickle.dumps(self.law, protocol)) for protocol in range(2, 6)] + [copy.deepcopy(self.law)]:
                self.assertEqual(repr(other), repr(self.law))
                np.testing.assert_array_equal(other.force(d, s, e), self.law.force(d, s, e))
                for one, simple in zip(other.simple, self.law.simple, strict=True):
                    self.assertEqual((one.name, one.position, one.formula, one.parameters, one.travel, one.largest_error),
                                     (simple.name, simple.position, simple.formula, simple.parameters, simple.travel, simple.largest_error))
                    np.testing.assert_array_equal(one.energy(d), simple.energy(d))
            with multiprocessing.get_context("spawn").Pool(1) as pool:
                np.testing.assert_array_equal(pool.apply(self.law.force, (d, s, e)), self.law.force(d, s, e))
        rebuild, (state,) = self.law.__reduce__()
        for broken in (state[:-1], (99, *state[1:]), (*state[:2], state[2][:-1], *state[3:]), ()):
            with self.assertRaisesRegex(ValueError, "no state of a law"):
                rebuild(broken)

    def test_what_new_alone_has_made_is_refused(self):
        for kind in (snare.Law, snare.SimpleLaw):
            empty = kind.__new__(kind)
            members = [name for name in dir(kind) if not name.startswith("_")] + ["__repr__", "__reduce__"]
            self.assertGreater(len(members), 8)
            for name in members:
                with self.assertRaisesRegex(TypeError, "made by __new__"):
                    member = getattr(empty, name)
                    member(*[1e-3, 0.04][:2 if kind is snare.Law else 1] if not name.startswith("_") else ())
        with self.assertRaises(TypeError):
            snare.SimpleLaw()

    def test_arguments_of_a_wrong_kind_are_named(self):
        law, simple = self.law, self.law.simple[0]
        for call, message in (
                (lambda: snare.Law({"a": 1}), "file = {'a': 1}, must be the path of a file"),
                (lambda: snare.Law(self.out / "law.json", case="0"), "case = '0', must be a whole number"),
                (lambda: law.force(1e-3, 0.04, outside=1), "outside = 1, must be 'extrapolate' or 'refuse'"),
                (lambda: simple.force(1e-3, outside=None), "outside = None, must be 'extrapolate' or 'refuse'"),
                (lambda: law.force(1e-3, 0.04, unloading="no"), "unloading = 'no', must be True or False"),
                (lambda: snare.push({"wire": 1}), "experiment = {'wire': 1}, must be the path of a file"),
                (lambda: snare.sweep(3), "study = 3, must be the path of a file"),
                (lambda: snare.sweep("x.toml", out=3), "out = 3, must be the path of a file"),
                (lambda: snare.load([]), "path = \\[\\], must be the path of a file"),
                (lambda: snare.distil("x.toml", threads="2"), "threads = '2', must be a whole number")):
            with self.assertRaisesRegex(TypeError, message):
                call()

    def test_simple_laws_have_the_numbers_of_the_file(self):
        place = json.loads((self.out / "law.json").read_text())["cases"][0]["positions"][0]
        quadratic = next(one for one in self.law.simple if one.name == "quadratic")
        numbers = {key: value["value"] for key, value in place["laws"][0]["parameters"].items()}
        self.assertEqual({key: value for key, (value, _) in quadratic.parameters.items()}, numbers)
        d = np.array([1e-3, 2e-3])
        np.testing.assert_allclose(quadratic.force(d), numbers["A"] * d**2 + numbers["B"] * d + numbers["C"], rtol=1e-14)
        np.testing.assert_allclose(quadratic.stiffness(d), 2 * numbers["A"] * d + numbers["B"], rtol=1e-14)
        np.testing.assert_allclose(quadratic.energy(d),
                                   numbers["A"] * d**3 / 3 + numbers["B"] * d**2 / 2 + numbers["C"] * d, rtol=1e-14)

    def test_a_file_that_is_none_names_the_field(self):
        good = json.loads((self.out / "law.json").read_text())

        def refused(change):
            document = json.loads(json.dumps(good))
            change(document)
            path = self.out / "broken.json"
            path.write_text(json.dumps(document))
            with self.assertRaises(snare.InputError) as caught:
                snare.Law(path)
            return str(caught.exception)

        self.assertIn("schema", refused(lambda x: x.update(schema="snare-wire/1")))
        self.assertIn("cases[1].table.nodes", refused(lambda x: x["cases"][0]["table"]["nodes"].pop()))
        self.assertIn("cases[1].table.travel", refused(lambda x: x["cases"][0]["table"]["travel"].reverse()))
        self.assertIn("cases[1].wire.span_mm", refused(lambda x: x["cases"][0]["wire"].pop("span_mm")))
        self.assertIn("cases[1].positions[1].laws[1].name",
                      refused(lambda x: x["cases"][0]["positions"][0]["laws"][0].update(name="cubic")))
        with self.assertRaises(IndexError):
            snare.Law(self.out / "law.json", case=1)


if __name__ == "__main__":
    setting.main()
