#pragma once

#include "numerics/bordered.hpp"

#include <vector>

namespace snare::numerics {

/// Square sparse matrix in compressed columns: its pattern is fixed once, its values are refilled.
struct SparseMatrix {
  int order = 0;
  std::vector<int> column_start;  ///< order + 1 offsets
  std::vector<int> row;           ///< increasing within a column
  std::vector<double> value;

  /// Slot of entry (i, j) in `value`, or -1 outside the pattern.
  [[nodiscard]] int slot(int i, int j) const;
  /// A x.
  [[nodiscard]] Eigen::VectorXd operator*(const Eigen::VectorXd& x) const;
};

/// Pattern from coordinates (i, j), repeated ones merged; values zero.
[[nodiscard]] SparseMatrix make_pattern(int order, std::vector<std::pair<int, int>> entries);

/// The whole matrix [K C; D E] of a bordered system, order n + m, for solvers that know no border.
[[nodiscard]] SparseMatrix to_sparse(const BorderedSystem& system);

/// Lower triangle, or all, of a band matrix.
enum class Triangle { lower, both };
[[nodiscard]] SparseMatrix to_sparse(const SymmetricBandMatrix& matrix, Triangle triangle);

}  // namespace snare::numerics
