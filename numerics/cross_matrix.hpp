#pragma once

#include <Eigen/Core>

namespace snare::numerics {

/// [v]_x, the matrix of the cross product: cross_matrix(v) w = v x w. In the unit of v.
[[nodiscard]] inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

}  // namespace snare::numerics
