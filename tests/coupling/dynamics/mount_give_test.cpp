// Mounts that give along the wire: springs, dashpots and slip between the wire's end and its mount, theory.md
// (M.38).

#include "coupling/dynamics/model/start.hpp"
#include "coupling/dynamics/run/simulate.hpp"
#include "tests/support/motion_bodies.hpp"
#include "tests/support/soft_wire.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace snare::coupling {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr double length = 0.2, axial_stiffness = 1e3, mass_per_length = 0.01;

/// Tolerances that follow waves along a wire without damping.
MotionOptions following(double duration, double output_interval) {
  MotionOptions options = test::fine(duration, output_interval);
  options.position_tolerance = 1e-11;
  options.velocity_tolerance = 1e-7;
  return options;
}

/// A straight wire without slack between mounts in the world, of which the right one gives.
Motion straight(const MountGive& right, int elements = 40) {
  Motion motion;
  wire::RodInMotion rod = test::soft_wire(elements);
  rod.damping = {};
  motion.wires.push_back({"wire", rod, straight_wire(rod, Vector3d::Zero(), {length, 0.0, 0.0}), {}});
  motion.mounts = {{"right", 0, wire::End::right, {}, right}};
  return motion;
}

// A rod with a spring at its end swings along itself with beta L of EA beta cos(beta L) + k sin(beta L) = 0.
TEST(MountGive, FrequencyAlongTheWireIsThatOfARodWithASpring) {
  constexpr double k = 3e3, speed = 0.1;
  Motion motion = straight({k});
  double low = 0.5 * std::numbers::pi, high = std::numbers::pi;  // of beta L: free and fixed end
  while (high - low > 1e-12) {
    const double x = 0.5 * (low + high);
    (axial_stiffness / length * x * std::cos(x) + k * std::sin(x) > 0.0 ? low : high) = x;
  }
  const double beta = low / length, omega = beta * std::sqrt(axial_stiffness / mass_per_length);
  Matrix3Xd& v = motion.wires[0].velocities = Matrix3Xd::Zero(3, 41);
  for (int i = 0; i <= 40; ++i) v(0, i) = speed * std::sin(beta * motion.wires[0].positions(0, i));
  const double period = 2.0 * std::numbers::pi / omega;
  MotionOptions options = following(2.25 * period, 0.05 * period);
  options.max_order = 2;
  options.max_step = period / 2000.0;
  double end = 0.0;
  const MotionResult r = simulate(motion, options, [&](const MotionSample& s) {
    end = s.wires[0](0, 40) - length;
    return false;
  });
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  // After two and a quarter periods the end is where it goes furthest; the mesh lowers the frequency by (beta
  // h)^2/24 = 9e-5.
  EXPECT_NEAR(end, speed / omega * std::sin(beta * length), 1e-3 * speed / omega);
}

TEST(MountGive, ATautWireRestsWithTheTensionOfSpringsInSeries) {
  Motion motion = straight({2e4});
  wire::RodInMotion& rod = motion.wires[0].rod;
  rod.length = 0.199;
  rod.properties.left.translational_stiffness = 5e4;
  rod.properties.right.translational_stiffness = 2e4;
  motion.wires[0].positions = resting_wire(rod);
  rod.properties.left.translational_stiffness = rod.properties.right.translational_stiffness =
      std::numeric_limits<double>::infinity();
  motion.mounts.push_back({"left", 0, wire::End::left, {}, {5e4}});
  const double tension = 1e-3 / (0.199 / axial_stiffness + 1.0 / 2e4 + 1.0 / 5e4);
  double worst = 0.0;
  const MotionResult r = simulate(motion, test::fine(0.01, 1e-3), [&](const MotionSample& s) {
    worst = std::max(
        {worst, std::abs(s.mount_forces[0].norm() - tension), std::abs(s.mount_forces[1].norm() - tension)});
    return false;
  });
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  EXPECT_LT(worst, 1e-6 * tension);
}

// A wire that flies against its mount beyond what that bears: the spring's force stays at the force of slip,
// what is lost is that force times the slip, and nothing else.
TEST(MountGive, SlipBoundsTheForceAndLosesItsWork) {
  constexpr double slip_force = 2.0, k = 5e4;
  MountGive give{k};
  give.slip_force = slip_force;
  Motion motion = straight(give);
  Matrix3Xd& v = motion.wires[0].velocities = Matrix3Xd::Zero(3, 41);
  for (int i = 0; i <= 40; ++i) v(0, i) = 2.0 * std::sin(0.5 * std::numbers::pi * i / 40.0);
  double largest = 0.0, before = 0.0;
  const MotionResult r = simulate(motion, following(5e-3, 1e-5), [&](const MotionSample& s) {
    largest = std::max(largest, s.mount_forces[1].norm());
    EXPECT_GE(s.energy.dissipated, before - 1e-12);
    before = s.energy.dissipated;
    return false;
  });
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  EXPECT_GT(largest, slip_force);
  EXPECT_LT(largest, slip_force + k * 2.0 * 1e-5);  // the slip is late by tau = 10 us
  const double start = 0.5 * mass_per_length * length * 0.5 * 4.0;
  EXPECT_GT(r.energy.dissipated, 0.1 * start);
  EXPECT_LT(std::abs(r.energy.integrator), 1e-3 * start);
}

// Bodies that carry a wire by springs and dashpots, and turn: nothing outside acts.
TEST(MountGive, KeepsMomentumOfWhatCarriesTheWire) {
  Motion motion = straight({3e3, 2.0}, 12);
  motion.wires[0].rod.damping.bending_time = 2e-4;
  motion.mounts[0].give.slip_force = 0.5;
  motion.mounts[0].carrier = test::body_of(1);
  motion.mounts.push_back({"left", 0, wire::End::left, test::body_of(0), {2e3, 1.0}});
  for (int k = 0; k < 2; ++k) {
    MotionBody body = test::block(k == 0 ? "a" : "b", 0.05, {2e-5, 3e-5, 4e-5});
    body.start.position = {0.2 * k, 0.01, -0.005};
    body.start.velocity = {0.3 * (1 - 2 * k), 0.1 * k, -0.2};
    body.start.spin = {1.0, 3.0 - 4.0 * k, 2.0};
    motion.bodies.push_back(body);
  }
  const MotionResult r = simulate(motion, test::fine_tolerances(), {});
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  EXPECT_LT(r.momentum_error.norm(), 1e-7);
  EXPECT_LT(r.angular_momentum_error.norm(), 1e-8);
  EXPECT_GT(r.energy.dissipated, 1e-5);
  EXPECT_LT(std::abs(r.energy.integrator), 1e-2 * r.energy.dissipated);
}

}  // namespace
}  // namespace snare::coupling
