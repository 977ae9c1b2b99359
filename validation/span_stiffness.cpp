#include "validation/span_stiffness.hpp"

#include <cassert>
#include <cmath>

namespace snare::validation {
namespace {

using Complex = std::complex<double>;

// With q = u^2:  D/u^4 = sum_{n>=2} (2n-2) q^(n-2) / (2n)!,  sinh u/u = sum q^n/(2n+1)!,
// (cosh u - 1)/u^2 = sum_{n>=1} q^(n-1)/(2n)!,  (u cosh u - sinh u)/u^3 = sum_{n>=1} 2n q^(n-1)/(2n+1)!.
// Fourteen terms leave less than 1e-26 at |q| = 1.
SpanStiffness by_series(Complex q) {
  Complex denominator = 0.0;
  Complex sine = 0.0;
  Complex cosine = 0.0;
  Complex mixed = 0.0;
  Complex power = 1.0;     // q^n
  double factorial = 1.0;  // (2n)!
  for (int n = 0; n < 14; ++n) {
    const double odd_factorial = factorial * (2 * n + 1);  // (2n+1)!
    const double next = odd_factorial * (2 * n + 2);       // (2n+2)!
    const double next_odd = next * (2 * n + 3);            // (2n+3)!
    const double after_next = next_odd * (2 * n + 4);      // (2n+4)!
    sine += power / odd_factorial;
    cosine += power / next;
    mixed += power * ((2.0 * n + 2.0) / next_odd);
    denominator += power * ((2.0 * n + 2.0) / after_next);
    power *= q;
    factorial = next;
  }
  return {sine / denominator, cosine / denominator, mixed / denominator};
}

// Tension: numerators and denominator times 2 exp(-u).
SpanStiffness by_exponentials(Complex u) {
  const Complex e = std::exp(-u);
  const Complex sine = 1.0 - e * e;
  const Complex cosine = 1.0 + e * e;
  const Complex denominator = 4.0 * e - 2.0 * cosine + u * sine;
  return {u * u * u * sine / denominator, u * u * (cosine - 2.0 * e) / denominator,
          u * (u * cosine - sine) / denominator};
}

// Compression, u = i v.
SpanStiffness by_circular(Complex v) {
  const Complex s = std::sin(v);
  const Complex c = std::cos(v);
  const Complex denominator = 2.0 * (1.0 - c) - v * s;
  return {v * v * v * s / denominator, v * v * (1.0 - c) / denominator, v * (s - v * c) / denominator};
}

}  // namespace

SpanStiffness span_stiffness(Complex tension, double length) {
  assert(length > 0.0);
  const Complex q = tension * length * length;
  SpanStiffness k;
  if (std::abs(q) < 1.0) {
    k = by_series(q);
  } else if (q.real() > 0.0) {
    k = by_exponentials(std::sqrt(q));
  } else {
    k = by_circular(std::sqrt(-q));
  }
  k.deflection /= length * length * length;
  k.coupling /= length * length;
  k.rotation /= length;
  return k;
}

Complex point_load_compliance(Complex tension, double length, double position) {
  assert(position > 0.0 && position < length);
  const SpanStiffness a = span_stiffness(tension, position);
  const SpanStiffness b = span_stiffness(tension, length - position);
  const Complex coupling = a.coupling - b.coupling;
  Complex stiffness = a.deflection + b.deflection;
  // At mid-span the slope decouples; it is left out so that its buckling does not make 0/0.
  if (coupling != 0.0) stiffness -= coupling * coupling / (a.rotation + b.rotation);
  return 1.0 / stiffness;
}

}  // namespace snare::validation
