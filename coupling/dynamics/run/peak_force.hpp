#pragma once

#include "coupling/dynamics/model/window_record.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace snare::coupling {

/// The largest force of every contact as an instrument shows it: its mean over a window of time.
///                                                                                           theory.md (M.10)
///
/// When a wire is struck, the mass of an element takes on the body's speed within microseconds, at a force
/// that depends on the element; its impulse, the element's mass times the speed, vanishes under refinement,
/// and so does its share in a mean.
class PeakForce {
 public:
  /// window [s], >= 0; 0: of the force at the steps.
  explicit PeakForce(double window = 0.0) : record_(window) {}

  /// After a step from `before` to `time` [s]: the forces there [N], and their integrals [N s] since any
  /// time. Raises what is larger in `peaks` [N]. A step longer than the window counts with the force at its
  /// end.
  void add(double before, double time, const Eigen::VectorXd& forces, const Eigen::VectorXd& impulses,
           std::vector<double>& peaks);
  void save_state(std::vector<double>& memory) const { record_.save_state(memory); }
  void restore_state(std::span<const double>& memory) { record_.restore_state(memory); }

 private:
  WindowRecord record_;  // of the impulses
};

}  // namespace snare::coupling
