#include "coupling/dynamics/model/phase.hpp"

#include "coupling/dynamics/run/simulate.hpp"
#include "tests/support/same_bits.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

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

// Begun at 0.1 s, the disc turns at 2 rad/s after a ramp of 0.1 s: it passes 1 rad at 0.1 + 0.05 + 0.5 s, as
// nothing turns it against the gear by then; the brake then holds it there, and what it had is lost in the
// brake and the gear.
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
  // The course gives the disc and its motor what they move with, (0.5 + 0.1) 2^2/2, and what swings in the
  // gear at both ends of the ramp: the step of 10 N m bends it by 1 mrad, which costs 5 mJ of energy and as
  // much of damping.
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
  motion.phases[1].drives = {
      {0, 0, [](double, double angle) { return Drive::holding(angle, 1e3, 30.0, 40.0); }}};
  MotionOptions options;
  options.duration = 1.0;
  options.checkpoint_interval = 0.11;
  EXPECT_EQ(test::expect_same_bits_from_checkpoints(motion, options).size(), 9u);
}

/// The disc's angle [rad].
SensedSignal angle_of_disc(double interval, double delay) {
  SensedSignal signal;
  signal.make = [](const Motion&) -> SensedSignal::Sight {
    return [](const MotionSample& s) -> Vector3d { return {s.arms[0].state.q[0], 0.0, 0.0}; };
  };
  signal.interval = interval;
  signal.delay = delay;
  return signal;
}

/// A disc that turns by 3 rad from 0.1 s on, at 2 rad/s behind a ramp: at 2 (t - 0.15 s) from 0.2 s on.
Motion turning_disc(const SensedSignal& signal, const SensedBound& bound, double hold) {
  Motion motion;
  motion.arms = {disc()};
  motion.sensed = {signal};
  motion.phases.resize(2);
  motion.phases[0].not_before = 0.1;
  motion.phases[0].drives = {turning(3.0, 2.0, 0.1)};
  motion.phases[1].sensed = {bound};
  motion.phases[1].hold = hold;
  motion.phases[1].drives = {{0, 0, [](double, double) { return Drive::locked(); }}};
  return motion;
}

SensedBound sensed_above(double bound) {
  SensedBound b;
  b.component = 0;
  b.bound = bound;
  return b;
}

// 1 rad is passed at 0.65 s. A sensor of 20 Hz that is 0.12 s late tells of it with the first reading from
// 0.77 s on, at 0.8 s: exactly then.
TEST(Phases, BeginWithAReadingNotBetween) {
  const struct {
    double interval, delay, hold, begins;
  } cases[] = {{0.05, 0.0, 0.0, 0.65},
               {0.05, 0.12, 0.0, 0.80},
               {0.05, 0.12, 0.12, 0.92},
               {0.1, 0.0, 0.0, 0.7},
               {0.01, 0.005, 0.0, 0.66}};
  for (const auto& c : cases) {
    // A little before 1 rad, as what swings in the gear may be behind by a few microradians.
    const MotionResult result =
        simulate(turning_disc(angle_of_disc(c.interval, c.delay), sensed_above(0.999), c.hold), fine(1.2));
    ASSERT_TRUE(result.report.usable()) << result.report.message;
    ASSERT_EQ(result.phases.size(), 2u) << c.delay;
    EXPECT_NEAR(result.phases[1].time, c.begins, 1e-12) << c.interval << " " << c.delay << " " << c.hold;
  }
}

// Between two output times a reading is straight: at 0.66 s - 3.3 ms it tells 0.67 of what was there at 0.65
// s + ... of the angle, which is a line.
TEST(Phases, ReadingsBetweenOutputsAreStraight) {
  SensedBound b = sensed_above(0.0);
  SensedSignal signal = angle_of_disc(0.05, 0.0133);
  signal.noise = [](long) { return Vector3d(0.0, 0.0, 0.0); };
  // 2 (0.75 - 0.0133 - 0.15) = 1.1734 at 0.75 s.
  for (const auto& [bound, begins] : {std::pair{1.172, 0.75}, std::pair{1.175, 0.80}}) {
    b.bound = bound;
    const MotionResult result = simulate(turning_disc(signal, b, 0.0), fine(1.2));
    ASSERT_EQ(result.phases.size(), 2u);
    EXPECT_NEAR(result.phases[1].time, begins, 1e-12);
  }
}

// A reading that does not keep the bound breaks the hold, whatever is there between readings: noise of one
// reading in six.
TEST(Phases, OneReadingBreaksTheHold) {
  SensedSignal signal = angle_of_disc(0.05, 0.0);
  signal.noise = [](long reading) { return Vector3d(reading % 6 == 0 ? -10.0 : 0.0, 0.0, 0.0); };
  // Kept from 0.65 s on (reading 13), broken by reading 18 at 0.9 s, kept again from 0.95 s to 1.2 s.
  for (const auto& [hold, begins] : {std::pair{0.2, 0.85}, std::pair{0.25, 0.9}, std::pair{0.26, -1.0}}) {
    const MotionResult result = simulate(turning_disc(signal, sensed_above(0.999), hold), fine(1.5));
    ASSERT_TRUE(result.report.usable()) << result.report.message;
    ASSERT_EQ(result.phases.size(), begins > 0.0 ? 2u : 1u) << hold;
    if (begins > 0.0) {
      EXPECT_NEAR(result.phases[1].time, begins, 1e-12) << hold;
    }
  }
}

TEST(Phases, ReadingsGoOnFromACheckpointWithTheSameBits) {
  Motion motion = turning_disc(angle_of_disc(0.03, 0.077), sensed_above(1.5), 0.05);
  motion.sensed[0].noise = [](long reading) {
    return Vector3d(0.01 * std::sin(static_cast<double>(reading)), 0.0, 0.0);
  };
  MotionOptions options;
  options.duration = 1.2;
  options.output_interval = 0.01;
  options.checkpoint_interval = 0.11;
  EXPECT_EQ(test::expect_same_bits_from_checkpoints(motion, options).size(), 10u);
}

}  // namespace
}  // namespace snare::coupling
