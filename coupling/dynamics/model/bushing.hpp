#pragma once

#include "coupling/dynamics/model/arm.hpp"
#include "multibody/spatial.hpp"

#include <Eigen/Core>

#include <optional>
#include <string>

namespace snare::coupling {

/// A spring of six freedoms with damping between two carriers: an attachment that gives.     theory.md (M.22)
///
/// A frame on either carrier: where both are in one place nothing acts. Stiffnesses and dampings act along
/// and about the axes of the first carrier's.
struct MotionBushing {
  std::string name = "bushing";
  MotionCarrier first, second;
  multibody::Pose X_WF;                                               ///< the first carrier's at the start
  std::optional<multibody::Pose> X_WG;                                ///< the second one's; none: there too
  Eigen::Vector3d translational_stiffness = Eigen::Vector3d::Zero();  ///< [N/m], >= 0
  Eigen::Vector3d translational_damping = Eigen::Vector3d::Zero();    ///< [N s/m], >= 0
  Eigen::Vector3d rotational_stiffness = Eigen::Vector3d::Zero();     ///< [N m/rad], >= 0
  Eigen::Vector3d rotational_damping = Eigen::Vector3d::Zero();       ///< [N m s/rad], >= 0
};

}  // namespace snare::coupling
