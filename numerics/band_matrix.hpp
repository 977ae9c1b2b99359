#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <vector>

namespace snare::numerics {

/// Symmetric band matrix, lower triangle stored column by column.
///
/// The discrete rod couples a vertex with its two neighbours on either side only, so that its Hessian is
/// banded by construction and needs no ordering. n: order, > 0; b: half bandwidth, >= 0: entries with
/// |row - column| > b are zero. Entries are of any unit.
class SymmetricBandMatrix {
 public:
  SymmetricBandMatrix() = default;
  SymmetricBandMatrix(int n, int b)
      : n_(n), b_(b), values_(static_cast<std::size_t>(n) * static_cast<std::size_t>(b + 1), 0.0) {}

  /// n: rows, and columns.
  [[nodiscard]] int order() const noexcept { return n_; }
  /// b: below the diagonal, 0 for a diagonal matrix.
  [[nodiscard]] int half_bandwidth() const noexcept { return b_; }

  /// Makes all entries zero; the size stays.
  void set_zero() { std::fill(values_.begin(), values_.end(), 0.0); }

  /// Entry of the lower triangle, column <= row <= column + b.
  double& lower(int row, int column) {
    assert(column >= 0 && row >= column && row - column <= b_ && row < n_);
    return values_[offset(column) + static_cast<std::size_t>(row - column)];
  }
  [[nodiscard]] double lower(int row, int column) const {
    assert(column >= 0 && row >= column && row - column <= b_ && row < n_);
    return values_[offset(column) + static_cast<std::size_t>(row - column)];
  }
  /// Adds to the symmetric pair (i, j), (j, i); to the diagonal once when i == j.
  void add(int i, int j, double value) { (i >= j ? lower(i, j) : lower(j, i)) += value; }

  /// Entries (j, j) ... (j + b, j) one behind the other; those beyond the last row are storage that nobody
  /// reads.
  [[nodiscard]] double* column(int j) { return values_.data() + offset(j); }
  [[nodiscard]] const double* column(int j) const { return values_.data() + offset(j); }

  /// Makes row and column i those of the identity: unknown i is held.
  void hold(int i);

  /// A x for a vector x of n entries.
  [[nodiscard]] Eigen::VectorXd operator*(const Eigen::VectorXd& x) const;

 private:
  [[nodiscard]] std::size_t offset(int j) const noexcept {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(b_ + 1);
  }

  int n_ = 0;
  int b_ = 0;
  std::vector<double> values_;
};

/// A = L D L^T of a symmetric band matrix without pivoting; n b^2 operations.               theory.md (N.2)
///
/// By Sylvester's law the signs of D are the signs of the eigenvalues of A, which decides stability. Without
/// pivoting the factorisation is accurate while no leading minor is nearly singular; `pivot_share()` tells.
class BandLdlt {
 public:
  /// Factorises a. Returns false, and leaves the factor unusable, when a pivot is zero or not finite.
  [[nodiscard]] bool factorize(const SymmetricBandMatrix& a);

  /// How many entries of D are negative, by the last `factorize`: as many eigenvalues of A are.
  [[nodiscard]] int negative_pivots() const noexcept { return negative_; }
  /// Smallest over largest |pivot| [-]. Depends on the units of the unknowns and on the mesh.
  [[nodiscard]] double pivot_ratio() const noexcept { return ratio_; }
  /// Smallest share of its diagonal entry that a pivot keeps, |d_j| / max(|a_jj|, |a_jj - d_j|) [-]: what
  /// elimination cancels. Does not depend on units. Below about 1e-14 the sign of that pivot is not known;
  /// near 1e-16 it is round-off, which spoils the solution unless A is definite (a cantilever of n edges
  /// keeps about 1/n^3).
  [[nodiscard]] double pivot_share() const noexcept { return share_; }

  /// Solves A X = B in place; b has n rows, every column one right-hand side of any unit.
  void solve(Eigen::Ref<Eigen::MatrixXd> b) const;

 private:
  SymmetricBandMatrix l_;        // unit lower factor below the diagonal, D on it
  std::vector<double> inverse_;  // 1 / D
  int negative_ = 0;
  double ratio_ = 0.0;
  double share_ = 0.0;
};

}  // namespace snare::numerics
