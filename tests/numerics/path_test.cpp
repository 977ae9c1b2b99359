// Bordered systems and path following, on small problems with known paths.

#include "numerics/path.hpp"
#include "tests/support/sparse_product.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <cmath>
#include <random>
#include <vector>

namespace snare::numerics {
namespace {

BorderedSystem random_system(int n, int m, std::mt19937& random, Eigen::VectorXd& column) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  BorderedSystem system;
  system.reset(n, m);
  system.matrix = SymmetricBandMatrix(n, 5);
  for (int j = 0; j < n; ++j) {
    for (int i = j; i <= std::min(n - 1, j + 5); ++i)
      system.matrix.lower(i, j) = uniform(random) + (i == j ? 8.0 : 0.0);
  }
  system.anchors = {{3, 0}, {4, 1}};
  column = Eigen::VectorXd::NullaryExpr(n, [&] { return uniform(random); });
  system.columns.emplace_back(2, &column);
  for (int row = 0; row < m; ++row) {
    system.rows.push_back({row, 3 + row, 1.0});
    system.rows.push_back({row, 7, uniform(random)});
    for (int k = 0; k < m; ++k) system.corner(row, k) = uniform(random);
  }
  return system;
}

TEST(Bordered, SolvesAsTheWholeMatrixDoes) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 20; ++trial) {
    Eigen::VectorXd column;
    const BorderedSystem system = random_system(30, 3, random, column);
    const SparseMatrix whole = to_sparse(system);
    const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(33, -1.0, 1.0);
    Eigen::VectorXd band = right.head(30);
    Eigen::VectorXd border = right.tail(3);
    BorderedSolver solver;
    ASSERT_TRUE(solver.factorize(system));
    EXPECT_TRUE(solver.blockwise());
    solver.solve(system, band, border);
    Eigen::VectorXd x(33);
    x << band, border;
    EXPECT_LE((whole * x - right).norm(),
              1e-10 * (1.0 + x.norm()));  // random Schur complements: condition to 1e4
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(33, 33);
    for (int k = 0; k < 33; ++k) dense.col(k) = whole * Eigen::VectorXd::Unit(33, k);
    EXPECT_EQ(solver.determinant_sign(), dense.determinant() > 0.0 ? 1 : -1);
  }
}

TEST(Bordered, FallsBackOnKluWhereTheBandIsSingular) {
  // K = diag(0, 1) without anchors; the border makes the whole regular.
  BorderedSystem system;
  system.reset(2, 1);
  system.matrix = SymmetricBandMatrix(2, 1);
  system.matrix.lower(1, 1) = 1.0;
  const Eigen::VectorXd column = Eigen::VectorXd::Unit(2, 0);
  system.columns.emplace_back(0, &column);
  system.rows.push_back({0, 0, 1.0});
  BorderedSolver solver;
  ASSERT_TRUE(solver.factorize(system));
  EXPECT_FALSE(solver.blockwise());
  Eigen::VectorXd band(2);
  band << 5.0, 2.0;
  Eigen::VectorXd border(1);
  border << 3.0;
  solver.solve(system, band, border);
  EXPECT_DOUBLE_EQ(band[0], 3.0);
  EXPECT_DOUBLE_EQ(band[1], 2.0);
  EXPECT_DOUBLE_EQ(border[0], 5.0);
}

/// x^3 - x = p as a spring of one coordinate x held by a force f: band x, border f; f = p - ... written as
/// band: x^3 - x - f = 0, border: f - p = 0. Folds at x = -+1/sqrt 3, p = +-2/(3 sqrt 3).
class Cubic final : public PathProblem {
 public:
  void assemble(const PathPoint& at, BorderedSystem& system, Eigen::VectorXd& by_parameter) override {
    const double x = at.band[0];
    system.reset(1, 1);
    system.matrix = SymmetricBandMatrix(1, 0);
    system.matrix.lower(0, 0) = 3.0 * x * x - 1.0;
    system.band_residual[0] = x * x * x - x - at.border[0];
    column_ = -Eigen::VectorXd::Ones(1);
    system.columns.emplace_back(0, &column_);
    system.border_residual[0] = at.border[0] - at.parameter;
    system.corner(0, 0) = 1.0;
    by_parameter = -Eigen::VectorXd::Ones(1);
  }
  [[nodiscard]] double error(const PathPoint&, const BorderedSystem& system) const override {
    return std::max(std::abs(system.band_residual[0]), std::abs(system.border_residual[0])) / 1e-13;
  }
  [[nodiscard]] double length_scale() const override { return 10.0; }

 private:
  Eigen::VectorXd column_;
};

TEST(Path, NewtonConvergesQuadraticallyAndReportsFailure) {
  Cubic problem;
  PathWorkspace workspace;
  PathPoint point{Eigen::VectorXd::Constant(1, 2.0), Eigen::VectorXd::Zero(1), 6.0};
  const SolveReport report = correct(problem, point, workspace, 10);
  ASSERT_TRUE(report.usable()) << report.message;
  EXPECT_NEAR(point.band[0], 2.0, 1e-12);  // 8 - 2 = 6
  PathPoint far{Eigen::VectorXd::Constant(1, 1.5), Eigen::VectorXd::Zero(1), 6.0};
  EXPECT_LE(correct(problem, far, workspace, 10).iterations, 6);
  // No solution near x = 0.4 for p = -1: the iteration must say so, not return something.
  PathPoint none{Eigen::VectorXd::Constant(1, 0.57735), Eigen::VectorXd::Zero(1), -5.0};
  const SolveReport failed = correct(problem, none, workspace, 3);
  EXPECT_FALSE(failed.usable());
  EXPECT_FALSE(failed.message.empty());
}

TEST(Path, NewtonConvergesAtSecondOrder) {
  Cubic problem;
  PathWorkspace workspace;
  std::vector<double> errors;
  for (int iterations = 1; iterations <= 4; ++iterations) {
    PathPoint point{Eigen::VectorXd::Constant(1, 2.6), Eigen::VectorXd::Zero(1), 6.0};
    (void)correct(problem, point, workspace, iterations);
    errors.push_back(std::abs(point.band[0] - 2.0));
  }
  // e' = e^2 f''/(2 f') = 12/22 e^2 in the limit; the orders approach 2 from below 0.02 apart.
  for (std::size_t k = 2; k < errors.size(); ++k) {
    const double order = std::log(errors[k] / errors[k - 1]) / std::log(errors[k - 1] / errors[k - 2]);
    EXPECT_NEAR(order, 2.0, 0.1) << "after " << k + 1 << " iterations";
  }
  EXPECT_NEAR(errors[3] / (errors[2] * errors[2]), 12.0 / 22.0, 0.01);
}

TEST(Path, TangentIsThatOfTheCurve) {
  Cubic problem;
  PathWorkspace workspace;
  for (const double x : {-1.4, -0.7, 0.2, 0.9}) {
    const double p = x * x * x - x;
    const PathPoint point{Eigen::VectorXd::Constant(1, x), Eigen::VectorXd::Constant(1, p), p};
    const double slope = 3.0 * x * x - 1.0;  // dp/dx
    const PathTangent forward = tangent(problem, point, workspace, nullptr).value();
    EXPECT_NEAR(forward.band[0] * slope, forward.parameter, 1e-14);
    EXPECT_NEAR(forward.border[0], forward.parameter, 1e-14);  // the force is the parameter
    EXPECT_NEAR(forward.band.squaredNorm() + forward.parameter * forward.parameter, 1.0, 1e-14);
    EXPECT_GT(forward.parameter, 0.0);
    PathTangent back = forward;
    back.band = -back.band;
    back.parameter = -back.parameter;
    EXPECT_LT(tangent(problem, point, workspace, &back).value().parameter, 0.0);  // keeps the sense of travel
  }
}

TEST(Path, ArcLengthCrossesTheFoldItself) {
  // At x = 1/sqrt 3 the band matrix is zero and the system at fixed parameter singular; along the arc it is
  // not.
  Cubic problem;
  PathWorkspace workspace;
  const double x = 1.0 / std::sqrt(3.0);
  const double p = x * x * x - x;
  const PathPoint fold{Eigen::VectorXd::Constant(1, x), Eigen::VectorXd::Constant(1, p), p};
  const PathTangent across{Eigen::VectorXd::Ones(1), Eigen::VectorXd::Zero(1), 0.0};
  for (const double step : {-0.2, 0.2}) {
    PathPoint next = fold;
    const SolveReport report = correct_along(problem, next, fold, across, step, workspace, 20);
    ASSERT_TRUE(report.usable()) << report.message;
    EXPECT_NEAR(next.band[0], x + step, 1e-12);
    EXPECT_NEAR(next.parameter, std::pow(x + step, 3) - x - step, 1e-12);
  }
  PathPoint stuck = fold;
  stuck.parameter -= 1e-3;  // beyond the fold there is no solution nearby
  EXPECT_FALSE(correct(problem, stuck, workspace, 3).usable());
}

TEST(Path, ArcLengthPassesBothFolds) {
  Cubic problem;
  PathWorkspace workspace;
  PathPoint point{Eigen::VectorXd::Constant(1, -1.5), Eigen::VectorXd::Constant(1, -1.875), -1.875};
  ASSERT_TRUE(correct(problem, point, workspace, 20).usable());
  PathTangent direction = tangent(problem, point, workspace, nullptr).value();
  double highest = -1e9;
  double lowest_after = 1e9;
  for (int k = 0; k < 200 && point.band[0] < 1.5; ++k) {
    PathPoint next = point;
    ASSERT_TRUE(correct_along(problem, next, point, direction, 0.05, workspace, 20).usable());
    // On the curve, whatever the branch.
    EXPECT_NEAR(std::pow(next.band[0], 3) - next.band[0], next.parameter, 1e-11);
    if (next.band[0] < 0.0) highest = std::max(highest, next.parameter);
    if (next.band[0] > 0.0) lowest_after = std::min(lowest_after, next.parameter);
    point = next;
    direction = tangent(problem, point, workspace, &direction).value();
  }
  EXPECT_GE(point.band[0], 1.5);
  const double fold = 2.0 / (3.0 * std::sqrt(3.0));
  EXPECT_NEAR(highest, fold, 5e-3);  // steps of 0.05 pass the top within 0.025: sqrt(3) 0.025^2
  EXPECT_NEAR(lowest_after, -fold, 5e-3);
}

}  // namespace
}  // namespace snare::numerics
