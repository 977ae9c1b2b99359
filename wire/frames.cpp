#include "wire/frames.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace snare::wire {

using Eigen::Vector3d;

Vector3d any_normal(const Vector3d& tangent) {
  // The axis that is farthest from the tangent.
  Eigen::Index smallest = 0;
  tangent.cwiseAbs().minCoeff(&smallest);
  return tangent.cross(Vector3d::Unit(smallest)).normalized();
}

}  // namespace snare::wire
