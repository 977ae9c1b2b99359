#include "coupling/dynamics/run/force_record.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace snare::coupling {
namespace {

ForceRecord cubes(std::array<double, 5> times) {
  ForceRecord record;
  for (const double t : times) record.add(t, Eigen::Vector2d(t * t * t, 1.0));
  return record;
}

TEST(ForceRecord, IsAPolynomialThroughTheLastStates) {
  const ForceRecord record = cubes({0.0, 0.5, 0.6, 0.9, 1.0});
  for (const double t : {0.92, 0.97, 1.0}) {
    EXPECT_NEAR(record.at(t, 0, 4), t * t * t, 1e-15);
    EXPECT_NEAR(record.at(t, 0, 100), t * t * t, 1e-15);
    // The parabola through 0.6, 0.9, 1.0 and the line through 0.9, 1.0 miss the cube by the products of the
    // distances.
    EXPECT_NEAR(record.at(t, 0, 3) - t * t * t, -(t - 0.6) * (t - 0.9) * (t - 1.0), 1e-15);
    EXPECT_NEAR(record.at(t, 0, 2) - t * t * t, -(t - 0.9) * (t - 1.0) * (t + 1.9), 1e-15);
    EXPECT_NEAR(record.at(t, 1, 4), 1.0, 1e-15);
  }
}

TEST(ForceRecord, TakesAsManyStatesAsThereAre) {
  ForceRecord record;
  record.add(0.0, Eigen::VectorXd::Constant(1, 2.0));
  record.add(0.1, Eigen::VectorXd::Constant(1, 4.0));
  EXPECT_NEAR(record.at(0.05, 0, 4), 3.0, 1e-15);
}

}  // namespace
}  // namespace snare::coupling
