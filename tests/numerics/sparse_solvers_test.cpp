// KLU, CHOLMOD and KINSOL behind our handles, against dense Eigen.

#include "base/errors.hpp"
#include "benchmarks/peers/bordered_pattern.hpp"
#include "benchmarks/peers/cholmod.hpp"
#include "benchmarks/peers/kinsol.hpp"
#include "numerics/klu.hpp"
#include "tests/support/sparse_product.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

namespace snare::numerics {
namespace {

using benchmarks::Cholmod;
using benchmarks::KinsolOptions;
using benchmarks::NonlinearSystem;
using benchmarks::solve_kinsol;
using benchmarks::to_sparse;

SymmetricBandMatrix random_band(int n, int b, std::mt19937& random, double diagonal) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  SymmetricBandMatrix matrix(n, b);
  for (int j = 0; j < n; ++j) {
    for (int i = j; i <= std::min(n - 1, j + b); ++i) matrix.lower(i, j) = uniform(random);
    matrix.lower(j, j) += diagonal * (j % 3 == 0 ? -1.0 : 1.0);
  }
  return matrix;
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
  const SparseMatrix empty_column = make_pattern(2, {{0, 0}});
  EXPECT_FALSE(Klu(empty_column).factorize(empty_column));
}

TEST(Klu, PivotsThatNoLongerSuitAreChosenAnew) {
  SparseMatrix matrix = make_pattern(2, {{0, 0}, {0, 1}, {1, 0}, {1, 1}});
  const auto values = [&matrix](double a00, double a10, double a01, double a11) {
    matrix.value = {a00, a10, a01, a11};
  };
  values(2.0, 1.0, 1.0, 2.0);
  Klu klu(matrix);
  ASSERT_TRUE(klu.factorize(matrix));
  EXPECT_EQ(klu.determinant_sign(), 1);
  // The first pivot of either order is 1e-14 of the rest now: elimination with it would lose 14 digits.
  values(1e-14, 1.0, 1.0, 1e-14);
  ASSERT_TRUE(klu.factorize(matrix));
  EXPECT_EQ(klu.determinant_sign(), -1);
  Eigen::VectorXd x(2);
  x << 3.0, 5.0;
  klu.solve(x);
  EXPECT_NEAR(x[0], 5.0, 1e-13);  // condition 1; the off-diagonal solution but for 3e-14
  EXPECT_NEAR(x[1], 3.0, 1e-13);
}

TEST(Klu, DeterminantSignIsThatOfDense) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::uniform_int_distribution<int> index(0, 11);
  int negative = 0;
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<std::pair<int, int>> entries;
    for (int i = 0; i < 12; ++i)
      entries.emplace_back(i, (5 * i + 3) % 12);  // a permutation: structurally regular
    for (int k = 0; k < 30; ++k) entries.emplace_back(index(random), index(random));
    SparseMatrix matrix = make_pattern(12, entries);
    for (double& v : matrix.value) v = uniform(random);
    Klu klu(matrix);
    ASSERT_TRUE(klu.factorize(matrix));
    const double determinant = dense(matrix).determinant();
    EXPECT_EQ(klu.determinant_sign(), determinant > 0.0 ? 1 : -1) << "trial " << trial << ", " << determinant;
    negative += determinant < 0.0 ? 1 : 0;
  }
  EXPECT_GT(negative, 5);  // both signs were met
  EXPECT_LT(negative, 35);
}

TEST(Cholmod, VanishingPivotIsReported) {
  SparseMatrix lower = make_pattern(2, {{0, 0}, {1, 0}, {1, 1}});
  lower.value = {0.0, 1.0, 0.0};
  Cholmod cholmod(lower, Cholmod::Ordering::natural);
  EXPECT_FALSE(cholmod.factorize(lower));
  lower.value = {2.0, 1.0, 0.0};  // the next values may be better
  ASSERT_TRUE(cholmod.factorize(lower));
  EXPECT_EQ(cholmod.negative_pivots(), 1);
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
    const auto negative =
        (Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(full).eigenvalues().array() < 0.0).count();
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
  system.jacobian = [](const Eigen::VectorXd& u, SparseMatrix& j) {
    j.value = {2.0 * u[0], 1.0, 2.0 * u[1], -1.0};
  };
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
  thrower.jacobian = [](const Eigen::VectorXd&, SparseMatrix&) {
    throw std::runtime_error("from the callback");
  };
  u << 3.0, 1.0;
  EXPECT_THROW((void)solve_kinsol(thrower, u), std::runtime_error);

  NonlinearSystem second = circle_and_line();
  second.residual = [](const Eigen::VectorXd&, Eigen::VectorXd&) {
    throw std::out_of_range("from the residual");
  };
  EXPECT_THROW((void)solve_kinsol(second, u), std::out_of_range);
}

TEST(Kinsol, ReportsWhatStoppedIt) {
  Eigen::VectorXd u(2);
  u << 0.0, 0.0;  // the Jacobian (0, 0; 1, -1) is singular here
  EXPECT_EQ(solve_kinsol(circle_and_line(), u).termination, Termination::singular_matrix);

  u << 300.0, 100.0;
  KinsolOptions two;
  two.max_iterations = 2;
  const SolveReport limited = solve_kinsol(circle_and_line(), u, two);
  EXPECT_EQ(limited.termination, Termination::iteration_limit);
  EXPECT_EQ(limited.iterations, 2);
  EXPECT_GT(limited.residual_norm, 1.0);

  NonlinearSystem undefined = circle_and_line();
  undefined.residual = [](const Eigen::VectorXd&, Eigen::VectorXd& f) { f.setConstant(2, std::nan("")); };
  EXPECT_EQ(solve_kinsol(undefined, u).termination, Termination::not_finite);
}

TEST(Kinsol, StopsWhereItStarts) {
  Eigen::VectorXd u = Eigen::VectorXd::Constant(2, std::sqrt(2.0));
  const SolveReport report = solve_kinsol(circle_and_line(), u);
  EXPECT_TRUE(report.usable());
  EXPECT_EQ(report.iterations, 0);
  EXPECT_LE(report.residual_norm, 1.0);
}

TEST(Kinsol, AgreesWithPlainNewtonOnALargerSystem) {
  // Chain -u'' + u^3 = 1 on 50 points: K u + h^2 (u^3 - 1) = 0.
  constexpr int n = 50;
  const double h2 = 1.0 / ((n + 1.0) * (n + 1.0));
  SymmetricBandMatrix laplace(n, 1);
  for (int i = 0; i < n; ++i) {
    laplace.lower(i, i) = 2.0;
    if (i + 1 < n) laplace.lower(i + 1, i) = -1.0;
  }
  const auto residual = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return laplace * x + h2 * (x.array().cube() - 1.0).matrix();
  };
  NonlinearSystem system;
  system.pattern = to_sparse(laplace, Triangle::both);
  system.residual = [&](const Eigen::VectorXd& x, Eigen::VectorXd& f) { f = residual(x); };
  system.jacobian = [&](const Eigen::VectorXd& x, SparseMatrix& j) {
    j.value = system.pattern.value;
    for (int i = 0; i < n; ++i) j.value[static_cast<std::size_t>(j.slot(i, i))] += 3.0 * h2 * x[i] * x[i];
  };
  KinsolOptions options;
  options.residual_tolerance = 1e-14;
  Eigen::VectorXd u = Eigen::VectorXd::Zero(n);
  ASSERT_TRUE(solve_kinsol(system, u, options).usable());

  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  for (int k = 0; k < 8; ++k) {
    Eigen::MatrixXd jacobian = dense(system.pattern);
    jacobian.diagonal().array() += 3.0 * h2 * x.array().square();
    x -= jacobian.lu().solve(residual(x));
  }
  EXPECT_LE((u - x).lpNorm<Eigen::Infinity>(), 1e-11);  // tolerance 1e-14 times the condition of about 1e3
}

}  // namespace
}  // namespace snare::numerics
