#include "coupling/motion_shape.hpp"

namespace snare::coupling {

using Eigen::Matrix3d;
using Eigen::Vector3d;

DistanceField Ball::at(const Vector3d& p) const {
  const double r = p.norm();
  const Vector3d n = p / r;
  return {r - radius_, n, (Matrix3d::Identity() - n * n.transpose()) / r};
}

DistanceField EndlessCylinder::at(const Vector3d& p) const {
  const Vector3d across(p.x(), p.y(), 0.0);
  const double r = across.norm();
  const Vector3d n = across / r;
  Matrix3d plane = Matrix3d::Identity();
  plane(2, 2) = 0.0;
  return {r - radius_, n, (plane - n * n.transpose()) / r};
}

}  // namespace snare::coupling
