// KLU, CHOLMOD and KINSOL behind our handles, against dense Eigen.

#include "numerics/cholmod.hpp"
#include "numerics/errors.hpp"
#include "numerics/kinsol.hpp"
#include "numerics/klu.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <random>
#include <stdexcept>

namespace snare::numerics {
namespace {

SymmetricBandMatrix random_band(int n, int b, std::mt19937& random, double diagonal) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  SymmetricBandMatrix matrix(n, b);
  for (int j = 0; j < n; ++j) {
    for (int i = j; i <= std::min(n - 1, j + b); ++i) matrix.lower(i, j) = uniform(random);
    matrix.lower(j, j) += diagonal * (j % 3 == 0 ? -1.0 : 1.0);
  }
  return matrix;
}

Eigen::MatrixXd dense(const SparseMatrix& matrix) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(matrix.order, matrix.order);
  for (int j = 0; j < matrix.order; ++j) {
    for (int i = 0; i < matrix.order; ++i) {
      const int slot = matrix.slot(i, j);
      if (slot >= 0) result(i, j) = matrix.value[static_cast<std::size_t>(slot)];
    }
  }
  return result;
}

TEST(SparseMatrix, PatternMergesRepeatedEntriesAndFindsSlots) {
  const SparseMatrix m = make_pattern(3, {{2, 0}, {0, 0}, {2, 0}, {1, 2}});
  EXPECT_EQ(m.row, (std::vector<int>{0, 2, 1}));
  EXPECT_EQ(m.column_start, (std::vector<int>{0, 2, 2, 3}));
  EXPECT_EQ(m.slot(2, 0), 1);
  EXPECT_EQ(m.slot(1, 0), -1);
}

TEST(Klu, SolvesAndRefactorises) {
  std::mt19937 random(7);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(60, -1.0, 2.0);
  SparseMatrix first = to_sparse(random_band(60, 5, random, 6.0), Triangle::both);
  Klu klu(first);
  for (int k = 0; k < 3; ++k) {
    const SparseMatrix matrix = to_sparse(random_band(60, 5, random, 6.0), Triangle::both);
    ASSERT_TRUE(klu.factorize(matrix));
    Eigen::VectorXd x = b;
    klu.solve(x);
    EXPECT_LE((matrix * x - b).norm(), 1e-12 * b.norm());  // backward stable; condition about 10
    EXPECT_GT(klu.reciprocal_condition(), 1e-3);
  }
}

TEST(Klu, SingularMatrixIsReported) {
  SparseMatrix matrix = make_pattern(2, {{0, 0}, {0, 1}, {1, 0}, {1, 1}});
  matrix.value = {1.0, 2.0, 2.0, 4.0};
  Klu klu(matrix);
  EXPECT_FALSE(klu.factorize(matrix));
  EXPECT_THROW(Klu(make_pattern(2, {{0, 0}})), LibraryError);  // an empty column
}

TEST(Cholmod, SolvesAndTellsTheInertia) {
  std::mt19937 random(8);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(60, -1.0, 2.0);
  for (const auto ordering : {Cholmod::Ordering::natural, Cholmod::Ordering::approximate_minimum_degree}) {
    const SymmetricBandMatrix band = random_band(60, 5, random, 8.0);
    const SparseMatrix lower = to_sparse(band, Triangle::lower);
    Cholmod cholmod(lower, ordering);
    ASSERT_TRUE(cholmod.factorize(lower));
    Eigen::VectorXd x = b;
    cholmod.solve(x);
    EXPECT_LE((band * x - b).norm(), 1e-11 * b.norm());
    const Eigen::MatrixXd full = dense(to_sparse(band, Triangle::both));
    const auto negative = (Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(full).eigenvalues().array() < 0.0).count();
    EXPECT_EQ(cholmod.negative_pivots(), static_cast<int>(negative));
    BandLdlt own;
    ASSERT_TRUE(own.factorize(band));
    EXPECT_EQ(own.negative_pivots(), static_cast<int>(negative));
  }
}

NonlinearSystem circle_and_line() {
  // x^2 + y^2 = 4, x = y: (sqrt 2, sqrt 2).
  NonlinearSystem system;
  system.pattern = make_pattern(2, {{0, 0}, {0, 1}, {1, 0}, {1, 1}});
  system.residual = [](const Eigen::VectorXd& u, Eigen::VectorXd& f) {
    f.resize(2);
    f << u[0] * u[0] + u[1] * u[1] - 4.0, u[0] - u[1];
  };
  system.jacobian = [](const Eigen::VectorXd& u, SparseMatrix& j) { j.value = {2.0 * u[0], 1.0, 2.0 * u[1], -1.0}; };
  return system;
}

TEST(Kinsol, FindsTheRoot) {
  Eigen::VectorXd u(2);
  u << 3.0, 1.0;
  const SolveReport report = solve_kinsol(circle_and_line(), u);
  ASSERT_TRUE(report.usable()) << report.message;
  EXPECT_NEAR(u[0], std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(u[1], std::sqrt(2.0), 1e-9);
  EXPECT_LE(report.iterations, 8);
}

TEST(Kinsol, FailureIsReportedAndExceptionsPassThrough) {
  NonlinearSystem none = circle_and_line();
  none.residual = [](const Eigen::VectorXd& u, Eigen::VectorXd& f) {
    f.resize(2);
    f << u[0] * u[0] + u[1] * u[1] + 4.0, u[0] - u[1];
  };
  Eigen::VectorXd u(2);
  u << 3.0, 1.0;
  const SolveReport report = solve_kinsol(none, u);
  EXPECT_FALSE(report.usable());
  EXPECT_FALSE(report.message.empty());

  NonlinearSystem thrower = circle_and_line();
  thrower.jacobian = [](const Eigen::VectorXd&, SparseMatrix&) { throw std::runtime_error("from the callback"); };
  u << 3.0, 1.0;
  EXPECT_THROW((void)solve_kinsol(thrower, u), std::runtime_error);
}

}  // namespace
}  // namespace snare::numerics
