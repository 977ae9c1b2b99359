#pragma once

#include <Eigen/Core>

namespace snare::numerics {

/// Broyden's method on a matrix of elsewhere, by the corrections alone.                      theory.md (N.8)
///
/// What a correction should have brought and did not corrects the matrix by a rank of one each time, so that
/// the one or two directions in which it is wrong, as the stiffness of a touch, cost a few iterations in the
/// place of a new matrix. Corrections of any unit, weighted by one over their tolerances.
class QuasiNewton {
 public:
  /// size: unknowns; most: corrections that are kept, at least one.
  QuasiNewton(Eigen::Index size, int most);

  /// The next correction is by another matrix.
  void restart() { kept_ = 0; }
  /// Makes the correction by the matrix, -A^-1 F, that of the corrected matrix. Rows that are linear and that
  /// A has exactly are satisfied from the first correction on. step: of any unit; weight: one over the
  /// tolerance of every unknown, in its unit, positive.
  void update(Eigen::Ref<Eigen::VectorXd> step, const Eigen::Ref<const Eigen::VectorXd>& weight);

 private:
  Eigen::MatrixXd steps_;    // weighted, one a column
  Eigen::VectorXd squares_;  // of their lengths
  Eigen::VectorXd work_;
  Eigen::Index kept_ = 0;
};

}  // namespace snare::numerics
