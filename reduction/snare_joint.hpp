#pragma once

#include "coupling/statics/snared_shaft.hpp"

#include <array>
#include <vector>

namespace snare::reduction {

/// One direction of the snared shaft: a linear spring beside a spring that slides.           theory.md (R.10)
///   F = k u + p,   dp = q du, |p| <= f
/// Dissipates 4 f (a - f/q) in a cycle of amplitude a > f/q.
struct JointAxis {
  double stiffness = 0.0;        ///< k [N/m]
  double friction = 0.0;         ///< f [N], >= 0
  double stick_stiffness = 0.0;  ///< q [N/m], > 0
};

/// Memory of the three sliding springs, and where the shaft was.
struct JointState {
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d sliding = Eigen::Vector3d::Zero();       ///< p [N]
};

/// The ball joint that stands for a closed snare: springs across the shaft, friction along it (Nakanishi et
/// al., ground test).
struct SnareJoint {
  std::array<JointAxis, 3> axis;

  /// Moves the shaft and gives the force with which it must be pushed there [N].
  [[nodiscard]] Eigen::Vector3d move(JointState& state, const Eigen::Vector3d& displacement) const;
};

/// A cycle of the full snare along one axis and the joint fitted to it.
struct JointCycle {
  int axis = 0;
  std::vector<coupling::ShaftPoint> path;  ///< first loading from the centre, then one whole cycle
  std::size_t cycle_begin = 0;             ///< index from which the closed cycle runs
  double loop = 0.0;                       ///< area of the closed cycle, the integral of F du [J]
  double dissipated = 0.0;                 ///< by friction in it, from the contacts [J]
  double linear_r2 = 0.0;                  ///< of a straight line through the cycle's forces
  double half_width = 0.0;                 ///< largest half distance of the branches [N]
  double force_range = 0.0;                ///< largest less least force [N]
  JointAxis fitted;
  double rms_error = 0.0;      ///< of the joint over the cycle [N]
  double largest_error = 0.0;  ///< [N]
  numerics::SolveReport report;
};

/// Moves the shaft along an axis (0, 1, 2) by 0, a, -a, a in `steps` points a leg of length 2 a, and fits the
/// joint. amplitude: a [m], > 0.
[[nodiscard]] JointCycle cycle_snare(const coupling::SnareSpecification& snare, int axis, double amplitude,
                                     int steps);

}  // namespace snare::reduction
