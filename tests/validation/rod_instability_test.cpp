#include "validation/rod_instability.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace snare::validation {
namespace {

using std::numbers::pi;

HelicalBuckling standard_case() {
  return helical_buckling(1.345, 0.789, 100.0, 3.0, 27.0 * 2.0 * pi);
}

TEST(HelicalBuckling, StandardCase) {
  // Parameters and solution in the examples of PyElastica (HelicalBucklingCase), after van der Heijden and
  // Thompson 2000; its constants come from a symbolic solver and are printed to 17 digits.
  const HelicalBuckling rod = standard_case();
  EXPECT_NEAR(rod.moment_scaled / 98.541496171190744, 1.0, 1e-13);
  EXPECT_NEAR(rod.tension_scaled / 2.900993205792131e3, 1.0, 1e-13);
  EXPECT_NEAR(rod.largest_angle,
              std::acos(rod.moment_scaled * rod.moment_scaled / (2.0 * rod.tension_scaled) - 1.0), 1e-13);
}

TEST(HelicalBuckling, SatisfiesItsTwoConditions) {
  const HelicalBuckling rod = standard_case();
  const double x = rod.moment_scaled;
  const double y = rod.tension_scaled;
  // Shortening 3 of 100 and 27 turns, to rounding of numbers of one and of a hundred.
  EXPECT_NEAR(std::sqrt(16.0 / y * (1.0 - x * x / (4.0 * y))), 0.03, 1e-14);
  EXPECT_NEAR(x * 1.345 / 0.789 + 4.0 * std::acos(x / (2.0 * std::sqrt(y))), 54.0 * pi, 1e-11);
}

TEST(HelicalBuckling, EnvelopeGivesTheShortening) {
  // int (1 - cos phi) dS = D: cos phi = cos phi_0 + (1 - cos phi_0) envelope.
  const HelicalBuckling rod = standard_case();
  const double cosine = std::cos(rod.largest_angle);
  const int steps = 2000;
  double shortening = 0.0;
  for (int i = 0; i < steps; ++i) {
    shortening += (1.0 - cosine) * (1.0 - rod.envelope(100.0 * (i + 0.5) / steps)) * 100.0 / steps;
  }
  // Midpoint rule on a smooth function that dies out: exponentially exact; tail cut off 4 exp(-21.8) = 1e-9.
  EXPECT_NEAR(shortening, 3.0, 1e-7);
  EXPECT_EQ(rod.envelope(50.0), 0.0);
  EXPECT_NEAR(rod.envelope(0.0), 1.0, 1e-8);
}

TEST(HelicalBuckling, TooMuchRotationIsNotANumber) {
  EXPECT_TRUE(std::isnan(helical_buckling(1.345, 0.789, 100.0, 3.0, 300.0).moment));
}

TEST(CriticalTorque, ClampedWithoutTension) {
  // 2 x 4.493409 (tan x = x), Love 1927, sec. 272.
  EXPECT_NEAR(critical_torque_clamped(1.0, 0.0, 1.0), 8.986818915818, 1e-11);
  EXPECT_NEAR(critical_torque_clamped(3.0, 0.0, 2.0), 1.5 * 8.986818915818, 1e-11);
  // Continuous through zero tension, slope about 0.147.
  EXPECT_NEAR(critical_torque_clamped(1.0, 1e-3, 1.0) - critical_torque_clamped(1.0, -1e-3, 1.0), 2.95e-4,
              1e-5);
}

TEST(CriticalTorque, ClampedVanishesAtTheColumnsLoad) {
  const double load = 4.0 * pi * pi;
  const double near = critical_torque_clamped(1.0, -load * (1.0 - 1e-6), 1.0);
  const double farther = critical_torque_clamped(1.0, -load * (1.0 - 4e-6), 1.0);
  EXPECT_NEAR(farther / near, 2.0, 1e-4);  // M grows as the root of the distance
}

TEST(CriticalTorque, LongRodUnderTension) {
  for (const double tension : {1e4, 1e6}) {
    const double infinite = 2.0 * std::sqrt(tension);
    const double clamped = critical_torque_clamped(1.0, tension, 1.0);
    EXPECT_GT(clamped, infinite);
    EXPECT_NEAR(clamped / infinite, 1.0, 6.0 / tension);  // (pi/L)^2/(2 T) = 5/T
    EXPECT_NEAR(critical_torque_pinned(1.0, tension, 1.0) / infinite, 1.0, 6.0 / tension);
  }
}

TEST(CriticalTorque, ClampedMakesTheBoundaryConditionsSingular) {
  // w = A (e^{ipx} - 1 - ipx) + C (e^{iqx} - 1 - iqx): determinant of w(1), w'(1).
  using Complex = std::complex<double>;
  const Complex i(0.0, 1.0);
  const auto determinant = [&](double moment, double tension) {
    const double root = std::sqrt(moment * moment / 4.0 - tension);
    const double p = moment / 2.0 + root;
    const double q = moment / 2.0 - root;
    const Complex ep = std::exp(i * p);
    const Complex eq = std::exp(i * q);
    return std::abs((ep - 1.0 - i * p) * i * q * (eq - 1.0) - (eq - 1.0 - i * q) * i * p * (ep - 1.0));
  };
  for (const double tension : {-30.0, -5.0, 2.0, 30.0, 400.0}) {
    const double moment = critical_torque_clamped(1.0, tension, 1.0);
    // Root to rounding; the determinant's size away from it is of order 10 to 1e4.
    EXPECT_LT(determinant(moment, tension), 1e-9) << tension;
    EXPECT_GT(determinant(1.02 * moment, tension), 1e-3) << tension;
  }
}

TEST(CriticalTwist, Ring) {
  EXPECT_NEAR(critical_ring_twist(1.0, 1.0), 10.8828, 5e-5);  // 2 pi sqrt 3 (Zajac 1962)
}

TEST(LateralBuckling, NarrowBeams) {
  EXPECT_NEAR(lateral_buckling_load(1.0, 1.0, 1.0), 4.013, 5e-4);  // Timoshenko and Gere 1961, sec. 6.3
  EXPECT_NEAR(lateral_buckling_load(4.0, 9.0, 2.0), 6.0 * 4.0126 / 4.0, 1e-4);
  EXPECT_NEAR(lateral_buckling_moment(4.0, 9.0, 2.0), 3.0 * pi, 1e-13);
  // Independent check of the root: J_{-1/4} = J_{3/4}-type recurrence by the standard library,
  // J_{-nu}(x) = J_nu cos(nu pi) - Y_nu sin(nu pi).
  const double x = 0.5 * lateral_buckling_load(1.0, 1.0, 1.0);
  const double nu = 0.25;
  EXPECT_NEAR(std::cyl_bessel_j(nu, x) * std::cos(nu * pi) - std::cyl_neumann(nu, x) * std::sin(nu * pi), 0.0,
              1e-12);
}

}  // namespace
}  // namespace snare::validation
