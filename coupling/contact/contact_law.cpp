#include "coupling/contact/contact_law.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace snare::coupling {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// The place of (L.4): mid-span; a form of the stretched wire asks for no bending stiffness.
LawPlace middle(double half_length, double half_span) {
  return {2.0 * half_span, half_span, 2.0 * half_length, 0.0};
}

/// F = max(0, A d^2 + B d + C). Its energy is the integral over the parts of the way on which the parabola is positive.
class PressingParabola final : public SpringLaw {
 public:
  PressingParabola(double a, double b, double c)
      : parabola_(coupling::quadratic_law()->with(Vector3d(a, b, c))), zeros_(zeros_of(a, b, c)) {}

  double force(double d) const override { return std::max(0.0, parabola_->force(d)); }
  double stiffness(double d) const override { return parabola_->force(d) > 0.0 ? parabola_->stiffness(d) : 0.0; }
  double curvature(double d) const override { return parabola_->force(d) > 0.0 ? parabola_->curvature(d) : 0.0; }
  double energy(double d) const override {
    double sum = 0.0, from = 0.0;
    for (const double to : {std::clamp(zeros_[0], 0.0, d), std::clamp(zeros_[1], 0.0, d), d}) {
      if (parabola_->force(0.5 * (from + to)) > 0.0) sum += parabola_->energy(to) - parabola_->energy(from);
      from = to;
    }
    return sum;
  }

 private:
  /// In their order; without real zeros twice 0.
  static Eigen::Vector2d zeros_of(double a, double b, double c) {
    if (a == 0.0) return Eigen::Vector2d::Constant(b != 0.0 ? -c / b : 0.0);
    const double square = b * b - 4.0 * a * c;
    if (square <= 0.0) return Eigen::Vector2d::Zero();
    const double q = -0.5 * (b + std::copysign(std::sqrt(square), b));
    const double first = q / a, second = q != 0.0 ? c / q : 0.0;
    return {std::min(first, second), std::max(first, second)};
  }

  SpringLawPointer parabola_;
  Eigen::Vector2d zeros_;
};

}  // namespace

Vector3d ContactLaw::operator()(double d, double rate) const {
  if (d <= 0.0) return Vector3d::Zero();
  Vector3d force(spring_->force(d), spring_->stiffness(d), 0.0);
  if (damping_) force += damping_(d, rate);
  return force.x() > 0.0 ? force : Vector3d::Zero();
}

Vector3d ContactLaw::elastic(double d) const {
  return d > 0.0 ? Vector3d(spring_->force(d), spring_->stiffness(d), spring_->curvature(d)) : Vector3d::Zero();
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
  return ContactLaw(std::make_shared<PressingParabola>(a, b, c));
}

ContactLaw stretched_wire_law(double stiffness, double half_length, double half_span, Damping damping) {
  return ContactLaw(stretched_wire_law(middle(half_length, half_span))->with(Vector2d(stiffness * half_length, 0.0)),
                    std::move(damping));
}

ContactLaw stretched_wire_tangent(double stiffness, double half_length, double half_span, Damping damping) {
  return ContactLaw(
      stretched_wire_linearised(middle(half_length, half_span))->with(Vector2d(stiffness * half_length, 0.0)),
      std::move(damping));
}

}  // namespace snare::coupling
