#include "multibody/arm/course.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace snare::multibody {
namespace {

std::vector<Course> courses() {
  return {Course(0.3, 1.7, 0.5, 2.0), Course::at_rate(0.3, 1.7, 0.5, 0.8, 0.25),
          Course::at_rate(1.7, 0.3, 0.5, 0.8, 9.0),
          Course::through(0.3, 0.5, {0.0, 0.4, 1.0, 2.0}, {5.0, 5.2, 6.4, 6.4})};
}

// The rate is the slope of the angle, the acceleration that of the rate, away from the breaks; both ends stand.
TEST(Course, RatesAreDerivatives) {
  for (const Course& c : courses()) {
    for (double t = 0.013; t < 4.0; t += 0.0571) {
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

// 1.4 rad at 0.8 rad/s with ramps of 0.25 s: 1.4/0.8 + 0.25 s. Where the way is shorter than both ramps they shrink.
TEST(Course, KeepsItsRate) {
  const Course c = Course::at_rate(0.3, 1.7, 0.5, 0.8, 0.25);
  EXPECT_NEAR(c.duration, 2.0, 1e-15);
  EXPECT_NEAR(c.rate(1.5), 0.8, 1e-15);
  EXPECT_NEAR(c.angle(0.75), 0.3 + 0.5 * 0.25 * 0.8, 1e-15);
  const Course brief = Course::at_rate(0.0, 0.1, 0.0, 0.8, 9.0);
  EXPECT_NEAR(brief.ramp, 0.125, 1e-15);
  EXPECT_NEAR(brief.rate(0.125), 0.8, 1e-12);
}

TEST(Course, ATableDoesNotOvershoot) {
  const Course c = Course::through(0.0, 0.0, {0.0, 1.0, 2.0, 3.0}, {0.0, 0.0, 1.0, 1.0});
  for (double t = 0.0; t <= 3.0; t += 0.01) {
    EXPECT_GE(c.angle(t), -1e-15);
    EXPECT_LE(c.angle(t), 1.0 + 1e-15);
  }
}

}  // namespace
}  // namespace snare::multibody
