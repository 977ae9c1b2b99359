#include "numerics/dense_solvers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <random>
#include <utility>

namespace snare::numerics {
namespace {

// Entries of order one, a few of a side: what is left are roundings, times the condition where there is one.
Eigen::MatrixXd random_matrix(int rows, int columns, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Eigen::MatrixXd a(rows, columns);
  for (int j = 0; j < columns; ++j)
    for (int i = 0; i < rows; ++i) a(i, j) = unit(random);
  return a;
}

// Second differences of a chain of n between two ends: eigenvalues 4 sin^2(k pi / 2 (n + 1)).
Eigen::MatrixXd chain(int n) {
  Eigen::MatrixXd a = 2.0 * Eigen::MatrixXd::Identity(n, n);
  a.diagonal(1).setConstant(-1.0);
  a.diagonal(-1).setConstant(-1.0);
  return a;
}

TEST(DenseSolvers, EigenvaluesOfAChain) {
  constexpr int n = 9;
  const SymmetricEigen modes = symmetric_eigen(chain(n));
  for (int k = 1; k <= n; ++k)
    EXPECT_NEAR(modes.values[k - 1], 4.0 * std::pow(std::sin(k * M_PI / (2.0 * (n + 1))), 2), 1e-14);
  EXPECT_LT((chain(n) * modes.vectors - modes.vectors * modes.values.asDiagonal()).norm(), 1e-14);
  EXPECT_LT((modes.vectors.transpose() * modes.vectors - Eigen::MatrixXd::Identity(n, n)).norm(), 1e-14);
}

// A cyclic shift has the roots of unity.
TEST(DenseSolvers, EigenvaluesThatAreComplex) {
  constexpr int n = 5;
  Eigen::MatrixXd shift = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) shift(i, (i + 1) % n) = 1.0;
  const GeneralEigen modes = general_eigen(shift);
  for (int k = 0; k < n; ++k) {
    const std::complex<double> root = std::polar(1.0, 2.0 * M_PI * k / n);
    EXPECT_LT((modes.values.array() - root).abs().minCoeff(), 1e-13) << k;
  }
  EXPECT_LT(
      (shift.cast<std::complex<double>>() * modes.vectors - modes.vectors * modes.values.asDiagonal()).norm(),
      1e-13);
  for (int k = 0; k < n; ++k) EXPECT_NEAR(modes.vectors.col(k).norm(), 1.0, 1e-14);
}

TEST(DenseSolvers, ThinDecompositionOfTallAndWide) {
  for (const auto& [rows, columns] : {std::pair{7, 3}, {3, 7}}) {
    const Eigen::MatrixXd a = random_matrix(rows, columns, 1);
    const ThinSvd svd = thin_svd(a);
    ASSERT_EQ(svd.U.cols(), 3);
    ASSERT_EQ(svd.V.cols(), 3);
    EXPECT_LT((svd.U * svd.s.asDiagonal() * svd.V.transpose() - a).norm(), 1e-14);
    EXPECT_GE(svd.s[0], svd.s[1]);
    EXPECT_GE(svd.s[1], svd.s[2]);
    EXPECT_NEAR(svd.s.squaredNorm(), a.squaredNorm(), 1e-13);
  }
}

TEST(DenseSolvers, SquareSystems) {
  const Eigen::MatrixXd a = random_matrix(6, 6, 2);
  const Eigen::MatrixXd b = random_matrix(6, 4, 3);
  EXPECT_LT((a * solve_by_lu(a, b) - b).norm(), 1e-12);
  const Eigen::MatrixXd indefinite = a + a.transpose();
  EXPECT_LT((indefinite * solve_symmetric(indefinite, b.col(0)) - b.col(0)).norm(), 1e-12);
  EXPECT_FALSE(solve_by_lu(Eigen::MatrixXd::Zero(2, 2), Eigen::MatrixXd::Ones(2, 1)).allFinite());
}

// With a rank of two, of all x with the least residual the one of least norm; its pseudo-inverse has the four
// properties of Penrose.
TEST(DenseSolvers, LeastSquaresOfAnyRank) {
  const Eigen::MatrixXd a = random_matrix(6, 2, 4) * random_matrix(2, 4, 5);
  const Eigen::VectorXd b = random_matrix(6, 1, 6);
  const Eigen::VectorXd x = least_squares(a, b);
  EXPECT_LT((a.transpose() * (a * x - b)).norm(), 1e-13);
  const Eigen::MatrixXd p = pseudo_inverse(a);
  EXPECT_LT((p * b - x).norm(), 1e-12);
  EXPECT_LT((a * p * a - a).norm(), 1e-13);
  EXPECT_LT((p * a * p - p).norm(), 1e-12);
  EXPECT_LT((a * p - (a * p).transpose()).norm(), 1e-13);
  EXPECT_LT((p * a - (p * a).transpose()).norm(), 1e-13);
  const Eigen::MatrixXd tall = random_matrix(6, 3, 7);
  EXPECT_LT((full_rank_least_squares(tall, b) - least_squares(tall, b)).norm(), 1e-13);
}

TEST(DenseSolvers, DecompositionsOfAnEmptyMatrixAreEmpty) {
  EXPECT_EQ(symmetric_eigen(Eigen::MatrixXd(0, 0)).values.size(), 0);
  const ThinSvd svd = thin_svd(Eigen::MatrixXd(5, 0));
  EXPECT_EQ(svd.s.size(), 0);
  EXPECT_EQ(svd.U.rows(), 5);
  EXPECT_EQ(svd.V.cols(), 0);
}

}  // namespace
}  // namespace snare::numerics
