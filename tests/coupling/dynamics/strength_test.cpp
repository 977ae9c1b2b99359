#include "coupling/dynamics/model/strength.hpp"
#include "base/errors.hpp"
#include "coupling/dynamics/run/simulate.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/soft_wire.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace snare::coupling {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

constexpr int edges = 20;

// A straight wire that stands upright under its weight w = 100 N/m, stretched so that the mean tension is 30
// N: 40 N at the upper mount, and on the last edge, which carries all but half an element of weight, 39.5 N.
Motion standing_wire() {
  Motion motion;
  wire::RodInMotion rod = test::soft_wire(edges);
  motion.gravity = {-1e4, 0.0, 0.0};
  const double h = rod.length / edges;
  Eigen::Matrix3Xd positions = Eigen::Matrix3Xd::Zero(3, edges + 1);
  for (int e = 0; e < edges; ++e) {
    const double tension = 30.0 + 100.0 * ((e + 0.5) * h - 0.5 * rod.length);
    positions(0, e + 1) = positions(0, e) + h * (1.0 + tension / rod.properties.axial_stiffness);
  }
  rod.properties.right.position = positions.rightCols<1>();
  motion.wires.push_back({"wire", rod, positions, {}});
  return motion;
}

MotionOptions short_run() {
  MotionOptions options;
  options.duration = 1e-3;
  return options;
}

TEST(Strength, TensionIsThatOfAStandingWireUnderItsWeight) {
  Motion motion = standing_wire();
  motion.wires[0].strength.breaking_tension = 50.0;
  double held = 0.0;
  const MotionResult result = simulate(motion, short_run(), [&held](const MotionSample& s) {
    held = s.mount_forces[1].x();
    return false;
  });
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  ASSERT_EQ(result.strength.size(), 1u);
  EXPECT_NEAR(held, 40.0, 1e-3);
  // At rest but for the integrator's tolerance of 1e-8 m on the position of vertices: EA 1e-8/h = 1e-3 N.
  EXPECT_NEAR(result.strength[0].tension, 39.5, 2e-3);
  EXPECT_NEAR(result.strength[0].share, 39.5 / 50.0, 1e-4);
  EXPECT_EQ(result.strength[0].bending, 0.0);
  EXPECT_GE(result.strength[0].arc, 0.19 - 1e-12);  // beside the last edge
}

TEST(Strength, EndsTheRunWhereAsked) {
  Motion motion = standing_wire();
  motion.wires[0].strength = {39.0, 0.0, true};
  const MotionResult result = simulate(motion, short_run());
  EXPECT_FALSE(result.report.usable());
  EXPECT_THAT(result.report.message, HasSubstr("wire reaches its strength of 39 N at"));
  EXPECT_THAT(result.report.message, HasSubstr("tension 39.5"));
  EXPECT_LT(result.report.time, 1e-3);
  ASSERT_EQ(result.strength.size(), 1u);
  EXPECT_NEAR(result.strength[0].share, 39.5 / 39.0, 1e-4);
  motion.wires[0].strength.ends_run = false;
  EXPECT_TRUE(simulate(motion, short_run()).report.usable());
}

TEST(Strength, ViscousTensionCounts) {
  // One mount leaves at 0.2 m/s, all vertices in proportion: T = EA (e + tau e') with e' = 1/s, largest at
  // the end.
  Motion motion;
  wire::RodInMotion rod = test::soft_wire(edges);
  const Eigen::Matrix3Xd positions = straight_wire(rod, Vector3d::Zero(), {0.2, 0.0, 0.0});
  motion.wires.push_back({"wire", rod, positions, positions, {10.0, 0.0, false}});
  MotionBody machine;
  machine.driven = true;
  machine.start.position = {0.2, 0.0, 0.0};
  machine.start.velocity = {0.2, 0.0, 0.0};
  motion.bodies.push_back(machine);
  motion.mounts.push_back({"grip", 0, wire::End::right, {MotionCarrier::Kind::body, 0, 0}});
  const MotionResult result = simulate(motion, short_run());
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  const double tension = 1e3 * (1e-3 + 1e-4);  // EA (e' t + tau e')
  EXPECT_NEAR(result.strength[0].tension, tension, 1e-3 * tension);
  EXPECT_NEAR(result.strength[0].share, tension / 10.0, 1e-3);
  EXPECT_NEAR(result.strength[0].time, 1e-3, 1e-9);
}

class BendingStrength : public ::testing::TestWithParam<wire::Formulation> {};

TEST_P(BendingStrength, IsTheStressOfABentBeam) {
  // A quarter radian on 0.2 m between clamps that point along the arc: constant moment, at rest. The fibre
  // outside bears E d/2 over the radius of 0.8 m.
  constexpr double angle = 0.25;
  wire::WireSpecification solid;
  solid.diameter = 1e-3;
  solid.youngs_modulus = 200e9;
  const double stress = solid.youngs_modulus * 0.5 * solid.diameter * angle / 0.2;
  const double section = 0.25 * std::numbers::pi * solid.diameter * solid.diameter;

  Motion motion;
  wire::RodInMotion rod = test::soft_wire(edges);
  rod.formulation = GetParam();
  // Edges of higher order bow: their length is that of the arc over their chord.
  const double turn = angle / edges;
  const double bow =
      GetParam() == wire::Formulation::higher_order ? std::sin(0.5 * turn) / (0.5 * turn) : 1.0;
  Eigen::Matrix3Xd positions = Eigen::Matrix3Xd::Zero(3, edges + 1);
  for (int e = 0; e < edges; ++e) {
    const double a = turn * (e + 0.5);
    positions.col(e + 1) =
        positions.col(e) + bow * rod.length / edges * Vector3d(std::cos(a), std::sin(a), 0.0);
  }
  rod.properties.left.director = rod.properties.right.director = Vector3d::UnitZ();
  rod.properties.right.position = positions.rightCols<1>();
  rod.properties.right.direction = {std::cos(angle), std::sin(angle), 0.0};
  motion.wires.push_back({"wire", rod, positions, {}, wire_strength(solid, 1000.0, false)});
  const MotionResult result = simulate(motion, short_run());
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  // 2 tan(phi/2) of turns of 0.0125 at the vertices and half of that at the clamps: equal to 2e-5, so at rest
  // to that.
  EXPECT_NEAR(result.strength[0].bending, section * stress, 1e-3 * section * stress);
  EXPECT_LT(std::abs(result.strength[0].tension), 0.1);  // of 196 N
  EXPECT_NEAR(result.strength[0].share, section * stress / 1000.0, 1e-3);

  solid.construction = wire::Construction::strand;
  EXPECT_EQ(wire_strength(solid, 1000.0, false).bending_force, 0.0);
}
INSTANTIATE_TEST_SUITE_P(Formulations, BendingStrength,
                         testing::Values(wire::Formulation::vertices, wire::Formulation::higher_order));

TEST(Strength, MustBePositive) {
  Motion motion = standing_wire();
  motion.wires[0].strength.breaking_tension = 0.0;
  EXPECT_THROW(static_cast<void>(simulate(motion, short_run())), base::InputError);
}

TEST(MassRate, IsRefusedForAWireWhoseMountMoves) {
  Motion motion = standing_wire();
  motion.wires[0].rod.damping.mass_rate = 5.0;
  MotionBody carrier;
  carrier.driven = true;
  motion.bodies.push_back(carrier);
  motion.mounts.push_back({"grip", 0, wire::End::left, {MotionCarrier::Kind::body, 0, 0}});
  EXPECT_THAT(
      test::refusal([&] { return simulate(motion, short_run()); }),
      HasSubstr("wire.damping.mass_rate = 5, must be 0: it drags against the world, which grip leaves"));
}

}  // namespace
}  // namespace snare::coupling
