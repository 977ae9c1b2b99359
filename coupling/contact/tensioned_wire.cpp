#include "coupling/contact/tensioned_wire.hpp"

#include <cmath>
#include <complex>
#include <numbers>

namespace snare::coupling {

namespace {

using Complex = std::complex<double>;

/// k l^3/EI at q = T l^2/EI: even in m, so that a tension may be negative or complex. All hyperbolic
/// functions are divided by exp(c), which cancels in D/N and keeps them finite.
Complex reduced_stiffness(Complex q, double sigma) {
  const Complex c = std::sqrt(q);
  const Complex a = sigma * c;
  const Complex b = (1.0 - sigma) * c;
  const Complex e = std::exp(-c);
  const auto cosh_scaled = [&](Complex x) { return 0.5 * (std::exp(x - c) + std::exp(-x - c)); };
  const auto sinh_scaled = [&](Complex x) { return 0.5 * (std::exp(x - c) - std::exp(-x - c)); };
  const Complex d = 2.0 * (e - cosh_scaled(c)) + c * sinh_scaled(c);
  const Complex both = 0.5 * (cosh_scaled(c) + cosh_scaled(a - b));  // cosh a cosh b
  const Complex n = 2.0 * (sinh_scaled(c) - sinh_scaled(a) - sinh_scaled(b)) + 2.0 * a * cosh_scaled(a) +
                    2.0 * b * cosh_scaled(b) - c * (cosh_scaled(c) + both) + a * b * sinh_scaled(c);
  return c * c * c * d / n;
}

}  // namespace

TensionedStiffness tensioned_stiffness(double bending_stiffness, double tension, double span,
                                       double position) {
  const double ei = bending_stiffness;
  const double q = tension * span * span / ei;
  const double sigma = position / span;
  // D and N lose their digits as c^4 and c^7 for small c. k is analytic in q (its nearest pole lies beyond
  // the buckling load), so that its value is its mean over a circle about q, and its derivative the first
  // moment.
  constexpr int points = 32;
  const double radius = 4.0;
  double value = 0.0;
  double slope = 0.0;
  if (std::abs(q) < 30.0) {
    for (int i = 0; i < points; ++i) {
      const Complex turn = std::polar(1.0, 2.0 * std::numbers::pi * (i + 0.5) / points);
      const Complex k = reduced_stiffness(q + radius * turn, sigma);
      value += k.real() / points;
      slope += (k * std::conj(turn)).real() / (radius * points);
    }
  } else {
    // By a complex step, exact to round-off.
    const double step = 1e-20 * std::abs(q);
    const Complex k = reduced_stiffness({q, step}, sigma);
    value = k.real();
    slope = k.imag() / step;
  }
  return {value * ei / (span * span * span), slope / span};
}

}  // namespace snare::coupling
