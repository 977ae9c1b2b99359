#include "numerics/sparse_eigen.hpp"

#include <Eigen/QR>

#include <algorithm>
#include <complex>
#include <numeric>
#include <random>
#include <vector>

namespace snare::numerics {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

MatrixXd orthonormal(const MatrixXd& columns) {
  return Eigen::HouseholderQR<MatrixXd>(columns).householderQ() *
         MatrixXd::Identity(columns.rows(), columns.cols());
}

/// The same vectors in every call, with what M reduces to nothing taken out.
MatrixXd first_block(const LinearMap& map, Index order) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> even(-1.0, 1.0);
  MatrixXd block(order, eigen_block);
  for (double& entry : block.reshaped()) entry = even(random);
  return orthonormal(map(orthonormal(map(block))));
}

}  // namespace

GeneralEigen largest_eigenvalues(const LinearMap& map, int order, int count) {
  constexpr Index dimensions_a_value = 3;
  constexpr double converged = 1e-8;
  const Index blocks = dimensions_a_value * count / eigen_block;
  MatrixXd V(order, blocks * eigen_block), MV(order, blocks * eigen_block);
  V.leftCols(eigen_block) = first_block(map, order);
  for (Index k = 0; k < blocks; ++k) {
    const Index known = (k + 1) * eigen_block;
    MV.middleCols(k * eigen_block, eigen_block) = map(V.middleCols(k * eigen_block, eigen_block));
    if (k + 1 == blocks) break;
    MatrixXd next = MV.middleCols(k * eigen_block, eigen_block);
    for (int twice = 0; twice < 2; ++twice)
      next -= V.leftCols(known) * (V.leftCols(known).transpose() * next);
    V.middleCols(known, eigen_block) = orthonormal(next);
  }
  const GeneralEigen ritz = general_eigen(V.transpose() * MV);
  std::vector<Index> falling(static_cast<std::size_t>(ritz.values.size()));
  std::iota(falling.begin(), falling.end(), Index{0});
  std::ranges::stable_sort(
      falling, [&](Index a, Index b) { return std::abs(ritz.values[a]) > std::abs(ritz.values[b]); });
  GeneralEigen result{Eigen::VectorXcd(count), Eigen::MatrixXcd(order, count)};
  Index found = 0;
  for (; found < count; ++found) {
    const Index k = falling[static_cast<std::size_t>(found)];
    const std::complex<double> value = ritz.values[k];
    const Eigen::VectorXcd vector = V * ritz.vectors.col(k);
    if ((MV * ritz.vectors.col(k) - value * vector).norm() > converged * std::abs(value)) break;
    result.values[found] = value;
    result.vectors.col(found) = vector.normalized();
  }
  return {result.values.head(found), result.vectors.leftCols(found)};
}

}  // namespace snare::numerics
