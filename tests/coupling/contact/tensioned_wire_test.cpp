#include "coupling/contact/tensioned_wire.hpp"
#include "validation/closed_forms.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace snare::coupling {
namespace {

// Five digits are printed in the reference: half of the last.
TEST(TensionedWire, MatchesPublishedChecks) {
  const double ei = 0.04796;
  const double expected[3][2] = {{0.040, 7407.2}, {0.065, 3638.9}, {0.090, 3083.8}};
  for (const auto& [s, k] : expected)
    EXPECT_NEAR(tensioned_stiffness(ei, 50.0, 0.175, s).value, k, 0.5e-4 * k) << s;
}

// Both are closed forms in double precision; the other one loses digits as the wire becomes a string.
TEST(TensionedWire, AgreesWithTheOtherDerivation) {
  for (const double t : {0.5, 5.0, 50.0, 500.0}) {
    const double other = validation::tensioned_clamped_stiffness(0.01, t, 0.2, 0.07);
    EXPECT_NEAR(tensioned_stiffness(0.01, t, 0.2, 0.07).value / other, 1.0, 1e-9) << t;
  }
}

TEST(TensionedWire, HasBeamAndStringAsLimits) {
  const double l = 0.175;
  const double s = 0.065;
  const double beam = 3.0 * 0.04 * l * l * l / (std::pow(s, 3) * std::pow(l - s, 3));
  EXPECT_NEAR(tensioned_stiffness(0.04, 0.0, l, s).value / beam, 1.0,
              1e-12);  // mean over a circle, to round-off
  // Boundary layers of length sqrt(EI/T) take 3e-5 of the span at three places.
  const double string = 100.0 * l / (s * (l - s));
  EXPECT_NEAR(tensioned_stiffness(1e-9, 100.0, l, s).value / string, 1.0, 5e-4);
}

// Central differences: truncation 1e-8, round-off 1e-16/1e-4.
TEST(TensionedWire, DerivativeMatchesDifferences) {
  for (const double t : {-20.0, 0.0, 0.3, 3.0, 60.0, 4000.0}) {
    const double h = 1e-4 * (1.0 + std::abs(t));
    const double difference = (tensioned_stiffness(0.04, t + h, 0.175, 0.05).value -
                               tensioned_stiffness(0.04, t - h, 0.175, 0.05).value) /
                              (2.0 * h);
    EXPECT_NEAR(tensioned_stiffness(0.04, t, 0.175, 0.05).by_tension / difference, 1.0, 1e-6) << t;
  }
}

}  // namespace
}  // namespace snare::coupling
