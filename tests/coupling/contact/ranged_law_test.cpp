#include "coupling/contact/ranged_law.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

namespace snare::coupling {
namespace {

RangedLaw quadratic(double a, double b, double c, double end) {
  return {quadratic_law()->with(Eigen::Vector3d(a, b, c)), end};
}

// Never negative, linear beyond the end and never falling there; the energy is the integral of the force.
// Quadratics that begin below 0, dip below 0, or fall at the end.
TEST(RangedLaw, IsNeverNegativeAndLinearBeyondItsTravel) {
  for (const auto& [a, b, c] : std::vector<std::array<double, 3>>{{5e5, 1e3, -1.0},
                                                                  {5e5, -1e3, 0.3},
                                                                  {-5e5, 1e3, 0.0},
                                                                  {-5e5, 1e3, -1.0},
                                                                  {0.0, -1e3, 2.0},
                                                                  {5e5, 1e3, 1.0}}) {
    const double end = 4e-3;
    const RangedLaw law = quadratic(a, b, c, end);
    double integral = 0.0;
    constexpr int steps = 20000;
    const double h = 3.0 * end / steps;
    for (int i = 0; i < steps; ++i) {
      const double d = (i + 0.5) * h;
      const double expected =
          d <= end ? std::max(0.0, (a * d + b) * d + c)
                   : std::max(0.0, (a * end + b) * end + c) + std::max(0.0, 2.0 * a * end + b) * (d - end);
      ASSERT_NEAR(law.force(d), expected, 1e-12 * (1.0 + expected));
      ASSERT_GE(law.force(d), 0.0);
      if (d > end) ASSERT_GE(law.stiffness(d), 0.0);
      ASSERT_EQ(law.curvature(d), d <= end && (a * d + b) * d + c >= 0.0 ? 2.0 * a : 0.0);
      integral += h * law.force(d);
    }
    // The midpoint rule: h^2/24 (F'(end) - F'(0)) 1e-10 of it, and h at kinks.
    EXPECT_NEAR(law.energy(3.0 * end), integral, 1e-6 * (1e-3 + integral));
  }
}

// Of a law that is negative nowhere the numbers within the travel are its own, to the last bit.
TEST(RangedLaw, ChangesNothingWithinItsTravel) {
  const SpringLawPointer power = power_law()->with(Eigen::Vector2d(6e4, 1.5));
  const RangedLaw law(power, 4e-3);
  for (const double d : {0.0, 1e-3, 4e-3}) {
    EXPECT_EQ(law.force(d), power->force(d));
    EXPECT_EQ(law.stiffness(d), power->stiffness(d));
    EXPECT_EQ(law.curvature(d), power->curvature(d));
    EXPECT_EQ(law.energy(d), power->energy(d));
  }
}

}  // namespace
}  // namespace snare::coupling
