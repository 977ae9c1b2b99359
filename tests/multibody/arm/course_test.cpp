#include "multibody/arm/course.hpp"

#include "multibody/arm/drive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace snare::multibody {
namespace {

std::vector<Course> courses() {
  return {Course(0.3, 1.7, 0.5, 2.0), Course::at_rate(0.3, 1.7, 0.5, 0.8, 0.25),
          Course::at_rate(1.7, 0.3, 0.5, 0.8, 9.0),
          Course::through(0.3, 0.5, {0.0, 0.4, 1.0, 2.0}, {5.0, 5.2, 6.4, 6.4}),
          Course::smoothly_through(0.3, 0.5, {0.0, 0.4, 0.8, 1.4, 2.0}, {5.0, 5.0, 5.4, 5.2, 6.4})};
}

// The rate is the slope of the angle, the acceleration that of the rate, away from the breaks; both ends
// stand.
TEST(Course, RatesAreDerivatives) {
  for (const Course& c : courses()) {
    for (int i = 0; i < 70; ++i) {
      const double t = 0.013 + 0.0571 * i;
      bool near_break = false;
      for (const double b : c.breaks()) near_break = near_break || std::abs(t - b) < 1e-3;
      if (near_break) continue;
      constexpr double h = 1e-5;
      EXPECT_NEAR(c.rate(t), (c.angle(t + h) - c.angle(t - h)) / (2.0 * h), 1e-8);
      EXPECT_NEAR(c.acceleration(t), (c.rate(t + h) - c.rate(t - h)) / (2.0 * h), 1e-7);
    }
    for (const double b : c.breaks()) EXPECT_NEAR(c.rate(b - 1e-12), c.rate(b + 1e-12), 1e-9);
    EXPECT_EQ(c.angle(0.0), c.from);
    EXPECT_EQ(c.angle(100.0), c.to);
    EXPECT_EQ(c.rate(0.0), 0.0);
    EXPECT_EQ(c.rate(100.0), 0.0);
  }
}

// 1.4 rad at 0.8 rad/s with ramps of 0.25 s: 1.4/0.8 + 0.25 s. Where the way is shorter than both ramps they
// shrink.
TEST(Course, KeepsItsRate) {
  const Course c = Course::at_rate(0.3, 1.7, 0.5, 0.8, 0.25);
  EXPECT_NEAR(c.duration, 2.0, 1e-15);
  EXPECT_NEAR(c.rate(1.5), 0.8, 1e-15);
  EXPECT_NEAR(c.angle(0.75), 0.3 + 0.5 * 0.25 * 0.8, 1e-15);
  const Course brief = Course::at_rate(0.0, 0.1, 0.0, 0.8, 9.0);
  EXPECT_NEAR(brief.ramp, 0.125, 1e-15);
  EXPECT_NEAR(brief.rate(0.125), 0.8, 1e-12);
}

TEST(Course, StopsAtItsBreaksOnly) {
  const double none = std::numeric_limits<double>::infinity();
  for (const Course& c : courses()) {
    std::vector<double> breaks = c.breaks();
    std::sort(breaks.begin(), breaks.end());
    for (int i = -2; i < 60; ++i) {
      const double t = 0.05 * i;
      const auto next = std::upper_bound(breaks.begin(), breaks.end(), t);
      EXPECT_EQ(c.next_break(t), next == breaks.end() ? none : *next) << t;
    }
  }
  // Of a smooth table: begin, end, and where it leaves a rest. The last knot but one is none: there it turns.
  EXPECT_THAT(courses().back().breaks(), testing::UnorderedElementsAre(0.5, 2.5, 0.9));
}

// A smooth table keeps its acceleration at inner knots: it is a cubic there, on both sides.
TEST(Course, ASmoothTableHasNoJumpsInside) {
  std::vector<double> times, values;
  for (int i = 0; i <= 20; ++i) {
    times.push_back(0.1 * i);
    values.push_back(std::sin(3.0 * times.back()));
  }
  const Course c = Course::smoothly_through(0.0, 0.0, times, values);
  for (std::size_t k = 2; k + 2 < times.size(); ++k)
    EXPECT_NEAR(c.acceleration(times[k] - 1e-9), c.acceleration(times[k] + 1e-9), 1e-6) << times[k];
}

// Straight between its lines, held behind them, none before it begins.
TEST(Drive, GivesATorqueOverTime) {
  const Drive d = Drive::with_torque(2.0, {0.0, 1.0, 1.0, 3.0}, {1.0, 2.0, 5.0, 4.0});
  const double asked[][2] = {{1.9, 0.0}, {2.0, 1.0}, {2.5, 1.5}, {3.0, 5.0}, {4.0, 4.5}, {9.0, 4.0}};
  for (const auto& [time, torque] : asked) EXPECT_NEAR(d.demand(time, 7.0, 7.0), torque, 1e-15) << time;
  EXPECT_EQ(d.next_break(0.0), 2.0);
}

TEST(Course, ATableDoesNotOvershoot) {
  const Course c = Course::through(0.0, 0.0, {0.0, 1.0, 2.0, 3.0}, {0.0, 0.0, 1.0, 1.0});
  for (int i = 0; i <= 300; ++i) {
    const double t = 0.01 * i;
    EXPECT_GE(c.angle(t), -1e-15);
    EXPECT_LE(c.angle(t), 1.0 + 1e-15);
  }
}

}  // namespace
}  // namespace snare::multibody
