#pragma once

#include "numerics/sparse_matrix.hpp"

#include <Eigen/Core>

#include <memory>

namespace snare::numerics {

/// Sparse LU factorisation by KLU: the pattern is analysed once, values are refactorised with the pivots of
/// the first factorisation while that stays accurate, and factorised again otherwise (Davis and Natarajan
/// 2010). Of any unit.
class Klu {
 public:
  /// Analyses the pattern. A pattern that makes every matrix singular is no error: `factorize` then is false.
  /// Throws LibraryError when the pattern is invalid or memory runs out.
  explicit Klu(const SparseMatrix& pattern);

  /// Factorises values of the analysed pattern; false when the matrix is singular. Throws LibraryError when
  /// memory runs out.
  [[nodiscard]] bool factorize(const SparseMatrix& matrix);
  /// Solves A x = b in place.
  void solve(Eigen::Ref<Eigen::VectorXd> b) const;
  /// Reciprocal condition estimate of the pivots, min |u| / max |u| [-].
  [[nodiscard]] double reciprocal_condition() const;
  /// Sign of the determinant of the matrix that was factorised: +1 or -1.
  [[nodiscard]] int determinant_sign() const;

 private:
  struct Handles;
  struct HandlesDeleter {
    void operator()(Handles* handles) const noexcept;
  };
  std::unique_ptr<Handles, HandlesDeleter> handles_;
};

}  // namespace snare::numerics
