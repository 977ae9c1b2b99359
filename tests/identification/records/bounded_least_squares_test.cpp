#include "identification/records/bounded_least_squares.hpp"

#include <gtest/gtest.h>

#include <cmath>
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

// Rosenbrock's valley from its usual start: the minimum (1, 1), and with x <= 1/2 the bound and y = 1/4,
// where 1/4 is left.
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

// Two columns of a cosine of 0.99999 with each other, from the bound x >= 0 of one: exact after two steps,
// not after a thousand.
TEST(BoundedLeastSquares, NumbersThatHangTogetherDoNotCreep) {
  const Eigen::Matrix<double, 3, 2> A =
      (Eigen::Matrix<double, 3, 2>() << 1.0, 1.0, 0.0, 0.004, 1.0, 1.0).finished();
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

// Derivatives that promise a fall where there is none: steps are damped until nothing is left of them, and
// the search ends.
TEST(BoundedLeastSquares, EndsWhereNoDampingHelps) {
  BoundedProblem p;
  p.lower = Eigen::VectorXd::Constant(1, -infinity);
  p.upper = Eigen::VectorXd::Constant(1, infinity);
  p.residual = [](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return Eigen::VectorXd::Constant(1, 1.0 + std::abs(x[0]));
  };
  p.residual_jacobian = [](const Eigen::VectorXd&) -> Eigen::MatrixXd {
    return -Eigen::MatrixXd::Ones(1, 1);
  };
  const BoundedResult r = bounded_least_squares(p, Eigen::VectorXd::Zero(1), 50, 1e-30);
  EXPECT_EQ(r.end, BoundedEnd::converged);
  EXPECT_EQ(r.x[0], 0.0);
}

/// y = a exp(-b t) at twenty times, from a = 2, b = 1.3; counts how often derivatives are asked for.
struct Decay {
  BoundedProblem problem;
  int asked = 0;
  Decay() {
    problem.lower = Eigen::Vector2d::Constant(-infinity);
    problem.upper = Eigen::Vector2d::Constant(infinity);
    problem.residual = [](const Eigen::VectorXd& x) -> Eigen::VectorXd {
      const Eigen::ArrayXd t = Eigen::ArrayXd::LinSpaced(20, 0.0, 2.0);
      return x[0] * (-x[1] * t).exp() - 2.0 * (-1.3 * t).exp();
    };
    problem.residual_jacobian = [this](const Eigen::VectorXd& x) { return derivatives(x); };
  }
  Eigen::MatrixXd derivatives(const Eigen::VectorXd& x) {
    ++asked;
    const Eigen::ArrayXd t = Eigen::ArrayXd::LinSpaced(20, 0.0, 2.0);
    Eigen::MatrixXd J(20, 2);
    J.col(0) = (-x[1] * t).exp();
    J.col(1) = -x[0] * t * (-x[1] * t).exp();
    return J;
  }
};

// Corrected derivatives lead as far as new ones: several steps an asking, and none at a start where they are
// known.
TEST(BoundedLeastSquares, AsksForDerivativesNowAndThen) {
  Decay decay;
  const Eigen::Vector2d start(1.6, 1.0);
  const BoundedResult r = bounded_least_squares(decay.problem, start, 50, 1e-10);
  EXPECT_EQ(r.end, BoundedEnd::converged);
  EXPECT_NEAR(r.x[0], 2.0, 1e-6);
  EXPECT_NEAR(r.x[1], 1.3, 1e-6);
  EXPECT_LT(2 * decay.asked, r.iterations + 3);
  Decay known;
  known.problem.first_jacobian = known.derivatives(start);
  known.asked = 0;
  const BoundedResult again = bounded_least_squares(known.problem, start, 50, 1e-10);
  EXPECT_NEAR((again.x - r.x).norm(), 0.0, 1e-6);
  EXPECT_EQ(known.asked, decay.asked - 1);
}

// Broyden's correction: J s is what the step has changed, and a reading that does not hang on a number still
// does not.
TEST(BoundedLeastSquares, CorrectsDerivativesByTheStepItTook) {
  BoundedProblem p;
  p.lower = Eigen::Vector2d::Constant(-infinity);
  p.upper = Eigen::Vector2d::Constant(infinity);
  p.residual = [](const Eigen::VectorXd& x) -> Eigen::VectorXd {
    return Eigen::Vector3d(std::sinh(x[0]) - 1.0, std::exp(x[1]) - 2.0, x[0] * x[1] - 0.5);
  };
  p.residual_jacobian = [](const Eigen::VectorXd& x) -> Eigen::MatrixXd {
    Eigen::Matrix<double, 3, 2> J;
    J << std::cosh(x[0]), 0.0, 0.0, std::exp(x[1]), x[1], x[0];
    return J;
  };
  const Eigen::Vector2d start(0.5, 0.4);
  const BoundedResult one = bounded_least_squares(p, start, 1, 1e-12);
  ASSERT_EQ(one.end, BoundedEnd::iteration_limit);
  ASSERT_EQ(one.jacobian.cols(), 2);
  const Eigen::VectorXd step = one.x - start;
  EXPECT_LT((one.jacobian * step - (p.residual(one.x) - p.residual(start))).norm(), 1e-12);
  EXPECT_EQ(one.jacobian(0, 1), 0.0);
  EXPECT_EQ(one.jacobian(1, 0), 0.0);
}

// Numbers that noise would move further than what is still promised are taken a last step and left.
TEST(BoundedLeastSquares, EndsWhereNoiseMovesMore) {
  Decay exact, by_chance;
  by_chance.problem.by_chance = 0.1;
  const auto noisy = [](const BoundedProblem& p) {
    BoundedProblem with = p;
    with.residual = [residual = p.residual](const Eigen::VectorXd& x) -> Eigen::VectorXd {
      Eigen::VectorXd r = residual(x);
      for (Eigen::Index i = 0; i < r.size(); ++i) r[i] += i % 2 == 0 ? 0.05 : -0.05;
      return r;
    };
    return with;
  };
  const Eigen::Vector2d start(1.9, 1.25);
  const BoundedResult fine = bounded_least_squares(noisy(exact.problem), start, 50, 1e-12);
  const BoundedResult coarse = bounded_least_squares(noisy(by_chance.problem), start, 50, 1e-12);
  EXPECT_EQ(coarse.end, BoundedEnd::converged);
  EXPECT_LT(by_chance.asked, exact.asked);
  EXPECT_LT(coarse.chi2, fine.chi2 * (1.0 + 0.1 * by_chance.problem.by_chance));
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
