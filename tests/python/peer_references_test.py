"""The references of benchmarks/peers against published numbers and closed forms, and what its scripts make of the programs' output.

Needs numpy and scipy; skipped, saying so, where there are none.
"""

import math
import os
import pathlib
import sys
import unittest

SOURCE = pathlib.Path(os.environ.get("SNARE_SOURCE_DIR", pathlib.Path(__file__).parents[2]))
sys.path.insert(0, str(SOURCE / "benchmarks/peers"))
try:
    import numpy as np
    import peer
    import references as ref
    import run
except ImportError as reason:
    print(f"skipped: {reason}")
    sys.exit(77)


class References(unittest.TestCase):
    def test_a_knife_edge_at_mid_span(self):
        # 232.98287479 N by multiple shooting (benchmarks/README.md); collocation to 1e-9 of the largest component
        self.assertAlmostEqual(ref.Elastica(0.5 * ref.SPAN, radius=0.0).push(1.5e-3), 232.98287479, delta=1e-6)

    def test_the_energy_of_an_undamped_impact(self):
        # All of the body's kinetic energy goes into the wire and comes back; 110.220 N is where the static curve has taken it up.
        result = ref.impact(damping=0.0, points=21)
        self.assertAlmostEqual(result["impulse_Ns"], 2 * ref.MASS * ref.SPEED, delta=1e-6)
        self.assertAlmostEqual(result["peak_N"], 110.220, delta=1e-3)

    def test_damping_lowers_peak_and_rebound(self):
        damped, undamped = ref.impact(points=11), ref.impact(damping=0.0, points=11)
        self.assertLess(damped["peak_N"], undamped["peak_N"])
        self.assertLess(damped["impulse_Ns"], undamped["impulse_Ns"])

    def test_the_tip_of_a_cantilever(self):
        # Bisshopp and Drucker (1945): tip at 0.3017 across for F L^2 = EI; the wire's stretch is 1e-5 here.
        self.assertAlmostEqual(ref.inextensible_tip(1.0)[1], 0.3017, delta=5e-5)
        for load in (0.5, 4.0):
            for extensible, inextensible in zip(ref.cantilever_tip(load), ref.inextensible_tip(load)):
                self.assertAlmostEqual(extensible, inextensible, delta=3e-5)
        self.assertAlmostEqual(ref.cantilever_tip(1e-3)[1], 1e-3 / 3, delta=1e-9)  # F L^3 / 3 EI; the error is cubic in the load

    def test_known_roots(self):
        self.assertAlmostEqual(ref.ROOT, 1.875104068711961, delta=1e-12)
        self.assertAlmostEqual(ref.first_mode(1.0), 1.0, delta=1e-12)
        self.assertAlmostEqual(ref.GREENHILL * ref.LENGTH / ref.BENDING, 8.986818915818, delta=1e-9)


class Evaluation(unittest.TestCase):
    def test_the_critical_twist_of_a_parabola(self):
        self.assertAlmostEqual(peer.critical([(1.01 - s) * (3.0 + s) for s in peer.SHARES]), 1.01, delta=1e-9)

    def test_the_parabola_on_the_exact_squares(self):
        # Clamped wire under a twisting moment, EI d4w - i M d3w = rho A omega^2 w with w = y + i z: roots of its determinant
        def determinant(square, share):
            roots = np.roots([1.0, -1j * share * ref.GREENHILL * ref.LENGTH / ref.BENDING, 0.0, 0.0, -square])
            rows = np.array([np.ones(4), roots, np.exp(roots), roots * np.exp(roots)])
            return np.linalg.det(rows) / np.prod([roots[i] - roots[j] for i in range(4) for j in range(i)])

        squares = []
        for share in peer.SHARES:
            tried = np.linspace(1.0, 300.0, 3000)
            values = np.array([determinant(k, share) for k in tried])
            values = np.real(values / values[0])
            k = np.argmax(values[:-1] * values[1:] < 0)
            squares.append(tried[k] - values[k] * (tried[k + 1] - tried[k]) / (values[k + 1] - values[k]))
        self.assertAlmostEqual(peer.critical(squares), 1.0, delta=2e-4)  # error of the parabola

    def test_the_frequency_of_a_sine_with_an_overtone(self):
        time = np.arange(0.0, 0.2, 1e-4)
        values = np.cos(2 * np.pi * 32.0 * time + 0.3) + 0.02 * np.cos(2 * np.pi * 200.0 * time)
        self.assertAlmostEqual(peer.frequency(values, 1e-4), 32.0, delta=1e-3)  # the overtone, orthogonal but for the ends

    def test_the_peak_of_a_half_sine(self):
        # Mean over 0.1 ms about the top of a force of 100 N that lasts 30 ms
        time = np.arange(0.0, 0.03, 1e-5)
        speeds = 100.0 / 8.9 * (0.03 / np.pi) * np.cos(np.pi * time / 0.03)
        self.assertAlmostEqual(peer.peak(speeds, 1e-5, 8.9), 100.0, delta=2e-3)

    def test_the_order_of_errors(self):
        rows = [{"error": 3.0 * h**2} for h in (1.0, 0.5, 0.25)]
        self.assertAlmostEqual(run.order(rows), 2.0)
        self.assertIsNone(run.order([{"error": 1.0}, {"error": 2.0}, {"error": 0.5}]))
        self.assertIsNone(run.order([{"error": 1.0}, {"reason": "diverges"}, {"error": 0.5}]))

    def test_the_error_of_a_curve_is_over_its_largest_force(self):
        self.assertAlmostEqual(run.errors("push", {"force_N": [1.5, 10.0]}, {"force_N": [1.0, 10.0]})["force"], 0.05)
        self.assertTrue(math.isnan(run.errors("twist", {"critical": float("nan")}, None)["twist"]))


if __name__ == "__main__":
    unittest.main(verbosity=2)
