#include "validation/closed_forms.hpp"

#include <cmath>
#include <numbers>

#include "validation/span_stiffness.hpp"

namespace snare::validation {

double tensioned_clamped_stiffness(double bending_stiffness, double tension, double span, double position) {
  return bending_stiffness / point_load_compliance(tension / bending_stiffness, span, position).real();
}

double string_force(double tension, double span, double position, double deflection) {
  return tension * deflection * span / (position * (span - position));
}

double unstretched_wire_force(double axial_stiffness, double span, double position, double deflection) {
  const double slopes = 1.0 / position + 1.0 / (span - position);
  return axial_stiffness * deflection * deflection * deflection / (2.0 * span) * slopes * slopes;
}

double three_point_stiffness(double bending_stiffness, double span, double position) {
  const double product = position * (span - position);
  return 3.0 * bending_stiffness * span / (product * product);
}

double first_root_of_tan_x_equals_x() {
  // Newton on sin x - x cos x, derivative x sin x, from the zero of cos x nearest.
  double x = 1.5 * std::numbers::pi - 0.2;
  for (int i = 0; i < 8; ++i) x -= (std::sin(x) - x * std::cos(x)) / (x * std::sin(x));
  return x;
}

double buckling_load(ColumnEnds ends, double bending_stiffness, double length) {
  constexpr double pi = std::numbers::pi;
  const double x = first_root_of_tan_x_equals_x();
  double factor = 0.0;
  switch (ends) {
    case ColumnEnds::clamped_free:
      factor = 0.25 * pi * pi;
      break;
    case ColumnEnds::pinned_pinned:
      factor = pi * pi;
      break;
    case ColumnEnds::clamped_pinned:
      factor = x * x;
      break;
    case ColumnEnds::clamped_clamped:
      factor = 4.0 * pi * pi;
      break;
  }
  return factor * bending_stiffness / (length * length);
}

double second_clamped_buckling_load(double bending_stiffness, double length) {
  const double x = first_root_of_tan_x_equals_x();
  return 4.0 * x * x * bending_stiffness / (length * length);
}

double capstan_ratio(double friction, double wrap_angle) {
  return std::exp(friction * wrap_angle);
}

}  // namespace snare::validation
