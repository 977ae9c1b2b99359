#pragma once

#include "multibody/tree.hpp"

#include <Eigen/Core>

#include <vector>

namespace snare::multibody {

/// A joint that may turn so that a frame comes to a place.
struct ReachingJoint {
  int body = 0;        ///< of the tree, on a revolute or prismatic joint
  double lower = 0.0;  ///< limits of its coordinate [rad, m]; may be infinite
  double upper = 0.0;
};

/// Where joints must be for a frame to be somewhere.
struct Reach {
  Eigen::VectorXd q;      ///< coordinates of the tree; where nothing was found, of the nearest try
  int solutions = 0;      ///< different ones found within the limits
  double distance = 0.0;  ///< left at q: of the origins [m]
  double angle = 0.0;     ///< left at q: between the axes [rad]
  /// where all solutions lie beyond limits: of the nearest one, index of the joint that is farthest
  /// beyond
  int beyond = -1;
  double beyond_at = 0.0;  ///< and its coordinate [rad, m]
  [[nodiscard]] bool found() const { return solutions > 0; }
};

/// The coordinates at which a frame of a tree has the pose X_WF, six joints moving and all other coordinates
/// as in `posture`: of the solutions within the limits the one nearest to the posture, by the sum of squares
/// of the changes of coordinates [rad, m]. Angles are taken by whole turns to where they are nearest within
/// the limits.                                                                               theory.md (A.18)
///
/// Looks from the posture and from 400 places spread evenly over the joints' ranges (of +-180 deg or 10 m
/// where they have no limits), the same every time.
[[nodiscard]] Reach reach_pose(const Tree& tree, int frame, const Pose& X_WF, const Eigen::VectorXd& posture,
                               const std::vector<ReachingJoint>& joints);

}  // namespace snare::multibody
