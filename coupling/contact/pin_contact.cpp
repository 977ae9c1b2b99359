#include "coupling/contact/pin_contact.hpp"

#include <algorithm>
#include <cmath>

namespace snare::coupling {

double angle_between(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
}

Eigen::Vector2d left_of(const Eigen::Vector2d& v) {
  return {-v.y(), v.x()};
}

double SlipWork::over(double next, double from, double to) const {
  // of the step before, over this one: from a shorter one no parabola is known
  constexpr double shortest = 0.1;
  const double length = std::abs(next), before = std::abs(slip);
  const double straight = 0.5 * (from + to) * length;
  if (slip * next <= 0.0 || before < shortest * length) return straight;
  const double curvature = 2.0 * ((to - from) / length - (from - begin) / before) / (length + before);
  const double bow = length * length * length * curvature / 12.0;
  return straight - std::clamp(bow, -0.5 * straight, 0.5 * straight);
}

VertexTangent vertex_tangent(const VertexSlope<2>& slope) {
  VertexTangent result;
  result.slope = slope;
  result.size = slope.u.norm();
  result.t = slope.u / result.size;
  result.normal = {-result.t.y(), result.t.x()};
  return result;
}

}  // namespace snare::coupling
