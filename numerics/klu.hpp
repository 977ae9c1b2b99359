#pragma once

#include "numerics/sparse_matrix.hpp"

#include <Eigen/Core>

#include <memory>

namespace snare::numerics {

/// Sparse LU factorisation by KLU: the pattern is analysed once, values are refactorised with the pivots of the
/// first factorisation while that stays accurate, and factorised anew otherwise (Davis and Natarajan 2010).
class Klu {
 public:
  /// Analyses the pattern. Throws LibraryError when KLU refuses it.
  explicit Klu(const SparseMatrix& pattern);
  ~Klu();
  Klu(Klu&&) noexcept;
  Klu& operator=(Klu&&) noexcept;

  /// Factorises values of the analysed pattern; false when the matrix is singular.
  [[nodiscard]] bool factorize(const SparseMatrix& matrix);
  /// Solves A x = b in place.
  void solve(Eigen::Ref<Eigen::VectorXd> b) const;
  /// Reciprocal condition estimate of the pivots, min |u| / max |u| [-].
  [[nodiscard]] double reciprocal_condition() const;

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

}  // namespace snare::numerics
