#include "study/benchmark_score.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace snare::study {
namespace {

/// size sin(x + phase) from 0 to pi in n parts.
Track half_wave(double size, double phase, int n) {
  Track t;
  for (int k = 0; k <= n; ++k) {
    t.x.push_back(std::numbers::pi * k / n);
    t.q.push_back(size * std::sin(t.x.back() + phase));
  }
  return t;
}

TEST(BenchmarkScore, OfTheReferenceItselfIsNothing) {
  const Track t = half_wave(3.0, 0.0, 100);
  const TrackScore s = score_of(t, t, 1.0);
  EXPECT_EQ(s.peak, 0.0);
  EXPECT_EQ(s.integral, 0.0);
  EXPECT_EQ(s.rms, 0.0);
  EXPECT_EQ(s.touch, 0.0);
  EXPECT_EQ(s.covered, 1.0);
}

// Of 1.1 sin x on rows of its own beside sin x: a tenth of everything; it reaches 1/2 at asin(1/2.2).
TEST(BenchmarkScore, IsTheClosedFormOfAWaveOfAnotherSize) {
  const TrackScore s = score_of(half_wave(1.1, 0.0, 700), half_wave(1.0, 0.0, 1000), 0.5);
  EXPECT_NEAR(s.peak, 0.1, 1e-5);
  EXPECT_NEAR(s.integral, 0.1, 1e-5);
  EXPECT_NEAR(s.rms, 0.1, 1e-5);
  EXPECT_NEAR(*s.touch, std::asin(0.5 / 1.1) - std::asin(0.5), 1e-5);
}

// sin(x + e) - sin x = 2 sin(e/2) cos(x + e/2), whose square has the mean 2 sin^2(e/2) over half a turn, that
// of sin^2 is 1/2.
TEST(BenchmarkScore, IsTheClosedFormOfAWaveThatIsLate) {
  constexpr double late = -0.05;
  const TrackScore s = score_of(half_wave(1.0, late, 2000), half_wave(1.0, 0.0, 2000), 0.5);
  EXPECT_NEAR(s.rms, 2.0 * std::abs(std::sin(0.5 * late)), 1e-5);
  EXPECT_NEAR(s.integral, std::cos(late) - 1.0, 1e-5);
  EXPECT_NEAR(*s.touch, -late, 1e-5);
}

TEST(BenchmarkScore, SaysWhatItDoesNotCoverAndWhoDoesNotTouch) {
  Track half = half_wave(1.0, 0.0, 1000);
  half.x.resize(501);
  half.q.resize(501);
  const TrackScore s = score_of(half, half_wave(1.0, 0.0, 1000), 0.5);
  EXPECT_NEAR(s.covered, 0.5, 1e-12);
  EXPECT_EQ(s.rms, 0.0);
  const TrackScore weak = score_of(half_wave(0.4, 0.0, 100), half_wave(1.0, 0.0, 100), 0.5);
  EXPECT_FALSE(weak.same_touch);
  EXPECT_FALSE(weak.touch.has_value());
  EXPECT_FALSE(score_of(half_wave(1.0, 0.0, 9), half_wave(1.0, 0.0, 9), std::nullopt).touch.has_value());
}

TEST(BenchmarkScore, RefusesWhatIsNoHistory) {
  const Track good = half_wave(1.0, 0.0, 10);
  EXPECT_THROW(static_cast<void>(score_of({{0.0}, {1.0}}, good, {})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(score_of({{0.0, 2.0, 1.0}, {1.0, 1.0, 1.0}}, good, {})),
               std::invalid_argument);
  EXPECT_THROW(static_cast<void>(score_of({{10.0, 11.0}, {1.0, 1.0}}, good, {})), std::invalid_argument);
}

}  // namespace
}  // namespace snare::study
