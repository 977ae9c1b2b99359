#include "numerics/band_matrix.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <limits>
#include <random>

namespace snare::numerics {
namespace {

Eigen::MatrixXd dense(const SymmetricBandMatrix& a) {
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(a.order(), a.order());
  for (int j = 0; j < a.order(); ++j) {
    for (int i = j; i < a.order() && i - j <= a.half_bandwidth(); ++i)
      full(i, j) = full(j, i) = a.lower(i, j);
  }
  return full;
}

// Entries of order one, diagonal moved by `shift`.
SymmetricBandMatrix random_band(int n, int b, double shift, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  SymmetricBandMatrix a(n, b);
  for (int j = 0; j < n; ++j) {
    for (int i = j; i < n && i - j <= b; ++i) a.lower(i, j) = unit(random);
    a.lower(j, j) += shift;
  }
  return a;
}

TEST(SymmetricBandMatrix, ProductMatchesDense) {
  std::mt19937 random(1);
  for (const int b : {0, 1, 5, 10, 13}) {
    const SymmetricBandMatrix a = random_band(12, b, 0.0, random);
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(12, -1.0, 2.0);
    EXPECT_LT((a * x - dense(a) * x).norm(), 1e-14);  // sums of 12 terms of order one
  }
}

TEST(SymmetricBandMatrix, AddTakesEitherOrder) {
  SymmetricBandMatrix a(4, 2);
  a.add(1, 3, 2.0);
  a.add(3, 1, 0.5);
  a.add(2, 2, 1.0);
  EXPECT_EQ(a.lower(3, 1), 2.5);
  EXPECT_EQ(a.lower(2, 2), 1.0);
  a.set_zero();
  EXPECT_EQ(dense(a).norm(), 0.0);
}

TEST(SymmetricBandMatrix, HoldMakesTheRowThatOfTheIdentity) {
  std::mt19937 random(2);
  for (const int row : {0, 3, 7, 11}) {
    SymmetricBandMatrix a = random_band(12, 5, 0.0, random);
    Eigen::MatrixXd expected = dense(a);
    expected.row(row).setZero();
    expected.col(row).setZero();
    expected(row, row) = 1.0;
    a.hold(row);
    EXPECT_EQ((dense(a) - expected).norm(), 0.0);
  }
}

TEST(SymmetricBandMatrix, HoldKeepsColumnsBeyondTheEndClean) {
  // The stored columns of the last unknowns reach beyond the matrix; nothing of that may enter a solution.
  std::mt19937 random(3);
  SymmetricBandMatrix a = random_band(6, 10, 8.0, random);
  a.hold(5);
  BandLdlt factor;
  ASSERT_TRUE(factor.factorize(a));
  Eigen::MatrixXd x = Eigen::VectorXd::Ones(6);
  factor.solve(x);
  EXPECT_LT((dense(a) * x - Eigen::VectorXd::Ones(6)).norm(), 1e-14);
}

TEST(BandLdlt, SolvesLikeDenseLdlt) {
  std::mt19937 random(4);
  for (const int b : {0, 1, 3, 5, 10}) {
    for (const int n : {1, 4, 40}) {
      const SymmetricBandMatrix a = random_band(n, b, 2.0 + b, random);
      std::uniform_real_distribution<double> unit(-1.0, 1.0);
      const Eigen::MatrixXd rhs = Eigen::MatrixXd::NullaryExpr(n, 7, [&]() { return unit(random); });
      BandLdlt factor;
      ASSERT_TRUE(factor.factorize(a));
      Eigen::MatrixXd x = rhs;
      factor.solve(x);
      const Eigen::MatrixXd expected = dense(a).ldlt().solve(rhs);
      // Diagonally heavy: condition below 1e2, so 1e2 eps.
      EXPECT_LT((x - expected).norm(), 1e-13 * expected.norm()) << "n " << n << " b " << b;
      for (Eigen::Index c = 0; c < rhs.cols();
           ++c) {  // four, two and one at once: the same bits as each alone
        Eigen::VectorXd alone = rhs.col(c);
        factor.solve(alone);
        EXPECT_EQ(alone, x.col(c)) << "n " << n << " b " << b;
      }
    }
  }
}

TEST(BandLdlt, InertiaIsThatOfTheEigenvalues) {
  std::mt19937 random(5);
  for (const int b : {1, 5, 10}) {
    for (int k = 0; k < 20; ++k) {
      const SymmetricBandMatrix a = random_band(30, b, 0.3 * (k - 10), random);
      BandLdlt factor;
      ASSERT_TRUE(factor.factorize(a));
      const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense(a)).eigenvalues();
      EXPECT_EQ(factor.negative_pivots(), (values.array() < 0.0).count()) << "b " << b << " k " << k;
    }
  }
}

TEST(BandLdlt, DeterminantIsTheProductOfThePivots) {
  SymmetricBandMatrix a(3, 1);
  a.lower(0, 0) = 2.0;
  a.lower(1, 0) = 4.0;
  a.lower(1, 1) = 1.0;
  a.lower(2, 1) = 7.0;
  a.lower(2, 2) = -5.0;
  // Pivots 2, 1 - 8 = -7, -5 + 49/7 = 2.
  BandLdlt factor;
  ASSERT_TRUE(factor.factorize(a));
  EXPECT_EQ(factor.negative_pivots(), 1);
  EXPECT_DOUBLE_EQ(factor.pivot_ratio(), 2.0 / 7.0);
}

TEST(BandLdlt, RefusesZeroAndNonFinitePivots) {
  BandLdlt factor;
  SymmetricBandMatrix a(3, 1);
  EXPECT_FALSE(factor.factorize(a));
  for (int i = 0; i < 3; ++i) a.lower(i, i) = 1.0;
  EXPECT_TRUE(factor.factorize(a));
  a.lower(2, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(factor.factorize(a));
  a.lower(2, 2) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(factor.factorize(a));
}

}  // namespace
}  // namespace snare::numerics
