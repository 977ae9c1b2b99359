#include "validation/elastica.hpp"

#include <cassert>
#include <cmath>
#include <numbers>

namespace snare::validation {
namespace {

// Root of an increasing function between two numbers, to neighbouring numbers.
template <class Function>
double increasing_root(const Function& function, double low, double high) {
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (function(middle) < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

BuckledElastica buckled(double bending_stiffness, double length, double span, double quarters) {
  assert(span > 0.0 && span < length);
  // The span falls as k grows.
  const double k = increasing_root(
      [&](double modulus) {
        return span / length - (2.0 * std::comp_ellint_2(modulus) / std::comp_ellint_1(modulus) - 1.0);
      },
      0.0, 1.0 - 1e-15);
  const double complete = std::comp_ellint_1(k);
  BuckledElastica result;
  const double wave_number = quarters * complete / length;
  result.modulus = k;
  result.compression = bending_stiffness * wave_number * wave_number;
  result.height = k * length / complete;
  result.crown_moment = 2.0 * k * wave_number * bending_stiffness;  // theta'^2 = 4 k^2 w^2 at the crown
  return result;
}

}  // namespace

BuckledElastica clamped_elastica(double bending_stiffness, double length, double span) {
  return buckled(bending_stiffness, length, span, 4.0);
}

BuckledElastica pinned_elastica(double bending_stiffness, double length, double span) {
  return buckled(bending_stiffness, length, span, 2.0);
}

CantileverTip cantilever_tip(double bending_stiffness, double length, double force) {
  const double root = std::sqrt(force * length * length / bending_stiffness);
  const auto amplitude = [](double k) { return std::asin(1.0 / (k * std::numbers::sqrt2)); };
  const double k = increasing_root(
      [&](double modulus) {
        return std::comp_ellint_1(modulus) - std::ellint_1(modulus, amplitude(modulus)) - root;
      },
      1.0 / std::numbers::sqrt2 + 1e-15, 1.0 - 1e-15);
  const double sine = 2.0 * k * k - 1.0;
  const double missing = std::comp_ellint_2(k) - std::ellint_2(k, amplitude(k));
  CantileverTip tip;
  tip.angle = std::asin(sine);
  tip.deflection = length * (1.0 - 2.0 * missing / root);
  tip.shortening = length * (1.0 - std::sqrt(2.0 * sine) / root);
  return tip;
}

CantileverTip cantilever_under_moment(double bending_stiffness, double length, double moment) {
  const double angle = moment * length / bending_stiffness;
  assert(angle != 0.0);
  return {angle, length * (1.0 - std::cos(angle)) / angle, length * (1.0 - std::sin(angle) / angle)};
}

}  // namespace snare::validation
