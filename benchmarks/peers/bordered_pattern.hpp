#pragma once

#include "numerics/bordered_system.hpp"
#include "numerics/sparse_matrix.hpp"

#include <vector>

namespace snare::benchmarks {

using numerics::BorderedSystem;
using numerics::SparseMatrix;

/// The whole matrix [K C; D E] of a bordered system with a pattern that is found once: each entry knows its
/// slot, and a refill searches and sorts nothing.
///
/// `to_sparse` makes the same matrix anew each time.
class BorderedPattern {
 public:
  enum class Zeros {
    kept,    ///< the whole band, whole dense columns and E: fits every system of the same structure
    dropped  ///< only what is not zero in the system at hand: the smallest matrix, for one state
  };

  BorderedPattern(const BorderedSystem& system, Zeros zeros);

  /// A matrix of order n + m with the pattern, values zero.
  [[nodiscard]] const SparseMatrix& pattern() const noexcept { return pattern_; }

  /// Writes the values of `system` into `matrix`, which has the pattern. False, with `matrix` unusable, when
  /// the system has other sizes, rows, anchors or columns, or a value that is not zero outside the pattern:
  /// make a new pattern then.
  [[nodiscard]] bool refill(const BorderedSystem& system, SparseMatrix& matrix) const;

 private:
  struct Slot {
    int row;
    int column;
    int slot;  // -1: outside the pattern
  };
  [[nodiscard]] bool same_structure(const BorderedSystem& system) const;

  int n_ = 0;
  int m_ = 0;
  int b_ = 0;
  SparseMatrix pattern_;
  std::vector<int> lower_;     // of the band, stored column by column as in SymmetricBandMatrix
  std::vector<int> upper_;     // of the mirrored entries
  std::vector<Slot> rows_;     // D
  std::vector<Slot> anchors_;  // columns of C that are -e_i
  std::vector<Slot> columns_;  // dense columns of C: their entries one column after the other
  std::vector<int> borders_;   // border unknown of each dense column
  std::vector<int> corner_;    // E, row by row
};

/// Lower triangle, or all, of a band matrix, with the zeros within its band.
[[nodiscard]] SparseMatrix to_sparse(const numerics::SymmetricBandMatrix& matrix,
                                     numerics::Triangle triangle);

}  // namespace snare::benchmarks
