#pragma once

#include "numerics/sparse_matrix.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <utility>
#include <vector>

namespace snare::numerics {

/// A linear system without the unknowns that a row of their own gives at once: rates v of places x, by the
/// rows x' - v, and beside such pairs those that no other row has, with nothing else in their own.
///                                                                                            theory.md (N.6)
///   row p:  a x + b v = r   =>   v = (r - a x)/b
///
/// What other rows have by v goes to the column of x; the balance that has the number of v stands in the row
/// of x. The unknowns left keep their order. Unknowns and rows of any unit.
class Condensation {
 public:
  /// pairs: (p, v) of x and v, taken where the row p has entries by p and v alone, and left as they are
  /// elsewhere.
  Condensation(const SparseMatrix& pattern, const std::vector<std::pair<int, int>>& pairs);

  /// The pairs that were taken.
  [[nodiscard]] const std::vector<std::pair<int, int>>& pairs() const noexcept { return pairs_; }
  /// The matrix of what is left: as of the last `update`.
  [[nodiscard]] const SparseMatrix& matrix() const noexcept { return matrix_; }
  /// Takes values on the pattern; false when an unknown is not given by its row (b = 0).
  [[nodiscard]] bool update(const SparseMatrix& full);

  /// Right-hand side of what is left, from that of all; `full` is that of the last `update`.
  void reduce(const SparseMatrix& full, Eigen::Ref<const Eigen::VectorXd> b, Eigen::VectorXd& reduced);
  /// All unknowns from what is left and from the right-hand side that was told last.
  void expand(const Eigen::VectorXd& reduced, Eigen::Ref<Eigen::VectorXd> x) const;

 private:
  /// Entries of the column of a rate that follow each other: slots of the full matrix, and rows of what is
  /// left.
  struct Run {
    int slot = 0, row = 0, length = 0;
  };

  SparseMatrix matrix_;
  std::vector<std::pair<int, int>> pairs_;
  std::vector<int> row_, column_;              // of the full system, of what is left
  std::vector<int> target_;                    // of every slot of the full pattern; -1: none
  std::vector<int> pair_of_;                   // of every full column: the pair whose v it is; -1: none
  std::vector<int> own_slot_, rate_slot_;      // of a and b
  std::vector<Run> rates_;                     // pair by pair
  std::vector<std::size_t> first_rate_;        // of every pair
  std::vector<double> ratio_, pivot_, given_;  // -a/b, b, and r/b of every pair
  std::vector<int> alone_, alone_slot_;        // unknowns with nothing but their diagonal, and that
  std::vector<double> of_alone_;               // they themselves
};

}  // namespace snare::numerics
