#pragma once

#include "wire/spatial_rod.hpp"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace snare::wire {

/// What damping and strands do at a point.
struct RodLosses {
  double power = 0.0;          ///< that they take [W]
  double strand_energy = 0.0;  ///< stored [J]
  std::array<Eigen::Vector3d, 2> couples{Eigen::Vector3d::Zero(),
                                         Eigen::Vector3d::Zero()};  ///< of the mounts [N m]
  std::vector<Eigen::Vector2d> strand_rates;                        ///< z' of every vertex [1/(m s)]
};

/// Where what a rod does at a point goes: its energy and its forces by bands, dE/dk [N m^2] of higher order,
/// and the losses. All stay the caller's.
struct RodSums {
  RodAssembly& assembly;
  Eigen::Matrix2Xd& by_curvature;
  RodLosses& losses;
};

}  // namespace snare::wire
