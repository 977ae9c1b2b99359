#include "coupling/contact/pin_contact.hpp"

#include <cmath>

namespace snare::coupling {

double angle_between(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
}

VertexTangent vertex_tangent(const Eigen::Vector2d& e0, const Eigen::Vector2d& e1, double h0, double h1) {
  VertexTangent result;
  result.by_before.setZero();
  result.by_after.setZero();
  if (h0 == 0.0) {
    result.after = 1.0 / h1;
    result.by_after = -e1 / (h1 * h1);
  } else if (h1 == 0.0) {
    result.before = 1.0 / h0;
    result.by_before = -e0 / (h0 * h0);
  } else {
    const double sum = h0 + h1;
    result.before = h1 / (h0 * sum);
    result.after = h0 / (h1 * sum);
    result.by_before = -e0 * h1 * (2.0 * h0 + h1) / (h0 * h0 * sum * sum) + e1 / (sum * sum);
    result.by_after = -e1 * h0 * (2.0 * h1 + h0) / (h1 * h1 * sum * sum) + e0 / (sum * sum);
  }
  const Eigen::Vector2d u = result.before * e0 + result.after * e1;
  result.size = u.norm();
  result.t = u / result.size;
  result.normal = {-result.t.y(), result.t.x()};
  return result;
}

}  // namespace snare::coupling
