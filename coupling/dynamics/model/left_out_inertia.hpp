#pragma once

#include "coupling/dynamics/model/window_record.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace snare::coupling {

/// Largest of what a quasi-static wire leaves out: what its mass would have more at the velocities that it
/// has.
struct LeftOutInertia {
  double kinetic = 0.0;  ///< energy [J]
  double force = 0.0;    ///< |d/dt sum m v|, as a mean over the window of the peak force [N]
};

/// Follows the momentum p = sum m v that a quasi-static wire would have, and bounds by its mean rate of
/// change the force that is missing at contacts and mounts.                                  theory.md (M.18)
class LeftOutMomentum {
 public:
  /// window [s], >= 0: shorter steps are taken together.
  explicit LeftOutMomentum(double window = 0.0) : record_(window) {}

  /// After a step to `time` [s]: kinetic energy [J] and momentum [kg m/s] there. Raises what is larger in
  /// `largest`.
  void add(double time, double kinetic, const Eigen::Vector3d& momentum, LeftOutInertia& largest);
  void save_state(std::vector<double>& memory) const { record_.save_state(memory); }
  void restore_state(std::span<const double>& memory) { record_.restore_state(memory); }

 private:
  WindowRecord record_;  // of the momentum
};

}  // namespace snare::coupling
