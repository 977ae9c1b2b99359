"""Laws in Python: the numbers of the file, NumPy's shapes, and what is outside the range."""

import importlib.util
import json
import pathlib
import tempfile
import unittest

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
        self.assertEqual(law.force(1, 0.04, outside="extrapolate"), law.force(1.0, 0.04, outside="extrapolate"))
        with self.assertRaises(ValueError):
            law.force([1e-3, 2e-3], [0.04, 0.05, 0.06])

    def test_without_contact_there_is_no_force(self):
        self.assertEqual(self.law.force(-1.0, 0.04), 0.0)
        np.testing.assert_array_equal(self.law.simple[0].force([-1e-3, -1.0]), [0.0, 0.0])

    def test_outside_the_range_is_refused_or_extrapolated(self):
        law = self.law
        beyond = 1.1 * law.travel[1]
        with self.assertRaisesRegex(ValueError, "point 1: travel of 4.4 mm is outside the range"):
            law.force([1e-3, beyond], 0.04)
        end = law.travel[1]
        straight = law.force(end, 0.04) + law.stiffness(end, 0.04) * (beyond - end)
        self.assertAlmostEqual(law.force(beyond, 0.04, outside="extrapolate"), straight, delta=1e-9)
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
