#pragma once

#include "numerics/dense_solvers.hpp"
#include "numerics/sparse_matrix.hpp"

#include <Eigen/Core>

#include <functional>

namespace snare::numerics {

/// Applies a square matrix: y = M x. Of any unit.
using LinearMap = std::function<void(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> y)>;

/// The eigenvalues of M that are largest in magnitude, falling, and their eigenvectors, by Arnoldi's method with implicit
/// restarts (Spectra). M: of order `order` [-]; count: how many, at least 1 and at most order - 2. Of eigenvalues that did not
/// converge nothing is returned, so fewer may come back, or none.
[[nodiscard]] GeneralEigen largest_eigenvalues(const LinearMap& map, int order, int count);

}  // namespace snare::numerics
