#include "coupling/contact/contact_law.hpp"

#include "coupling/contact/ranged_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace snare::coupling {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// The place of (L.4): mid-span; a form of the stretched wire asks for no bending stiffness.
LawPlace middle(double half_length, double half_span) {
  return {2.0 * half_span, half_span, 2.0 * half_length, 0.0};
}

/// Zeros of A d^2 + B d + C at d > 0, in their order [m].
std::vector<double> zeros(double a, double b, double c) {
  std::vector<double> all;
  const double square = b * b - 4.0 * a * c;
  if (square >= 0.0) {
    const double q = -0.5 * (b + std::copysign(std::sqrt(square), b));
    if (a != 0.0) all.push_back(q / a);
    if (q != 0.0) all.push_back(c / q);
  }
  std::erase_if(all, [](double d) { return d <= 0.0; });
  std::ranges::sort(all);
  return all;
}

/// Where A d^2 + B d + C is negative at d > 0: between some of its zeros.
std::vector<PullingRange> pulling_ranges(double a, double b, double c) {
  std::vector<PullingRange> ranges;
  double from = 0.0;
  const auto add = [&](double to, double inside) {
    if ((a * inside + b) * inside + c < 0.0) ranges.push_back({from, to});
    from = to;
  };
  for (const double zero : zeros(a, b, c)) add(zero, 0.5 * (from + zero));
  add(std::numeric_limits<double>::infinity(), 2.0 * from + 1.0);
  return ranges;
}

}  // namespace

Vector3d ContactLaw::operator()(double d, double rate) const {
  if (d <= 0.0) return Vector3d::Zero();
  Vector3d force(spring_->force(d), spring_->stiffness(d), 0.0);
  if (damping_) force += damping_(d, rate);
  return force.x() <= 0.0 ? Vector3d::Zero() : force;  // what is not a number stays that
}

Vector3d ContactLaw::elastic(double d) const {
  return d > 0.0 ? Vector3d(spring_->force(d), spring_->stiffness(d), spring_->curvature(d))
                 : Vector3d::Zero();
}

Damping linear_damping(double c) {
  return [c](double, double rate) { return Vector3d(c * rate, 0.0, c); };
}

Damping power_damping(double c, double q, double n) {
  return [c, q, n](double d, double rate) {
    const double depth = c * std::pow(d, n);
    const double damping = depth * std::copysign(std::pow(std::abs(rate), q), rate);
    return Vector3d(damping, n * damping / d, depth * q * std::pow(std::abs(rate), q - 1.0));
  };
}

Damping step_damping(double c, double depth) {
  return [c, depth](double d, double rate) {
    // G = x^2 (3 - 2 x), x = d/depth, 1 beyond the depth.
    const double x = std::min(d / depth, 1.0);
    const double step = x * x * (3.0 - 2.0 * x);
    const double slope = 6.0 * x * (1.0 - x) / depth;
    return Vector3d(c * step * rate, c * slope * rate, c * step);
  };
}

ContactLaw spring_dashpot(double k, double c) {
  return ContactLaw(linear_law()->with(Eigen::VectorXd::Constant(1, k)), linear_damping(c));
}

ContactLaw power_law(double k, double p, double c, double q) {
  return power_law(k, p, c, q, p);
}

ContactLaw power_law(double k, double p, double c, double q, double n) {
  return ContactLaw(power_law()->with(Vector2d(k, p)), power_damping(c, q, n));
}

ContactLaw step_damped_law(double k, double p, double c, double depth) {
  return ContactLaw(power_law()->with(Vector2d(k, p)), step_damping(c, depth));
}

ContactLaw quadratic_law(double a, double b, double c) {
  return ContactLaw(
      std::make_shared<PressingLaw>(quadratic_law()->with(Vector3d(a, b, c)), pulling_ranges(a, b, c)));
}

ContactLaw stretched_wire_law(double stiffness, double half_length, double half_span, Damping damping) {
  return ContactLaw(
      stretched_wire_law(middle(half_length, half_span))->with(Vector2d(stiffness * half_length, 0.0)),
      std::move(damping));
}

ContactLaw stretched_wire_tangent(double stiffness, double half_length, double half_span, Damping damping) {
  return ContactLaw(
      stretched_wire_linearised(middle(half_length, half_span))->with(Vector2d(stiffness * half_length, 0.0)),
      std::move(damping));
}

}  // namespace snare::coupling
