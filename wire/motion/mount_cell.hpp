#pragma once

#include "numerics/dae.hpp"
#include "wire/end.hpp"
#include "wire/motion/rod_model.hpp"

#include <Eigen/Core>

namespace snare::wire {

/// The half cell of bending and twisting between a mount that moves and the edge beside it: what the rod does
/// to the mount, and how a turn and a spin of the mount act on the rod.                      theory.md (M.17)
///
///   M = e x g + gamma t,   e = x_{i+1} - x_i of the edge, t = e/|e|, g = dE/de [N], gamma = dE/dtheta [N m]
///
/// with Kelvin-Voigt parts in g and gamma. All in the world; turn and spin (angular velocity) are the
/// mount's.
struct MountCell {
  /// Local unknowns, and rows of their balances: the vertex at the mount, the next one, the angle of the
  /// edge, and the curvatures of the vertex at the mount; these are zero but with a rod of higher order.
  static constexpr int mount = 0, next = 3, angle = 6, curvature = 7, count = 9;
  using ByUnknowns = Eigen::Matrix<double, 3, count>;
  using Rows = Eigen::Matrix<double, count, 3>;

  Eigen::Vector3d moment;     ///< M of the rod on the mount [N m]
  ByUnknowns moment_by;       ///< by the local unknowns' places
  ByUnknowns moment_by_rate;  ///< by their rates
  Eigen::Matrix3d moment_by_turn, moment_by_spin;
  Rows rows_by_turn, rows_by_spin;  ///< of the rod's rows
};

/// At an end whose mount moves (instant.spin).
[[nodiscard]] MountCell mount_cell(const RodModel& model, const RodInstant& instant,
                                   const numerics::DaePoint& at, End end);
/// Its moment alone [N m].
[[nodiscard]] Eigen::Vector3d mount_moment(const RodModel& model, const RodInstant& instant,
                                           const numerics::DaePoint& at, End end);

}  // namespace snare::wire
