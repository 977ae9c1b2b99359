#include "wire/rod_modes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace snare::wire {
namespace {

using std::numbers::pi;

constexpr double span = 0.175;

RodInMotion steel(SpatialEnd::Kind kind, double length, int elements) {
  RodInMotion rod;
  rod.properties.bending_stiffness = rod.properties.second_bending_stiffness = 0.048;
  rod.properties.torsional_stiffness = 0.037;
  rod.properties.axial_stiffness = 3.4e5;
  rod.properties.right.position = {span, 0.0, 0.0};
  rod.properties.left.kind = rod.properties.right.kind = kind;
  rod.mass_per_length = 0.014;
  rod.length = length;
  rod.elements = elements;
  return rod;
}

Eigen::Matrix3Xd straight(const RodInMotion& rod) {
  Eigen::Matrix3Xd x = Eigen::Matrix3Xd::Zero(3, rod.elements + 1);
  for (int i = 0; i <= rod.elements; ++i) x(0, i) = span * i / rod.elements;
  return x;
}

// Second order in the mesh: (k h)^2/12 and the like, 2e-3 of the second mode with 60 elements.
TEST(RodModes, OfAClampedBeamBendOnly) {
  const RodInMotion rod = steel(SpatialEnd::Kind::clamp, span, 60);
  const std::vector<RodMode> modes = rod_modes(rod, straight(rod), 4);
  ASSERT_EQ(modes.size(), 4u);
  for (std::size_t m = 0; m < 4; ++m) {  // each in both planes
    const double b = m < 2 ? 4.730040744862704 : 7.853204624095838;
    EXPECT_NEAR(modes[m].natural, b * b / (span * span) * std::sqrt(0.048 / 0.014), 3e-3 * modes[m].natural);
    EXPECT_NEAR(modes[m].bending_share, 1.0, 1e-9);
    EXPECT_NEAR(modes[m].axial_share, 0.0, 1e-9);
  }
}

// Pins and tension T: w^2 m = T k^2 + EI k^4, of which the second bends.
TEST(RodModes, UnderTensionBendLessThanTheySwing) {
  const double tension = 50.0;
  const RodInMotion rod = steel(SpatialEnd::Kind::pin, span / (1.0 + tension / 3.4e5), 60);
  const std::vector<RodMode> modes = rod_modes(rod, straight(rod), 4);
  for (std::size_t m = 0; m < 4; ++m) {
    const double k = (m < 2 ? 1.0 : 2.0) * pi / span;
    const double share = 0.048 * k * k / (tension + 0.048 * k * k);
    EXPECT_NEAR(modes[m].natural, k * std::sqrt((tension + 0.048 * k * k) / 0.014), 3e-3 * modes[m].natural);
    EXPECT_NEAR(modes[m].bending_share, share, 3e-3 * share);
  }
}

}  // namespace
}  // namespace snare::wire
