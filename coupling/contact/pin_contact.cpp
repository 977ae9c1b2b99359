#include "coupling/contact/pin_contact.hpp"

#include <cmath>

namespace snare::coupling {

double angle_between(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
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
