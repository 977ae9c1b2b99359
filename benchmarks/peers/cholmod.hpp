#pragma once

#include "numerics/sparse_matrix.hpp"

#include <Eigen/Core>

#include <memory>

namespace snare::benchmarks {

/// Simplicial L D L^T factorisation of a symmetric sparse matrix by CHOLMOD; D tells the inertia.
///
/// Without pivoting: fails where a leading minor vanishes. Takes the lower triangle.
class Cholmod {
 public:
  enum class Ordering { natural, approximate_minimum_degree };

  /// Analyses the pattern of a lower triangle. Throws LibraryError when CHOLMOD refuses it.
  Cholmod(const numerics::SparseMatrix& lower, Ordering ordering);

  /// Factorises values of the analysed pattern; false when a pivot vanishes.
  [[nodiscard]] bool factorize(const numerics::SparseMatrix& lower);
  /// Solves A x = b in place.
  void solve(Eigen::Ref<Eigen::VectorXd> b) const;
  /// Number of negative eigenvalues (Sylvester).
  [[nodiscard]] int negative_pivots() const;

 private:
  struct Handles;
  struct HandlesDeleter {
    void operator()(Handles* handles) const noexcept;
  };
  std::unique_ptr<Handles, HandlesDeleter> handles_;
};

}  // namespace snare::benchmarks
