#include "identification/records/bounded_least_squares.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace snare::identification {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

BoundedProblem rosenbrock(double upper) {
  BoundedProblem p;
  p.lower = Eigen::Vector2d::Constant(-infinity);
  p.upper = Eigen::Vector2d(upper, infinity);
  p.residual = [](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return Eigen::Vector2d(10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]);
  };
  p.residual_jacobian = [](const Eigen::VectorXd& x) -> Eigen::MatrixXd {
    return (Eigen::Matrix2d() << -20.0 * x[0], 10.0, -1.0, 0.0).finished();
  };
  return p;
}

// Rosenbrock's valley from its usual start: the minimum (1, 1), and with x <= 1/2 the bound and y = 1/4, where 1/4 is left.
TEST(BoundedLeastSquares, FindsTheEndOfAValleyAndOfABound) {
  const Eigen::Vector2d start(-1.2, 1.0);
  const BoundedResult open = bounded_least_squares(rosenbrock(infinity), start, 100, 1e-12);
  EXPECT_EQ(open.end, BoundedEnd::converged);
  EXPECT_LT((open.x - Eigen::Vector2d(1.0, 1.0)).norm(), 1e-6);
  const BoundedResult closed = bounded_least_squares(rosenbrock(0.5), start, 100, 1e-12);
  EXPECT_EQ(closed.end, BoundedEnd::converged);
  EXPECT_EQ(closed.x[0], 0.5);
  EXPECT_NEAR(closed.x[1], 0.25, 1e-8);
  EXPECT_NEAR(closed.chi2, 0.25, 1e-12);
}

// Two columns of a cosine of 0.99999 with each other, from the bound x >= 0 of one: exact after two steps, not after a thousand.
TEST(BoundedLeastSquares, NumbersThatHangTogetherDoNotCreep) {
  const Eigen::Matrix<double, 3, 2> A = (Eigen::Matrix<double, 3, 2>() << 1.0, 1.0, 0.0, 0.004, 1.0, 1.0).finished();
  const Eigen::Vector3d b = A * Eigen::Vector2d(3.0, -2.0);
  BoundedProblem p;
  p.lower = Eigen::Vector2d(0.0, -infinity);
  p.upper = Eigen::Vector2d::Constant(infinity);
  p.residual = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd { return A * x - b; };
  p.residual_jacobian = [&](const Eigen::VectorXd&) -> Eigen::MatrixXd { return A; };
  const BoundedResult r = bounded_least_squares(p, Eigen::Vector2d(0.0, 1.0), 4, 1e-9);
  EXPECT_NEAR(r.x[0], 3.0, 1e-4);
  EXPECT_NEAR(r.x[1], -2.0, 1e-4);
}

TEST(BoundedLeastSquares, SaysWhyItEnds) {
  BoundedProblem p = rosenbrock(infinity);
  EXPECT_EQ(bounded_least_squares(p, Eigen::Vector2d(-1.2, 1.0), 2, 1e-12).end, BoundedEnd::iteration_limit);
  p.progress = [](int iteration, double) { return iteration < 1; };
  EXPECT_EQ(bounded_least_squares(p, Eigen::Vector2d(-1.2, 1.0), 9, 1e-12).end, BoundedEnd::stopped);
  p.residual = [](const Eigen::VectorXd&) { return Eigen::VectorXd(); };
  EXPECT_EQ(bounded_least_squares(p, Eigen::Vector2d(-1.2, 1.0), 9, 1e-12).end, BoundedEnd::no_start);
}

}  // namespace
}  // namespace snare::identification
