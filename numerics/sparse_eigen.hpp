#pragma once

#include "numerics/dense_solvers.hpp"

#include <Eigen/Core>

#include <functional>

namespace snare::numerics {

/// Applies a square matrix to every column: M X. Of any unit.
using LinearMap = std::function<Eigen::MatrixXd(const Eigen::MatrixXd& X)>;

/// The eigenvalues of M that are largest in magnitude, falling, and their eigenvectors of norm one, by block
/// Arnoldi iteration without restarts (Saad, Numerical Methods for Large Eigenvalue Problems, 6.5).
/// Eigenvalues may be up to `eigen_block`-fold. order: of M, at least 3 `count`; count: at most so many, > 0
/// [-]. The list ends before the first one whose residual is above 1e-8 of it, so that none is missing in
/// between; it may be empty.
[[nodiscard]] GeneralEigen largest_eigenvalues(const LinearMap& map, int order, int count);

/// Vectors with which the iteration begins.
inline constexpr int eigen_block = 12;

}  // namespace snare::numerics
