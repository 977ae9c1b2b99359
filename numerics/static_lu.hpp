#pragma once

#include "numerics/sparse_matrix.hpp"

#include <Eigen/Core>

#include <vector>

namespace snare::numerics {

/// A = L U on a fixed pattern in a fixed order, without a search for pivots.                 theory.md (N.7)
///
/// Rows and columns are in the order of least degree (Amestoy, Davis and Duff 1996) of the pattern of A +
/// A^T; what fills up is known beforehand, so that a row is eliminated by several at once in runs of
/// neighbours. A chain of vertices with a few unknowns each takes less than a third of the time of KLU.
/// Accurate where no pivot is small beside what stands in its row and column: the caller has to look at a
/// solution. Of any unit.
class StaticLu {
 public:
  /// The pattern, and with its values where the diagonal is empty: such unknowns come after their neighbours.
  explicit StaticLu(const SparseMatrix& matrix);

  /// False when a pivot is zero or not finite.
  [[nodiscard]] bool factorize(const SparseMatrix& matrix);
  /// Solves A x = b in place.
  void solve(Eigen::Ref<Eigen::VectorXd> b);

 private:
  /// Of a row that is eliminated by earlier ones: entries of all of them that follow each other.
  struct Run {
    int offset = 0, to = 0, length = 0;  // behind the first entry of an earlier row that all have; in values_
  };
  struct Elimination {
    int entry = 0;          // of the first multiplier, in values_
    int row = 0, rows = 0;  // by which: a block, or what of it is before the row
    int common = 0;         // how many last entries of these rows have the same columns
    int first_run = 0;      // up to that of the next elimination
  };
  /// Rows that follow each other and have the same columns before or behind their square on the diagonal.
  /// Each column's entries are together, four whatever the rows; so are those of the inverse of the square.
  struct Block {
    int row = 0, rows = 0;
    int first = 0, last = 0;  // columns, of those listed
    int square = 0;           // its number
  };
  static constexpr int most_rows = 4;  // of a block

  void list_blocks();
  template <int rows>
  void eliminate_by(const Elimination& e, int last_run);
  /// The rows one after another; false as `factorize`.
  [[nodiscard]] bool eliminate();
  [[nodiscard]] bool eliminate_in_fours();
  [[nodiscard]] bool eliminate_in_pairs();
  /// The entries of the blocks, from those of the rows; and the inverses of their squares.
  void gather();
  void invert_square(const Block& block, bool upper);
  /// x = S^-1 (x - sum of the columns times what they stand for), S the square of the block.
  void solve_block(const Block& block);
  /// Solves in the order of the rows, in work_.
  void substitute();
  void substitute_in_fours();
  void substitute_in_pairs();

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
  std::vector<int> alone_;       // rows with nothing but a diagonal
  std::vector<Block> before_;    // of the others, by what is before the diagonal
  std::vector<Block> behind_;    // by what is behind it, from the last row on
  std::vector<int> listed_;      // columns of the blocks
  std::vector<int> entry_;       // of each of their rows, in values_; four a column
  std::vector<double> columns_;  // of the blocks, four numbers a column
  std::vector<double> squares_;  // of the blocks, inverted, four columns each
  std::vector<double> work_;     // with room behind for a last block's four
};

}  // namespace snare::numerics
