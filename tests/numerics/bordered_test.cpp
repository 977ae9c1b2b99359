// Bordered systems where the blocks lose their digits, and their sparse form.

#include "numerics/bordered.hpp"
#include "benchmarks/peers/bordered_pattern.hpp"
#include "tests/support/sparse_product.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace snare::numerics {
namespace {

using benchmarks::BorderedPattern;

/// Free-standing chain of n masses and unit springs (singular: it can move as a whole), times `scale`.
SymmetricBandMatrix free_chain(int n, double scale = 1.0) {
  SymmetricBandMatrix k(n, 1);
  for (int i = 0; i + 1 < n; ++i) {
    k.lower(i, i) += scale;
    k.lower(i + 1, i + 1) += scale;
    k.lower(i + 1, i) = -scale;
  }
  return k;
}

/// Bending of a cantilever of n unit edges: second differences, 1/2 sum (w_{i+1} - 2 w_i + w_{i-1})^2,
/// clamped at one end by w_0 = w_{-1} = 0. Definite, condition about n^4.
SymmetricBandMatrix cantilever(int n) {
  SymmetricBandMatrix k(n, 2);
  const double stencil[3] = {1.0, -2.0, 1.0};
  for (int i = -1; i + 2 < n; ++i) {
    for (int a = 0; a < 3; ++a) {
      for (int c = 0; c <= a; ++c) {
        if (i + c >= 0) k.lower(i + a, i + c) += stencil[a] * stencil[c];
      }
    }
  }
  k.lower(0, 0) += 1.0;  // (w_0 - 2 w_{-1} + w_{-2})^2 with the clamp's mirror image
  return k;
}

Eigen::MatrixXd dense(const BorderedSystem& system) {
  const int n = system.matrix.order();
  const auto m = system.corner.rows();
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n + m, n + m);
  for (int j = 0; j < n; ++j) {
    for (int i = j; i <= std::min(n - 1, j + system.matrix.half_bandwidth()); ++i) {
      a(i, j) = a(j, i) = system.matrix.lower(i, j);
    }
  }
  for (const auto& anchor : system.anchors) a(anchor.band, n + anchor.border) -= 1.0;
  for (const auto& [border, values] : system.columns) a.col(n + border).head(n) += *values;
  for (const auto& entry : system.rows) a(n + entry.row, entry.column) += entry.value;
  a.bottomRightCorner(m, m) += system.corner;
  return a;
}

/// The chain held in the mean: sum x = b. Regular, though K is singular.
BorderedSystem chain_with_mean(int n, double scale, const Eigen::VectorXd& column) {
  BorderedSystem system;
  system.reset(n, 1);
  system.matrix = free_chain(n, scale);
  system.columns.emplace_back(0, &column);
  for (int i = 0; i < n; ++i) system.rows.push_back({0, i, 1.0});
  return system;
}

TEST(BorderedFallback, SingularBandAtAnyScale) {
  constexpr int n = 12;
  const Eigen::VectorXd column = Eigen::VectorXd::Ones(n);
  // 0.1 is not a binary fraction: the last pivot is round-off rather than zero.
  for (const double scale : {1.0, 0.1, 1e9, 1.0 / 3.0 * 1e-7}) {
    const BorderedSystem system = chain_with_mean(n, scale, column);
    BorderedSolver solver;
    ASSERT_TRUE(solver.factorize(system)) << scale;
    EXPECT_FALSE(solver.blockwise()) << scale;
    EXPECT_EQ(solver.determinant_sign(), dense(system).determinant() > 0.0 ? 1 : -1) << scale;
    Eigen::VectorXd load(n + 1);
    for (int i = 0; i <= n; ++i) load[i] = std::cos(2.0 * i);
    Eigen::VectorXd band = load.head(n);
    Eigen::VectorXd border = load.tail(1);
    solver.solve(system, band, border);
    Eigen::VectorXd x(n + 1);
    x << band, border;
    const Eigen::MatrixXd a = dense(system);
    // Backward stable: a few eps of |A| |x| + |b| in every row.
    const Eigen::VectorXd allowed = 1e-14 * (a.cwiseAbs() * x.cwiseAbs() + load.cwiseAbs());
    EXPECT_TRUE(((a * x - load).array().abs() <= allowed.array()).all()) << scale;
  }
}

TEST(BorderedFallback, FineDefiniteMeshStaysWithTheBlocks) {
  // The last pivots keep about 1/n^3 of their diagonal entries: small, and the solution is right all the
  // same.
  for (const int n : {100, 10000, 60000}) {
    BorderedSystem system;
    system.reset(n, 1);
    system.matrix = cantilever(n);
    system.anchors = {{n / 2, 0}};
    system.rows.push_back({0, n / 2, 1.0});
    BorderedSolver solver;
    ASSERT_TRUE(solver.factorize(system)) << n;
    EXPECT_TRUE(solver.blockwise()) << n;
    // With 1e-15 left of it, at n = 60000, the sign of a pivot is round-off.
    if (n <= 10000) {
      EXPECT_EQ(solver.negative_pivots(), 0) << n;
    }
  }
}

TEST(BorderedFallback, SingularWholeIsReported) {
  constexpr int n = 12;
  const Eigen::VectorXd column = Eigen::VectorXd::Unit(n, 0) - Eigen::VectorXd::Unit(n, 5);
  BorderedSolver solver;
  // Neither row nor column sees the motion as a whole.
  BorderedSystem system;
  system.reset(n, 1);
  system.matrix = free_chain(n);
  system.columns.emplace_back(0, &column);
  system.rows = {{0, 0, 1.0}, {0, 5, -1.0}};
  EXPECT_FALSE(solver.factorize(system));
  // A border equation without any entry: the pattern alone is singular.
  system.rows.clear();
  EXPECT_FALSE(solver.factorize(system));
  // What is not a number is no matrix.
  system.rows = {{0, 0, 1.0}};
  system.matrix.lower(3, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(solver.factorize(system));
  system.matrix = chain_with_mean(n, 1.0, Eigen::VectorXd::Ones(n)).matrix;
  system.corner(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(solver.factorize(system));
  // And the solver is none the worse for it.
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(n);
  EXPECT_TRUE(solver.factorize(chain_with_mean(n, 1.0, ones)));
}

TEST(BorderedPattern, RefillsWhatToSparseMakes) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  constexpr int n = 20;
  constexpr int m = 3;
  BorderedSystem system;
  Eigen::VectorXd column(n);
  const auto fill = [&] {
    system.reset(n, m);
    system.matrix = SymmetricBandMatrix(n, 5);
    for (int j = 0; j < n; ++j) {
      for (int i = j; i <= std::min(n - 1, j + 5); ++i) system.matrix.lower(i, j) = uniform(random);
      // What is stored beyond the last row is not part of the matrix.
      for (int i = n - j; i <= 5; ++i) system.matrix.column(j)[i] = 1e9;
    }
    for (int i = 0; i < n; ++i) column[i] = uniform(random);
    system.columns.emplace_back(2, &column);
    system.anchors = {{4, 0}, {9, 1}};
    system.rows = {
        {0, 4, uniform(random)}, {1, 9, uniform(random)}, {1, 9, uniform(random)}, {2, 0, uniform(random)}};
    for (int i = 0; i < m; ++i) system.corner(i, i) = uniform(random);
  };
  for (const auto zeros : {BorderedPattern::Zeros::kept, BorderedPattern::Zeros::dropped}) {
    fill();
    const BorderedPattern pattern(system, zeros);
    SparseMatrix matrix = pattern.pattern();
    for (int k = 0; k < 3; ++k) {
      ASSERT_TRUE(pattern.refill(system, matrix));
      // The same numbers at the same places; only the two entries of one place are added.
      EXPECT_LE((dense(matrix) - dense(system)).lpNorm<Eigen::Infinity>(), 1e-15);
      EXPECT_LE((dense(matrix) - dense(to_sparse(system))).lpNorm<Eigen::Infinity>(), 1e-15);
      fill();
    }
    system.corner(0, 2) = 1.0;  // was zero when the pattern was made
    EXPECT_EQ(pattern.refill(system, matrix), zeros == BorderedPattern::Zeros::kept);
    system.rows.pop_back();
    EXPECT_FALSE(pattern.refill(system, matrix));
  }
}

}  // namespace
}  // namespace snare::numerics
