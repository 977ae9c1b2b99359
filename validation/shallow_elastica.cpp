#include "validation/shallow_elastica.hpp"

#include <cassert>
#include <cmath>
#include <complex>
#include <numbers>

#include "validation/closed_forms.hpp"
#include "validation/span_stiffness.hpp"

namespace snare::validation {
namespace {

using std::numbers::pi;
constexpr double kFirstLoad = 4.0 * pi * pi;

struct Compliance {
  double value = 0.0;
  double slope = 0.0;  // dG/dP
};

// Derivative by an infinitesimal imaginary part of the tension -P: no difference is taken.
Compliance compliance(double compression, double position) {
  constexpr double step = 1e-100;
  const std::complex<double> g = point_load_compliance({-compression, -step}, 1.0, position);
  return {g.real(), g.imag() / step};
}

}  // namespace

ShallowState shallow_state(double compression, double position) {
  assert(position > 0.0 && position < 1.0);
  if (compression == kFirstLoad) return {compression, 0.0, shallow_natural_deflection(position)};
  const Compliance g = compliance(compression, position);
  const double force = (compression < kFirstLoad ? 1.0 : -1.0) * std::sqrt(2.0 / g.slope);
  return {compression, force, force * g.value};
}

ShallowState shallow_state_at(double deflection, double position) {
  assert(deflection >= shallow_natural_deflection(position) &&
         deflection < shallow_taut_deflection(position));
  double low = -1.0;
  while (shallow_state(low, position).deflection < deflection) low *= 4.0;
  double high = kFirstLoad;
  // Deflection falls with P: bisection down to neighbouring numbers.
  for (int i = 0; i < 200 && high - low > 1e-15 * std::abs(low); ++i) {
    const double middle = 0.5 * (low + high);
    (shallow_state(middle, position).deflection > deflection ? low : high) = middle;
  }
  return shallow_state(0.5 * (low + high), position);
}

double shallow_natural_deflection(double position) {
  return (1.0 - std::cos(2.0 * pi * position)) / pi;
}

double shallow_taut_deflection(double position) {
  return std::sqrt(2.0 * position * (1.0 - position));
}

ShallowState shallow_largest_inward(double position) {
  // Golden section; the force is stationary there, so its error is the square of the compression's.
  const double ratio = 1.0 / std::numbers::phi;
  double low = kFirstLoad;
  double high = second_clamped_buckling_load(1.0, 1.0);
  if (position == 0.5) return shallow_state(high, position);
  double left = high - ratio * (high - low);
  double right = low + ratio * (high - low);
  double at_left = shallow_state(left, position).force;
  double at_right = shallow_state(right, position).force;
  for (int i = 0; i < 60; ++i) {
    if (at_left < at_right) {
      high = right;
      right = left;
      at_right = at_left;
      left = high - ratio * (high - low);
      at_left = shallow_state(left, position).force;
    } else {
      low = left;
      left = right;
      at_left = at_right;
      right = low + ratio * (high - low);
      at_right = shallow_state(right, position).force;
    }
  }
  return shallow_state(0.5 * (low + high), position);
}

double shallow_branch_stiffness() {
  return 1.0 / compliance(second_clamped_buckling_load(1.0, 1.0), 0.5).value;
}

}  // namespace snare::validation
