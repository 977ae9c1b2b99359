#pragma once

#include "numerics/sparse_matrix.hpp"

#include <Eigen/SparseCore>

#include <cassert>

namespace snare::numerics {

/// A x, which tests alone ask for.
[[nodiscard]] inline Eigen::VectorXd operator*(const SparseMatrix& a, const Eigen::VectorXd& x) {
  assert(x.size() == a.order);
  const Eigen::Map<const Eigen::SparseMatrix<double>> view(
      a.order, a.order, static_cast<Eigen::Index>(a.value.size()), a.column_start.data(), a.row.data(),
      a.value.data());
  return view * x;
}

}  // namespace snare::numerics
