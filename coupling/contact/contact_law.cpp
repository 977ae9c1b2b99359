#include "coupling/contact/contact_law.hpp"

#include <algorithm>
#include <cmath>

namespace snare::coupling {

using Eigen::Vector3d;

namespace {

/// Nothing pulls.
Vector3d pushing(const Vector3d& force) {
  return force.x() > 0.0 ? force : Vector3d::Zero();
}

}  // namespace

ContactLaw spring_dashpot(double k, double c) {
  return [k, c](double d, double rate) {
    if (d <= 0.0) return Vector3d(0.0, 0.0, 0.0);
    return pushing({k * d + c * rate, k, c});
  };
}

ContactLaw power_law(double k, double p, double c, double q) {
  return power_law(k, p, c, q, p);
}

ContactLaw power_law(double k, double p, double c, double q, double n) {
  return [k, p, c, q, n](double d, double rate) {
    if (d <= 0.0) return Vector3d(0.0, 0.0, 0.0);
    const double spring = k * std::pow(d, p);
    const double depth = c * std::pow(d, n);
    const double damping = depth * std::copysign(std::pow(std::abs(rate), q), rate);
    return pushing({spring + damping, (p * spring + n * damping) / d, depth * q * std::pow(std::abs(rate), q - 1.0)});
  };
}

ContactLaw step_damped_law(double k, double p, double c, double depth) {
  return [k, p, c, depth](double d, double rate) {
    if (d <= 0.0) return Vector3d(0.0, 0.0, 0.0);
    const double x = std::min(d / depth, 1.0);
    const double step = x * x * (3.0 - 2.0 * x);
    const double slope = 6.0 * x * (1.0 - x) / depth;
    const double spring = k * std::pow(d, p);
    return pushing({spring + c * step * rate, p * spring / d + c * slope * rate, c * step});
  };
}

ContactLaw quadratic_law(double a, double b, double c) {
  return [a, b, c](double d, double) {
    if (d <= 0.0) return Vector3d(0.0, 0.0, 0.0);
    return pushing({(a * d + b) * d + c, 2.0 * a * d + b, 0.0});
  };
}

ContactLaw stretched_wire_law(double stiffness, double half_length, double half_span) {
  const double h = std::sqrt(half_length * half_length - half_span * half_span);
  return [k = stiffness, l = half_length, h](double d, double) {
    if (d <= 0.0) return Vector3d(0.0, 0.0, 0.0);
    const double squared = l * l + (2.0 * h + d) * d;
    const double now = std::sqrt(squared);
    // 1 - l/now without cancellation.
    const double share = (2.0 * h + d) * d / (now * (now + l));
    return Vector3d(2.0 * k * share * (h + d), 2.0 * k * (share + l * (h + d) * (h + d) / (squared * now)),
                    0.0);
  };
}

ContactLaw stretched_wire_tangent(double stiffness, double half_length, double half_span) {
  const double l = half_length;
  return spring_dashpot(2.0 * stiffness * (l * l - half_span * half_span) / (l * l), 0.0);
}

}  // namespace snare::coupling
