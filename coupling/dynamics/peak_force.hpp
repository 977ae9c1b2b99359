#pragma once

#include <Eigen/Core>

#include <deque>
#include <span>
#include <vector>

namespace snare::coupling {

/// The largest force of every contact as an instrument shows it: its mean over a window of time.       theory.md (M.10)
///
/// When a wire is struck, the mass of an element takes on the body's speed within microseconds, at a force that depends on
/// the element; its impulse, the element's mass times the speed, vanishes under refinement, and so does its share in a mean.
class PeakForce {
 public:
  /// window [s], >= 0; 0: of the force at the steps.
  explicit PeakForce(double window = 0.0) : window_(window) {}

  /// After a step from `before` to `time` [s]: the forces there [N], and their integrals [N s] since any time. Raises what is
  /// larger in `peaks` [N]. A step longer than the window counts with the force at its end.
  void add(double before, double time, const Eigen::VectorXd& forces, const Eigen::VectorXd& impulses,
           std::vector<double>& peaks);
  void save_state(std::vector<double>& memory) const;
  void restore_state(std::span<const double>& memory);

 private:
  struct Record {
    double time = 0.0;
    Eigen::VectorXd impulses;
  };
  double window_ = 0.0;
  std::deque<Record> records_;  // the first at or before the beginning of the window
};

}  // namespace snare::coupling
