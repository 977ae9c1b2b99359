#include "validation/rod_instability.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace snare::validation {
namespace {

using std::numbers::pi;

// Root in a bracket with a change of sign.
template <class Function>
double bracketed_root(const Function& function, double low, double high) {
  const bool rising = function(high) > 0.0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    ((function(middle) < 0.0) == rising ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double sinc(double x) {
  return std::abs(x) < 1e-4 ? 1.0 - x * x / 6.0 : std::sin(x) / x;
}

// (sinc a sinc b - sinc(a - b))/b; the plain form loses the root as b -> 0, where it tends to sinc'(a).
double clamped_condition(double a, double b) {
  if (std::abs(b) > 1e-3) return (sinc(a) * sinc(b) - sinc(a - b)) / b;
  const double s = std::sin(a);
  const double c = std::cos(a);
  const double first = (a * c - s) / (a * a);
  const double second = -s / a - 2.0 * first / a;
  const double third = -c / a + s / (a * a) - 2.0 * second / a + 2.0 * first / (a * a);
  return first - b * (s / (6.0 * a) + second / 2.0) + b * b * third / 6.0;
}

// J_{-1/4}(x) without its factor (x/2)^(-1/4)/Gamma(3/4): sum (-x^2/4)^n / (n! (3/4)_n).
double bessel_quarter(double x) {
  double term = 1.0;
  double sum = 1.0;
  for (int n = 1; n < 40; ++n) {
    term *= -0.25 * x * x / (n * (n - 0.25));
    sum += term;
  }
  return sum;
}

}  // namespace

double HelicalBuckling::envelope(double arc_length) const {
  const double decay = std::sqrt(tension_scaled - 0.25 * moment_scaled * moment_scaled);
  const double t = std::tanh((arc_length / length - 0.5) * decay);
  return t * t;
}

HelicalBuckling helical_buckling(double bending_stiffness, double torsional_stiffness, double length,
                                 double shortening, double end_rotation) {
  const double ratio = length / shortening;
  const double twist = 4.0 * ratio * bending_stiffness / torsional_stiffness;
  const auto excess = [&](double psi) { return twist * std::sin(2.0 * psi) + 4.0 * psi - end_rotation; };
  // The left side rises up to cos 2 psi = -2/twist.
  const double top = 0.5 * std::acos(-2.0 / std::max(twist, 2.0));
  HelicalBuckling result;
  result.length = length;
  if (excess(top) < 0.0) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    return {none, none, none, none, none, length};
  }
  const double psi = bracketed_root(excess, 0.0, top);
  const double root = 4.0 * ratio * std::sin(psi);
  result.tension_scaled = root * root;
  result.moment_scaled = 2.0 * root * std::cos(psi);
  result.moment = result.moment_scaled * bending_stiffness / length;
  result.tension = result.tension_scaled * bending_stiffness / (length * length);
  result.largest_angle = 2.0 * psi;  // cos phi_0 = 2 cos^2 psi - 1
  return result;
}

double critical_torque_clamped(double bending_stiffness, double tension, double length) {
  const double product = 0.25 * tension * length * length / bending_stiffness;  // a b
  assert(product > -pi * pi);
  const auto condition = [&](double a) { return clamped_condition(a, product / a); };
  // a grows from the least real torque (tension) or from no torque (compression); the first change of sign.
  constexpr double step = 0.01;
  double low = std::max(std::sqrt(std::abs(product)), 1e-2);
  while (condition(low) * condition(low + step) > 0.0) low += step;
  const double a = bracketed_root(condition, low, low + step);
  return 2.0 * bending_stiffness / length * (a + product / a);
}

double critical_torque_pinned(double bending_stiffness, double tension, double length) {
  const double bare = 2.0 * pi * bending_stiffness / length;
  return std::sqrt(4.0 * bending_stiffness * tension + bare * bare);
}

double critical_ring_twist(double bending_stiffness, double torsional_stiffness) {
  return 2.0 * pi * std::numbers::sqrt3 * bending_stiffness / torsional_stiffness;
}

double lateral_buckling_load(double bending_stiffness, double torsional_stiffness, double length) {
  const double root = bracketed_root(bessel_quarter, 1.5, 2.5);
  return 2.0 * root * std::sqrt(bending_stiffness * torsional_stiffness) / (length * length);
}

double lateral_buckling_moment(double bending_stiffness, double torsional_stiffness, double length) {
  return pi * std::sqrt(bending_stiffness * torsional_stiffness) / length;
}

}  // namespace snare::validation
