#include "coupling/contact/contact_law.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace snare::coupling {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// The place of (L.4): mid-span; a form of the stretched wire asks for no bending stiffness.
LawPlace middle(double half_length, double half_span) {
  return {2.0 * half_span, half_span, 2.0 * half_length, 0.0};
}

}  // namespace

ContactLaw contact_law(SpringLawPointer spring, Damping damping) {
  return [spring = std::move(spring), damping = std::move(damping)](double d, double rate) -> Vector3d {
    if (d <= 0.0) return Vector3d::Zero();
    Vector3d force(spring->force(d), spring->stiffness(d), 0.0);
    if (damping) force += damping(d, rate);
    return force.x() > 0.0 ? force : Vector3d::Zero();
  };
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
  return contact_law(linear_law()->with(Eigen::VectorXd::Constant(1, k)), linear_damping(c));
}

ContactLaw power_law(double k, double p, double c, double q) {
  return power_law(k, p, c, q, p);
}

ContactLaw power_law(double k, double p, double c, double q, double n) {
  return contact_law(power_law()->with(Vector2d(k, p)), power_damping(c, q, n));
}

ContactLaw step_damped_law(double k, double p, double c, double depth) {
  return contact_law(power_law()->with(Vector2d(k, p)), step_damping(c, depth));
}

ContactLaw quadratic_law(double a, double b, double c) {
  return contact_law(quadratic_law()->with(Vector3d(a, b, c)));
}

ContactLaw stretched_wire_law(double stiffness, double half_length, double half_span, Damping damping) {
  return contact_law(stretched_wire_law(middle(half_length, half_span))->with(Vector2d(stiffness * half_length, 0.0)),
                     std::move(damping));
}

ContactLaw stretched_wire_tangent(double stiffness, double half_length, double half_span, Damping damping) {
  return contact_law(
      stretched_wire_linearised(middle(half_length, half_span))->with(Vector2d(stiffness * half_length, 0.0)),
      std::move(damping));
}

}  // namespace snare::coupling
