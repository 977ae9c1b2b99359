#include "coupling/dynamics/phase.hpp"

#include "coupling/dynamics/simulate.hpp"
#include "tests/support/same_bits.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace snare::coupling {
namespace {

using Eigen::Vector3d;
using multibody::Course;
using multibody::Drive;

/// A disc of 0.5 kg m^2 on a stiff gear.
MotionArm disc() {
  MotionArm arm;
  arm.name = "disc";
  arm.arm.tree.add_moving(
      0, "disc", multibody::JointKind::revolute, Vector3d::UnitZ(), {},
      multibody::SpatialInertia::about_centre(1.0, Vector3d::Zero(), 0.5 * Eigen::Matrix3d::Identity()));
  multibody::ElasticJoint joint;
  joint.name = "joint";
  joint.motor_inertia = 0.1;
  joint.spring = multibody::DeflectionLaw::linear(1e4, 20.0);
  arm.arm.joints.push_back(joint);
  arm.start = multibody::resting(arm.arm, Eigen::VectorXd::Zero(1));
  arm.drives = {Drive::locked()};
  return arm;
}

PhaseDrive turning(double by, double rate, double ramp) {
  return {0, 0, [=](double time, double angle) {
            return Drive::on_course(Course::at_rate(angle, angle + by, time, rate, ramp));
          }};
}

SignalBound angle_above(double angle) {
  SignalBound b;
  b.signal.kind = MotionSignal::Kind::joint_angle;
  b.bound = angle;
  return b;
}

MotionOptions fine(double duration) {
  MotionOptions o;
  o.duration = duration;
  o.output_interval = 1e-2;
  o.body_position_tolerance = o.angle_tolerance = 1e-10;
  o.body_velocity_tolerance = o.spin_tolerance = 1e-8;
  return o;
}

// Begun at 0.1 s, the disc turns at 2 rad/s after a ramp of 0.1 s: it passes 1 rad at 0.1 + 0.05 + 0.5 s, as nothing turns it
// against the gear by then; the brake then holds it there, and what it had is lost in the brake and the gear.
TEST(Phases, BeginAtTheirTimesAndOnWhatHappens) {
  Motion motion;
  motion.arms = {disc()};
  motion.phases.resize(3);
  motion.phases[0].not_before = 0.1;
  motion.phases[0].drives = {turning(3.0, 2.0, 0.1)};
  motion.phases[1].bounds = {angle_above(1.0)};
  motion.phases[1].drives = {{0, 0, [](double, double) { return Drive::locked(); }}};
  motion.phases[2].after_previous = 0.3;
  motion.phases[2].ends_run = true;
  double last_angle = 0.0;
  const MotionResult result = simulate(motion, fine(2.0), [&](const MotionSample& s) {
    last_angle = s.arms[0].state.q[0];
    return false;
  });
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  ASSERT_EQ(result.phases.size(), 3u);
  EXPECT_EQ(result.phases[0].time, 0.1);
  EXPECT_NEAR(result.phases[1].time, 0.65, 1e-6);
  EXPECT_NEAR(result.phases[2].time, result.phases[1].time + 0.3, 1e-12);
  EXPECT_NEAR(result.report.time, result.phases[2].time, 1e-12);
  EXPECT_NEAR(last_angle, 1.0, 1e-3);
  EXPECT_LT(std::abs(result.energy.integrator), 1e-4 * result.energy.work);
  // The course gives the disc and its motor what they move with, (0.5 + 0.1) 2^2/2, and what swings in the gear at both ends of
  // the ramp: the step of 10 N m bends it by 1 mrad, which costs 5 mJ of energy and as much of damping.
  EXPECT_NEAR(result.energy.work, 0.5 * 0.6 * 4.0 + 0.01, 1e-3);
}

// A bound that is kept only for a while does not begin a phase that asks for longer.
TEST(Phases, HoldWhatTheyAskFor) {
  Motion motion;
  motion.arms = {disc()};
  motion.phases.resize(3);
  motion.phases[0].drives = {turning(1.0, 2.0, 0.1)};
  SignalBound pressed;
  pressed.signal.kind = MotionSignal::Kind::joint_torque;
  pressed.bound = 5.0;  // while the ramps of 20 rad/s^2 take 10 N m
  motion.phases[1].bounds = {pressed};
  motion.phases[1].hold = 0.05;
  motion.phases[2].bounds = {pressed};
  motion.phases[2].hold = 0.5;
  const MotionResult result = simulate(motion, fine(1.5));
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  ASSERT_EQ(result.phases.size(), 2u);
  EXPECT_NEAR(result.phases[1].time, 0.05, 0.02);
}

TEST(Phases, GoOnFromACheckpointWithTheSameBits) {
  Motion motion;
  motion.arms = {disc()};
  motion.phases.resize(2);
  motion.phases[0].not_before = 0.1;
  motion.phases[0].drives = {turning(3.0, 2.0, 0.1)};
  motion.phases[1].bounds = {angle_above(1.0)};
  motion.phases[1].hold = 0.05;
  motion.phases[1].drives = {{0, 0, [](double, double angle) { return Drive::holding(angle, 1e3, 30.0, 40.0); }}};
  MotionOptions options;
  options.duration = 1.0;
  options.checkpoint_interval = 0.11;
  EXPECT_EQ(test::expect_same_bits_from_checkpoints(motion, options).size(), 9u);
}

}  // namespace
}  // namespace snare::coupling
