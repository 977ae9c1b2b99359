#include "wire/motion/rod_modes.hpp"

#include <gtest/gtest.h>

#include <array>
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

// With curvatures as unknowns a dozen elements do: masses at the vertices alone keep the fourth order, as the
// exact flexibility has no kink below its third derivative.
TEST(RodModes, OfHigherOrderConvergeFaster) {
  const auto errors = [](SpatialEnd::Kind kind, int elements) {
    const double tension = kind == SpatialEnd::Kind::pin ? 50.0 : 0.0;
    RodInMotion rod = steel(kind, span / (1.0 + tension / 3.4e5), elements);
    rod.formulation = Formulation::higher_order;
    const std::vector<RodMode> modes = rod_modes(rod, straight(rod), 4);
    const auto exact = [&](int m) {  // each in both planes
      if (kind == SpatialEnd::Kind::clamp)
        return std::pow((m < 2 ? 4.730040744862704 : 7.853204624095838) / span, 2) * std::sqrt(0.048 / 0.014);
      // By the unstretched length, along which the mass is spread: m w^2 = T/(1 + e) k^2 + EI/(1 + e)^2 k^4.
      const double stretched = 1.0 + tension / 3.4e5;
      const double k = (m < 2 ? 1.0 : 2.0) * pi / rod.length;
      return k * std::sqrt((tension / stretched + 0.048 * k * k / (stretched * stretched)) / 0.014);
    };
    return std::array{modes[1].natural / exact(1) - 1.0, modes[3].natural / exact(3) - 1.0};
  };
  for (const auto kind : {SpatialEnd::Kind::clamp, SpatialEnd::Kind::pin}) {
    const auto coarse = errors(kind, 12), fine = errors(kind, 24);
    for (const std::size_t m : {0u, 1u}) {
      EXPECT_LT(std::abs(coarse[m]), 3e-4);  // of plain vertices 5e-2
      EXPECT_GT(std::log2(coarse[m] / fine[m]), 3.5);
    }
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
