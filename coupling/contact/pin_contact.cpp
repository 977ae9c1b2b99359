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

// F = F1 + f1 x + f2 x^2 and s = s1 x + s2 x^2 with x = 0 at the beginning of the step, h its length, h0 that
// of the step before:   W = integral_0^h F s' dx.
double SlipWork::over(double next, double at, double from, double to) const {
  constexpr double shortest =
      0.1;  // of the step before, over this one: from a shorter one no parabola is known
  const double h = at - end, h0 = length;
  const double straight = 0.5 * (from + to) * std::abs(next);
  if (slip * next <= 0.0 || h * h0 <= 0.0 || std::abs(h0) < shortest * std::abs(h)) return straight;
  const double f2 = ((to - from) / h - (from - begin) / h0) / (h + h0), f1 = (to - from) / h - f2 * h;
  const double s2 = (next / h - slip / h0) / (h + h0), s1 = next / h - s2 * h;
  const double work = h * (from * s1 + h * (0.5 * (f1 * s1 + 2.0 * from * s2) +
                                            h * ((f2 * s1 + 2.0 * f1 * s2) / 3.0 + h * 0.5 * f2 * s2)));
  return std::clamp(std::abs(work), 0.5 * straight, 1.5 * straight);
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
