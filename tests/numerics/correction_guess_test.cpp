#include "numerics/correction_guess.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace snare::numerics {
namespace {

using Eigen::VectorXd;

/// t^3 and 2 t^3 - t: what is extrapolated from three states is corrected by a constant divided difference of
/// third order.
VectorXd cubics(double t) {
  return Eigen::Vector2d(t * t * t, 2.0 * t * t * t - t);
}

/// Of a step of order 2: the cubics less the parabola through three states.
VectorXd correction_of(double time, const std::vector<double>& states) {
  VectorXd extrapolated = VectorXd::Zero(2);
  const std::size_t n = states.size();
  for (std::size_t i = n - 3; i < n; ++i) {
    double weight = 1.0;
    for (std::size_t j = n - 3; j < n; ++j) {
      if (j != i) weight *= (time - states[j]) / (states[i] - states[j]);
    }
    extrapolated += weight * cubics(states[i]);
  }
  return cubics(time) - extrapolated;
}

class CorrectionGuesses : public ::testing::Test {
 protected:
  /// Tries a step of order 2 from the last state; what is guessed.
  VectorXd try_step(double time) {
    VectorXd guessed = VectorXd::Constant(2, 7.0);
    guess.begin(static_cast<long>(states.size()) - 1, states.back(), time, 2, guessed);
    if (states.size() >= 3) guess.end(correction_of(time, states), VectorXd::Constant(2, 3.0));
    return guessed;
  }
  void step(double time) {
    static_cast<void>(try_step(time));
    states.push_back(time);
  }
  void SetUp() override {
    for (const double time : {1.1, 1.25, 1.3, 1.5}) step(time);
  }

  CorrectionGuess guess;
  std::vector<double> states{1.0};
};

TEST_F(CorrectionGuesses, ACubicIsGuessedWhateverTheSteps) {
  EXPECT_NEAR((try_step(1.57) - correction_of(1.57, states)).norm(), 0.0, 1e-13);
}

TEST_F(CorrectionGuesses, AStepThatIsNotAcceptedIsNoState) {
  static_cast<void>(try_step(1.9));
  EXPECT_NEAR((try_step(1.6) - correction_of(1.6, states)).norm(), 0.0, 1e-13);
}

TEST_F(CorrectionGuesses, NothingIsGuessedAfterAStartOrOfAnotherOrder) {
  VectorXd guessed = VectorXd::Ones(2);
  guess.begin(5, 1.5, 1.6, 1, guessed);
  EXPECT_TRUE(guessed.isZero(0.0));
  guess.restart();
  guessed.setOnes();
  guess.begin(0, 1.5, 1.6, 2, guessed);
  EXPECT_TRUE(guessed.isZero(0.0));
}

TEST_F(CorrectionGuesses, AGuessThatLedAwayIsNotFollowedByAnother) {
  VectorXd guessed(2);
  const VectorXd weight = VectorXd::Ones(2);
  guess.begin(4, 1.5, 1.6, 2, guessed);
  ASSERT_FALSE(guessed.isZero(0.0));
  const VectorXd usual = guessed;
  guess.end(-usual, weight);
  guess.begin(5, 1.6, 1.7, 2, guessed);
  EXPECT_TRUE(guessed.isZero(0.0));
  // It would have been right: the next one is made again.
  const double ratio = (0.1 * 0.2 * 0.4) / (0.1 * 0.3 * 0.35);
  guess.end(-ratio * usual, weight);
  guess.begin(6, 1.7, 1.8, 2, guessed);
  EXPECT_FALSE(guessed.isZero(0.0));
}

}  // namespace
}  // namespace snare::numerics
