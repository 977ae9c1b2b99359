#include "validation/elastica.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace snare::validation {
namespace {

using std::numbers::pi;
const double kSolid = 193e9 * pi * std::pow(1.5e-3, 4) / 64.0;  // EI of 1.5 mm SUS-304 [N m^2]

TEST(Elastica, DeclaredWireBuckled) {
  const BuckledElastica wire = clamped_elastica(kSolid, 0.180, 0.175);
  EXPECT_NEAR(wire.compression, 59.2641, 5e-5);  // digits as given, computed apart from this code
  EXPECT_NEAR(wire.height, 18.9321e-3, 5e-8);
}

TEST(Elastica, SmallSlackTendsToTheBucklingLoad) {
  // P/Pcr = 1 + slack/(2 L) + ..., height = 2/pi sqrt(slack span) to first order.
  const double slack = 1e-6;
  const BuckledElastica clamped = clamped_elastica(1.0, 1.0, 1.0 - slack);
  EXPECT_NEAR(clamped.compression / (4.0 * pi * pi) - 1.0, 0.5 * slack, 1e-9);  // rounding 1e-16/slack
  EXPECT_NEAR(clamped.height / (2.0 / pi * std::sqrt(slack)), 1.0,
              1e-5);  // of first order in the slack, times ten
  const BuckledElastica pinned = pinned_elastica(1.0, 1.0, 1.0 - slack);
  EXPECT_NEAR(4.0 * pinned.compression / clamped.compression, 1.0, 1e-14);
  EXPECT_EQ(pinned.height, clamped.height);  // half the wave number over twice the waves
}

TEST(Elastica, CrownMomentBalances) {
  // Half the clamped wire: the moments at crown and clamp are equal and opposite, P height = 2 M.
  const BuckledElastica wire = clamped_elastica(2.0, 1.0, 0.7);
  // Rounding of the elliptic integrals: some hundred units.
  EXPECT_NEAR(2.0 * wire.crown_moment / (wire.compression * wire.height), 1.0, 1e-13);
  const BuckledElastica pinned = pinned_elastica(2.0, 1.0, 0.7);
  EXPECT_NEAR(pinned.crown_moment / (pinned.compression * pinned.height), 1.0, 1e-13);
}

TEST(Elastica, PinnedRodWithEndSlopeOfSixtyDegrees) {
  // Timoshenko and Gere 1961, table 2-4, of a column clamped at the foot (half of this rod), 60 deg: P/Pcr =
  // 1.152, reach 0.741 and offset 0.593 of its length.  k = sin 30 deg.
  const double span = 2.0 * std::comp_ellint_2(0.5) / std::comp_ellint_1(0.5) - 1.0;
  const BuckledElastica rod = pinned_elastica(1.0, 1.0, span);
  EXPECT_NEAR(rod.modulus, 0.5, 1e-13);
  EXPECT_NEAR(rod.compression / (pi * pi), 1.152, 1e-3);  // printed digits
  EXPECT_NEAR(span, 0.741, 1e-3);
  EXPECT_NEAR(2.0 * rod.height, 0.593, 1e-3);
}

TEST(Elastica, CantileverTable) {
  // Mattiasson 1981, table 1, five digits.
  const CantileverTip one = cantilever_tip(1.0, 1.0, 1.0);
  EXPECT_NEAR(one.angle, 0.46135, 5e-6);
  EXPECT_NEAR(one.deflection, 0.30172, 5e-6);
  EXPECT_NEAR(one.shortening, 0.05643, 5e-6);
  const CantileverTip ten = cantilever_tip(1.0, 1.0, 10.0);
  EXPECT_NEAR(ten.angle, 1.43029, 5e-6);
  EXPECT_NEAR(ten.deflection, 0.81061, 5e-6);
  EXPECT_NEAR(ten.shortening, 0.55500, 5e-6);
}

TEST(Elastica, CantileverTendsToTheLinearBeam) {
  const CantileverTip tip = cantilever_tip(3.0, 2.0, 3e-3);
  const double linear = 3e-3 * 8.0 / (3.0 * 3.0);
  // alpha = 4e-3: relative corrections of order alpha^2 = 1.6e-5 times 0.06, rounding 1e-16/alpha^1.5.
  EXPECT_NEAR(tip.deflection / linear, 1.0, 1e-5);
}

TEST(Elastica, CantileverUnderMomentIsACircle) {
  const CantileverTip full = cantilever_under_moment(1.0, 1.0, 2.0 * pi);
  // Rounding of lengths of one.
  EXPECT_NEAR(full.deflection, 0.0, 1e-15);
  EXPECT_NEAR(full.shortening, 1.0, 1e-15);
  const CantileverTip half = cantilever_under_moment(2.0, 3.0, 2.0 * pi / 3.0);
  EXPECT_NEAR(half.deflection, 6.0 / pi, 1e-14);  // diameter of the half circle
}

}  // namespace
}  // namespace snare::validation
