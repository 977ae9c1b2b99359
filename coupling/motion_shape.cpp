#include "coupling/motion_shape.hpp"

#include <algorithm>

namespace snare::coupling {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// |a| with its derivatives; on a = 0, where there are none, the direction x stands for the gradient.
DistanceField distance_along(const Vector3d& a, const Matrix3d& space, double radius) {
  const double r = a.norm();
  if (r == 0.0) return {-radius, Vector3d::UnitX(), Matrix3d::Zero()};
  const Vector3d n = a / r;
  return {r - radius, n, (space - n * n.transpose()) / r};
}

}  // namespace

DistanceField Ball::at(const Vector3d& p) const {
  return distance_along(p, Matrix3d::Identity(), radius_);
}

DistanceField EndlessCylinder::at(const Vector3d& p) const {
  return distance_along({p.x(), p.y(), 0.0}, Vector3d(1.0, 1.0, 0.0).asDiagonal(), radius_);
}

DistanceField Capsule::at(const Vector3d& p) const {
  const double along = std::clamp(p.z(), -half_length_, half_length_);
  const bool between = along == p.z();
  return distance_along(p - Vector3d(0.0, 0.0, along), Vector3d(1.0, 1.0, between ? 0.0 : 1.0).asDiagonal(), radius_);
}

}  // namespace snare::coupling
