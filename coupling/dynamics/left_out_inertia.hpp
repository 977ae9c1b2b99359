#pragma once

#include <Eigen/Core>

#include <deque>
#include <span>
#include <vector>

namespace snare::coupling {

/// Largest of what a quasi-static wire leaves out: what its mass would have more at the velocities that it has.
struct LeftOutInertia {
  double kinetic = 0.0;  ///< energy [J]
  double force = 0.0;    ///< |d/dt sum m v|, as a mean over the window of the peak force [N]
};

/// Follows the momentum p = sum m v that a quasi-static wire would have, and bounds by its mean rate of change the force that
/// is missing at contacts and mounts.                                                          theory.md (M.18)
class LeftOutMomentum {
 public:
  /// window [s], >= 0: shorter steps are taken together.
  explicit LeftOutMomentum(double window = 0.0) : window_(window) {}

  /// After a step to `time` [s]: kinetic energy [J] and momentum [kg m/s] there. Raises what is larger in `largest`.
  void add(double time, double kinetic, const Eigen::Vector3d& momentum, LeftOutInertia& largest);
  void save_state(std::vector<double>& memory) const;
  void restore_state(std::span<const double>& memory);

 private:
  struct Record {
    double time = 0.0;
    Eigen::Vector3d momentum = Eigen::Vector3d::Zero();
  };
  double window_ = 0.0;
  std::deque<Record> records_;  // the first at or before the beginning of the window
};

}  // namespace snare::coupling
