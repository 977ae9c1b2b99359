#pragma once

#include "numerics/report.hpp"
#include "numerics/sparse_matrix.hpp"

#include <Eigen/Core>

#include <functional>

namespace snare::benchmarks {

/// F(u) = 0 for SUNDIALS KINSOL with an analytic sparse Jacobian.
struct NonlinearSystem {
  numerics::SparseMatrix pattern;  ///< of the Jacobian; fixed
  /// F(u) into `residual`.
  std::function<void(const Eigen::VectorXd& u, Eigen::VectorXd& residual)> residual;
  /// dF/du into the values of `jacobian`, which has the pattern.
  std::function<void(const Eigen::VectorXd& u, numerics::SparseMatrix& jacobian)> jacobian;
};

struct KinsolOptions {
  double residual_tolerance = 1e-9;  ///< of the largest residual, in its unit
  int max_iterations = 100;
};

/// Newton's method with line search by KINSOL, linear systems by KLU, from u, which is overwritten by the
/// last iterate. Exceptions thrown by the functions pass through; a failure of the iteration is reported.
/// `residual_norm` is the largest residual over the tolerance. Throws LibraryError when SUNDIALS cannot be
/// set up or refuses its input.
[[nodiscard]] numerics::SolveReport solve_kinsol(const NonlinearSystem& system, Eigen::VectorXd& u,
                                                 const KinsolOptions& options = {});

}  // namespace snare::benchmarks
