#include "numerics/quasi_newton.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <cmath>
#include <functional>

namespace snare::numerics {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

using Equations = std::function<VectorXd(const VectorXd& x)>;

/// x after some corrections by the matrix A from x = 0, each corrected by what the ones before have shown, or
/// as it is.
VectorXd solved(const Equations& F, const MatrixXd& A, const VectorXd& weight, int corrections,
                bool corrected) {
  const Eigen::PartialPivLU<MatrixXd> lu(A);
  QuasiNewton method(A.rows(), 12);
  VectorXd x = VectorXd::Zero(A.rows());
  for (int k = 0; k < corrections; ++k) {
    VectorXd step = -lu.solve(F(x));
    if (corrected) method.update(step, weight);
    x += step;
  }
  return x;
}

MatrixXd five() {
  MatrixXd A(5, 5);
  A << 4, 1, 0, 0, 1, 1, 5, 1, 0, 0, 0, 1, 6, 1, 0, 0, 0, 1, 5, 1, 1, 0, 0, 1, 4;
  return A;
}

const VectorXd right = VectorXd::LinSpaced(5, 1.0, 3.0);
const VectorXd weights = VectorXd::LinSpaced(5, 1.0, 100.0);

// With A_0 = A + u v^T the error continues along one direction: two corrections show how far, the third has
// it.
TEST(QuasiNewton, ARankOfOneIsCorrectedAtOnce) {
  const MatrixXd A = five();
  const Equations F = [&](const VectorXd& x) { return VectorXd(A * x - right); };
  const VectorXd u = VectorXd::LinSpaced(5, 0.5, 1.0), v = VectorXd::LinSpaced(5, -1.0, 2.0);
  const MatrixXd wrong = A + 2.0 * u * v.transpose();
  const VectorXd exact = A.partialPivLu().solve(right);
  EXPECT_LT((solved(F, wrong, weights, 3, true) - exact).norm(), 1e-13);
  EXPECT_GT((solved(F, wrong, weights, 3, false) - exact).norm(), 1e-2);
}

// d^(3/2) from a matrix of half the depth: see (M.8). By the secant method's order the digits that are right
// become more by 1.6 each time.
TEST(QuasiNewton, ATouchThatStiffensConvergesAsASecant) {
  const Equations F = [](const VectorXd& x) {
    return VectorXd(VectorXd::Constant(1, std::pow(0.5 + x[0], 1.5) - std::pow(0.9, 1.5)));
  };
  const MatrixXd stiffness = MatrixXd::Constant(1, 1, 1.5 * std::sqrt(0.5));
  const VectorXd one = VectorXd::Ones(1);
  EXPECT_NEAR(solved(F, stiffness, one, 5, true)[0], 0.4, 1e-9);
  EXPECT_GT(std::abs(solved(F, stiffness, one, 5, false)[0] - 0.4), 1e-5);
}

// What is linear, as momentum and rates of places, holds to round-off whatever the others do.
TEST(QuasiNewton, LinearRowsHoldFromTheFirstCorrectionOn) {
  const MatrixXd A = five();
  const Equations F = [&](const VectorXd& x) {
    VectorXd f = A * x - right;
    f[0] += std::pow(x[0], 3);
    f[1] += x[1] * x[2];
    return f;
  };
  for (int corrections = 1; corrections <= 6; ++corrections) {
    const VectorXd f = F(solved(F, A, weights, corrections, true));
    EXPECT_LT(f.tail(3).cwiseAbs().maxCoeff(), 1e-14) << corrections;
  }
  EXPECT_LT(F(solved(F, A, weights, 6, true)).cwiseAbs().maxCoeff(), 1e-7);
}

TEST(QuasiNewton, ARestartForgetsAndNothingIsLeftOfAZero) {
  QuasiNewton method(2, 3);
  const VectorXd one = VectorXd::Ones(2);
  VectorXd step(2);
  step << 1.0, 0.0;
  method.update(step, one);
  method.restart();
  step << 0.5, 0.0;
  method.update(step, one);
  EXPECT_EQ(step[0], 0.5);
  step.setZero();
  method.update(step, one);
  EXPECT_EQ(step.norm(), 0.0);
  step << 0.25, 0.0;
  method.update(step, one);
  EXPECT_TRUE(step.allFinite());
}

// A correction that repeats most of the one before says that it does not converge, not how far to go.
TEST(QuasiNewton, NoCorrectionIsPursuedBeyondThreeOfItself) {
  QuasiNewton method(1, 3);
  const VectorXd one = VectorXd::Ones(1);
  VectorXd step = VectorXd::Ones(1);
  method.update(step, one);
  for (const double share : {0.69, 0.71, 1.0, 3.0}) {
    method.restart();
    step[0] = 1.0;
    method.update(step, one);
    step[0] = share;
    method.update(step, one);
    EXPECT_NEAR(step[0], share < 0.7 ? share / (1.0 - share) : share, 1e-12) << share;
  }
}

}  // namespace
}  // namespace snare::numerics
