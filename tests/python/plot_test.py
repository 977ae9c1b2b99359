"""The pictures show what the results have."""

import sys
import tempfile
import unittest

import setting
import snare
import snare.plot
import numpy as np

try:
    import matplotlib  # noqa: F401
except ImportError:
    print("skipped: matplotlib is not installed")
    sys.exit(setting.SKIPPED)

EXPERIMENT = setting.SOURCE / "examples/push.toml"


class Pictures(unittest.TestCase):
    def test_curves_have_the_numbers_in_millimetres(self):
        result = snare.push(EXPERIMENT)
        axes = snare.plot.curves(result)
        line = axes.get_lines()[0]
        np.testing.assert_allclose(line.get_xdata(), 1e3 * result["curves"]["quarter"]["displacement_m"])
        np.testing.assert_allclose(line.get_ydata(), result["curves"]["quarter"]["force_N"])
        self.assertEqual(axes.get_xlabel(), "travel [mm]")

    def test_a_trace_shows_both_models_and_what_is_left(self):
        result = snare.trace(EXPERIMENT)
        self.assertEqual(len(snare.plot.curves(result).get_lines()), 6)  # final, base, readings of two series
        left = snare.plot.residuals(result).get_lines()[1].get_ydata()  # the first is the zero
        middle = result["curves"]["middle"]
        np.testing.assert_allclose(left, middle["measured_N"] - middle["final_N"])

    def test_history_draws_the_named_columns(self):
        result = snare.simulate(setting.SOURCE / "data/scenarios/snare_on_pin.toml")
        axes = snare.plot.history(result, "pin x_m", "pin y_m")
        self.assertEqual([line.get_label() for line in axes.get_lines()], ["pin x_m", "pin y_m"])
        self.assertGreater(len(snare.plot.history(result).get_lines()), 0)

    def test_a_law_is_drawn_at_its_positions_and_saved(self):
        with tempfile.TemporaryDirectory() as folder:
            law = snare.distil(setting.small_wire(folder))["laws"][0]
        axes = snare.plot.law(law)
        self.assertEqual(axes.get_legend_handles_labels()[1][0], "s = 40 mm")
        with tempfile.NamedTemporaryFile(suffix=".png") as file:
            axes.figure.savefig(file.name)
            self.assertGreater(len(file.read()), 1000)

    def test_indices_are_bars_with_their_intervals(self):
        result = snare.sweep(setting.SOURCE / "examples/sweep.toml")
        axes = snare.plot.indices(result)
        shares = result["fields"]["force"]["sobol"]["variables"]
        self.assertEqual([text.get_text() for text in axes.get_xticklabels()], list(shares))
        bars = [bar.get_height() for bar in axes.patches]  # first of every variable, then total of every variable
        np.testing.assert_allclose(bars, [one[index] for index in ("first", "total") for one in shares.values()])
        (ends,) = axes.containers[-1].lines[2]  # of the last error bars
        np.testing.assert_allclose([segment[:, 1] for segment in ends.get_segments()], [one["total_interval95"] for one in shares.values()])
        self.assertIn("force", axes.get_ylabel())
        with self.assertRaisesRegex(ValueError, "must be one with Sobol indices: force"):
            snare.plot.indices(result, "tension")
        with self.assertRaisesRegex(ValueError, "this sweep has none"):
            snare.plot.indices({"fields": {"force": {"mean": 1.0}}})


if __name__ == "__main__":
    setting.main()
