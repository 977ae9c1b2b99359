#pragma once

#include "numerics/sparse_matrix.hpp"

#include <Eigen/Core>

#include <vector>

namespace snare::numerics {

/// A = L U on a fixed pattern in a fixed order, without a search for pivots.                 theory.md (N.7)
///
/// Rows and columns are in the order of least degree (Amestoy, Davis and Duff 1996) of the pattern of A + A^T; what fills up is
/// known beforehand, so that a row is eliminated by others in runs of neighbours. A chain of vertices with a few unknowns each
/// takes a third of the time of KLU. Accurate where no pivot is small beside what stands in its row and column: the caller
/// has to look at a solution. Of any unit.
class StaticLu {
 public:
  /// The pattern, and with its values where the diagonal is empty: such unknowns come after their neighbours.
  explicit StaticLu(const SparseMatrix& matrix);

  /// False when a pivot is zero or not finite.
  [[nodiscard]] bool factorize(const SparseMatrix& matrix);
  /// Solves A x = b in place.
  void solve(Eigen::Ref<Eigen::VectorXd> b);

 private:
  /// Of a row that is eliminated by an earlier one: entries of either that follow each other.
  struct Run {
    int from = 0, to = 0, length = 0;  // in values_
  };
  struct Elimination {
    int entry = 0;      // of the multiplier, in values_
    int row = 0;        // by which
    int first_run = 0;  // up to that of the next elimination
  };
  /// The rows one after another; false as `factorize`.
  [[nodiscard]] bool eliminate(bool by_four);
  [[nodiscard]] bool eliminate_by_four();
  [[nodiscard]] bool eliminate_by_two();

  int order_ = 0;
  std::vector<int> unknown_;               // at every place of the order
  std::vector<int> start_, diagonal_;      // of every row in values_
  std::vector<int> column_;                // of every entry
  std::vector<double> values_;             // row by row
  std::vector<int> target_;                // in values_, of every slot of the matrix
  std::vector<Elimination> eliminations_;  // row by row
  std::vector<int> first_elimination_;     // of every row
  std::vector<Run> runs_;
  std::vector<double> inverse_;  // of the pivots
  Eigen::VectorXd work_;
};

}  // namespace snare::numerics
