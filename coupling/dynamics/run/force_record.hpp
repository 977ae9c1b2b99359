#pragma once

#include <Eigen/Core>

#include <deque>

namespace snare::coupling {

/// Forces at the last states that the integrator has accepted, four at most, for the times between: a
/// polynomial through them. Forces of interpolated unknowns would err by the stiffness of a contact times the
/// error of its depth, which is not small beside the depth.
class ForceRecord {
 public:
  /// At a state later than the last one [s], [N].
  void add(double time, Eigen::VectorXd forces);
  /// Entry `index` [N] at a time [s] within the last step, through the last states, as many as there are up
  /// to `states`, at least two.
  [[nodiscard]] double at(double time, Eigen::Index index, int states) const;

 private:
  struct Record {
    double time = 0.0;  // [s]
    Eigen::VectorXd forces;
  };
  std::deque<Record> records_;  // the latest last
};

}  // namespace snare::coupling
