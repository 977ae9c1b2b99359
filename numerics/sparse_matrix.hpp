#pragma once

#include "numerics/band_matrix.hpp"

#include <Eigen/Core>

#include <utility>
#include <vector>

namespace snare::numerics {

/// Square sparse matrix in compressed columns: its pattern is fixed once, its values are refilled.
struct SparseMatrix {
  int order = 0;
  std::vector<int> column_start;  ///< order + 1 offsets
  std::vector<int> row;           ///< increasing within a column
  std::vector<double> value;      ///< of every entry, in the order of `row`, in its unit

  /// Slot of entry (i, j) in `value`, or -1 outside the pattern.
  [[nodiscard]] int slot(int i, int j) const;
};

/// Pattern from coordinates (i, j), repeated ones merged; values zero.
[[nodiscard]] SparseMatrix make_pattern(int order, const std::vector<std::pair<int, int>>& entries);

/// The same matrix with its zeros; in its unit.
[[nodiscard]] Eigen::MatrixXd dense(const SparseMatrix& matrix);

/// A x for a vector of the matrix's order; in the unit of both.
[[nodiscard]] Eigen::VectorXd product(const SparseMatrix& matrix, const Eigen::VectorXd& x);
[[nodiscard]] Eigen::VectorXcd product(const SparseMatrix& matrix, const Eigen::VectorXcd& x);
/// Multiplies every entry by the factors of its row and of its column, each of the matrix's order, of any
/// unit.
void scale(SparseMatrix& matrix, const Eigen::VectorXd& rows, const Eigen::VectorXd& columns);
/// Largest magnitude in every row, 0 where it has no entry; in the unit of the matrix.
[[nodiscard]] Eigen::VectorXd largest_of_rows(const SparseMatrix& matrix);

/// One value to be added at (row, column).
struct Triplet {
  int row = 0;
  int column = 0;
  double value = 0.0;  ///< in the unit of the matrix
};
/// The matrix of all of them, values at the same place added.
[[nodiscard]] SparseMatrix from_triplets(int order, const std::vector<Triplet>& triplets);

/// Lower triangle, or all, of a band matrix, with the zeros within its band.
enum class Triangle { lower, both };
[[nodiscard]] std::vector<Triplet> triplets_of(const SymmetricBandMatrix& matrix, Triangle triangle);

}  // namespace snare::numerics
