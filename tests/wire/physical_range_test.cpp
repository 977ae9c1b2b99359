#include "wire/physical_range.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace snare::wire {
namespace {

WireSpecification music_wire(double diameter) {
  WireSpecification wire;
  wire.diameter = diameter;
  wire.length = 0.18;
  wire.youngs_modulus = 207e9;
  wire.density = 7850.0;
  return wire;
}

// Shigley, example 10-1: music wire no. 16, 0.037 in, has 201 kpsi / 0.037^0.145 = 324 kpsi; that coefficient
// is rounded to half a per cent.
TEST(PhysicalRange, StrengthIsThatOfMusicWire) {
  constexpr double kpsi = 6.894757e6;
  EXPECT_NEAR(strongest_wire(0.037 * 25.4e-3), 324.0 * kpsi, 0.005 * 324.0 * kpsi);
  EXPECT_EQ(strongest_wire(1e-5), strongest_wire(1e-4));  // no table goes there
}

// A cantilever of a round section: 32 M/(pi d^3), and the tension over the area beside it.
TEST(PhysicalRange, StressAddsTensionAndBending) {
  const WireSpecification wire = music_wire(1e-3);
  EXPECT_NEAR(largest_stress(wire, 100.0, 0.0), 400.0 / (std::numbers::pi * 1e-6), 1.0);
  EXPECT_NEAR(largest_stress(wire, 0.0, 0.1), 3.2 / (std::numbers::pi * 1e-9), 1.0);
  EXPECT_EQ(largest_stress(wire, -100.0, 0.0), 0.0);
  WireSpecification strand = wire;
  strand.construction = Construction::strand;
  EXPECT_EQ(largest_stress(strand, 0.0, 0.1), 0.0);
}

TEST(PhysicalRange, OnlyWhatNoWireHasIsDoubted) {
  WireSpecification wire = music_wire(0.8e-3);
  EXPECT_TRUE(doubts(wire).empty());
  wire.axial_stiffness_override = 4.6 * 207e9 * std::numbers::pi * 0.64e-6 / 4.0;
  ASSERT_EQ(doubts(wire).size(), 1u);
  EXPECT_NE(doubts(wire)[0].find("the axial stiffness is 4.6 times that of a solid wire of 0.8 mm"),
            std::string::npos);
  wire.youngs_modulus = 1e13;
  wire.density = 1e5;
  EXPECT_EQ(doubts(wire).size(), 3u);
  EXPECT_TRUE(overload(wire, 2.2e9).empty());
  wire.diameter = 5e-324;  // no section: no number is written that is none
  for (const std::string& doubt : doubts(wire)) EXPECT_EQ(doubt.find("inf"), std::string::npos) << doubt;
  EXPECT_EQ(overload(wire, largest_stress(wire, 1.0, 1.0))[0].find("inf"), std::string::npos);
  wire.diameter = 0.8e-3;
  EXPECT_EQ(overload(wire, 20e3 / (std::numbers::pi * 0.16e-6)).size(), 1u);  // 20 kN on 0.8 mm
}

// The critical speed of a blow across: at a strain e the tension's transverse wave runs at c sqrt(e (1 + e))
// along the strained wire and the inflow of material at c e must be made up by the kink: v^2 = w^2 - (w - c
// e)^2 with w = c sqrt(e (1 + e)).
TEST(PhysicalRange, BreakingSpeedIsThatOfTheKink) {
  const double stiffness = 1e5;
  const double mass = 4e-3;
  const double strength = 1e3;
  const double c = std::sqrt(stiffness / mass);
  const double e = strength / stiffness;
  const double w = c * std::sqrt(e * (1.0 + e));
  const double v = breaking_speed(stiffness, mass, strength);
  EXPECT_NEAR(v * v, w * w - std::pow(w - c * e, 2), 1e-9 * v * v);
}

}  // namespace
}  // namespace snare::wire
