#include "tests/multibody/plain_arm.hpp"
#include "validation/planar_arm.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace snare {

namespace {

using multibody::Drive;
constexpr double pi = std::numbers::pi;

/// Times at which the deflection of joint 0 rises through zero, by Hermite's cubic between samples.
std::vector<double> rising_zeros(const multibody::ArmHistory& history) {
  std::vector<double> times;
  for (std::size_t i = 0; i + 1 < history.samples.size(); ++i) {
    const auto& a = history.samples[i];
    const auto& b = history.samples[i + 1];
    if (!(a.deflection[0] < 0.0 && b.deflection[0] >= 0.0)) continue;
    const double h = b.time - a.time;
    const double va = h * (a.state.v[0] - a.state.motor_rate[0]),
                 vb = h * (b.state.v[0] - b.state.motor_rate[0]);
    double s = 0.5;
    for (int k = 0; k < 60; ++k) {
      const double f = (1 + 2 * s) * (1 - s) * (1 - s) * a.deflection[0] + s * (1 - s) * (1 - s) * va +
                       s * s * (3 - 2 * s) * b.deflection[0] - s * s * (1 - s) * vb;
      const double step = std::ldexp(0.25, -k);
      s += f < 0.0 ? step : -step;
    }
    times.push_back(a.time + s * h);
  }
  return times;
}

/// Period of a mass on the continuous law with a first slope k0 up to a and a slope k1 beyond, swinging with
/// amplitude A:
/// a sine through the middle and arcs of another sine outside, by the elementary formulas of the harmonic
/// oscillator.
double closed_period(double inertia, double k0, double k1, double a, double A) {
  if (A <= a) return 2.0 * pi * std::sqrt(inertia / k0);
  const double w0 = std::sqrt(k0 / inertia), w1 = std::sqrt(k1 / inertia);
  const double shift = k0 * a / k1 - a;  // the outer spring pulls to -shift
  const double outside = std::acos((a + shift) / (A + shift)) / w1;
  const double speed = w1 * std::sqrt((A + shift) * (A + shift) - (a + shift) * (a + shift));
  return 4.0 * (outside + std::atan2(w0 * a, speed) / w0);
}

}  // namespace

TEST(DeflectionLaw, ReadsTable2BothWays) {
  const double degree = pi / 180.0;
  const auto continuous = test::table2(1.0),
             literal = test::table2(1.0, multibody::StiffnessReading::literal);
  const auto torque = [](const multibody::DeflectionLaw& law, double d) {
    return law.torque(law.branch_of(d), d);
  };
  // The digest's reading: 0.5 N m + 475 (|d| - 0.04); the literal one jumps from 0.5 to 19 N m.
  EXPECT_NEAR(torque(continuous, 0.04 * degree), 0.5, 1e-12);
  EXPECT_NEAR(torque(continuous, -0.1 * degree), -(0.5 + 475.0 * 0.06), 1e-12);
  EXPECT_NEAR(torque(literal, 0.0399999999 * degree), 0.5, 1e-8);
  EXPECT_NEAR(torque(literal, 0.04 * degree), 19.0, 1e-12);
  EXPECT_NEAR(torque(literal, -0.1 * degree), -47.5, 1e-12);
  for (const auto* law : {&continuous, &literal}) {
    double energy = 0.0;  // the integral of the torque, by the midpoint rule within pieces
    for (int i = 0; i < 1000; ++i) energy += torque(*law, (i + 0.5) * 1e-4 * degree) * 1e-4 * degree;
    const double d = -0.1 * degree;
    EXPECT_NEAR(law->energy(law->branch_of(d), d), energy, 1e-12);
  }
}

TEST(DeflectionLaw, RampsReplaceTheJumpsOfTorqueAndDamping) {
  const double degree = pi / 180.0, width = 1e-3 * degree;
  for (const auto reading : {multibody::StiffnessReading::continuous, multibody::StiffnessReading::literal}) {
    const auto plain = test::table2(1.0, reading);
    const multibody::DeflectionLaw ramped(plain.pieces(), reading, multibody::DampingRate::deflection, width);
    double torque = 0.0, energy = 0.0;
    for (int i = 0; i < 20000; ++i) {
      const double d = (i + 0.5) * 5e-6 * degree;
      const int branch = ramped.branch_of(d), jumping = plain.branch_of(d);
      const double now = ramped.torque(branch, d);
      // No step of the torque beyond that of the ramp's slope, and its energy is the integral.
      EXPECT_LT(now - torque, 5e-6 * degree * ramped.stiffness(branch) + 0.1);
      torque = now;
      energy += now * 5e-6 * degree;
      if (std::abs(d - 0.04 * degree) > 0.5 * width && std::abs(d - 0.06 * degree) > 0.5 * width) {
        EXPECT_NEAR(now, plain.torque(jumping, d), 1e-12);
        EXPECT_EQ(ramped.damping(branch, d), plain.damping(jumping, d));
        EXPECT_EQ(ramped.damping_slope(branch, d), 0.0);
      }
    }
    const double end = 0.1 * degree;
    EXPECT_NEAR(ramped.energy(ramped.branch_of(end), end), energy, 1e-6 * energy);  // midpoint rule, corners
    // Half-way through a ramp both are half-way, on either side of zero.
    for (const double sign : {1.0, -1.0}) {
      const double d = sign * 0.04 * degree;
      const int branch = ramped.branch_of(d);
      EXPECT_NEAR(ramped.damping(branch, d) * degree, 0.5 * (48.9 + 87.3), 1e-9);
      EXPECT_GT(sign * ramped.damping_slope(branch, d), 0.0);
      if (reading == multibody::StiffnessReading::literal) {
        EXPECT_NEAR(sign * ramped.torque(branch, d), 0.5 * (0.5 + 19.0), 0.25 * (475.0 - 12.5) * 1e-3 + 1e-9);
      }
    }
  }
  EXPECT_THROW(multibody::DeflectionLaw(test::table2(1.0).pieces(), multibody::StiffnessReading::literal,
                                        multibody::DampingRate::deflection, 0.02 * degree),
               std::invalid_argument);
}

TEST(ElasticJoint, LoadBetweenTheTorquesOfAJumpRestsOnIt) {
  // 10 N m on a literal jump from 0.5 to 19 N m. With a width it comes to rest within it, with few events; as
  // a true jump it ends in events without end, which is said.
  const double degree = pi / 180.0;
  for (const double width : {0.0, 4e-5, 4e-4, 4e-3}) {
    const multibody::DeflectionLaw law(test::table2(1.0).pieces(), multibody::StiffnessReading::literal,
                                       multibody::DampingRate::deflection, width * degree);
    auto run = validation::at_rest(test::one_joint(200.0, 1.0, law), Drive::locked(), 20.0, 1e-7);
    run.tolerances.coordinate = run.tolerances.rate = 1e-12;
    run.loads.push_back(
        {1, {{0.0, 0.0, 10.0}, Eigen::Vector3d::Zero()}, 0.0, 100.0, multibody::TimedLoad::Shape::constant});
    const auto history = multibody::simulate(run);
    if (width == 0.0) {
      EXPECT_EQ(history.report.termination, numerics::Termination::step_too_small);
      EXPECT_NE(history.report.message.find("stays at a jump"), std::string::npos) << history.report.message;
      continue;
    }
    ASSERT_TRUE(history.report.usable()) << history.report.message;
    EXPECT_NEAR(history.samples.back().deflection[0] / degree, 0.04, 0.5 * width);
    EXPECT_NEAR(history.samples.back().joint_torque[0], 10.0, 1e-3);
    EXPECT_LT(history.events.size(), 200U);
    EXPECT_LT(history.statistics.steps, 10000);
    EXPECT_LT(history.energy_error, 1e-4);
    RecordProperty("events at a width of " + std::to_string(width), static_cast<int>(history.events.size()));
  }
}

TEST(ElasticJoint, FrequenciesAreThoseOfTwoMasses) {
  const double H = 3.0, B = 5.0, K = 200.0;
  const auto arm = test::one_joint(H, B, multibody::DeflectionLaw::linear(K, 0.0));
  const Eigen::VectorXd q = Eigen::VectorXd::Zero(1);
  const auto locked = multibody::natural_modes(arm, q, {Drive::locked()});
  ASSERT_EQ(locked.size(), 1U);
  EXPECT_NEAR(locked[0].frequency, std::sqrt(K / H) / (2 * pi), 1e-12);
  const auto limp = multibody::natural_modes(arm, q, {Drive::limp()});
  ASSERT_EQ(limp.size(), 2U);
  EXPECT_EQ(limp[0].frequency, 0.0);
  EXPECT_NEAR(limp[1].frequency, std::sqrt(K * (1 / H + 1 / B)) / (2 * pi), 1e-12);
  // Held by a servo: H B x^2 - (K B + (K + kp) H) x + K kp = 0 in x = omega^2.
  const double kp = 70.0, half = 0.5 * (K / H + (K + kp) / B), product = K * kp / (H * B);
  const auto held = multibody::natural_modes(arm, q, {Drive::holding(0.0, kp, 0.0)});
  EXPECT_NEAR(held[0].frequency, std::sqrt(half - std::sqrt(half * half - product)) / (2 * pi), 1e-12);
  EXPECT_NEAR(held[1].frequency, std::sqrt(half + std::sqrt(half * half - product)) / (2 * pi), 1e-12);

  // The same in time: the free pair swings at its own frequency.
  auto run = validation::at_rest(arm, Drive::limp(), 5.0, 1e-9);
  run.initial.motor[0] = 0.01;
  const auto history = multibody::simulate(run);
  ASSERT_TRUE(history.report.usable()) << history.report.message;
  const auto zeros = rising_zeros(history);
  ASSERT_GT(zeros.size(), 5U);
  // The integrator's error is some ten times its tolerance of 1e-9; Hermite's cubic errs by (w h)^4/384 =
  // 1e-7 of a period at its ends only, which the number of periods divides.
  EXPECT_NEAR((zeros.back() - zeros.front()) / static_cast<double>(zeros.size() - 1) * limp[1].frequency, 1.0,
              1e-6);
}

TEST(ElasticJoint, PeriodFollowsTheAmplitudeOfThePiecewiseLaw) {
  const double degree = pi / 180.0, H = 5000.0;
  for (const double amplitude : {0.03, 0.041, 0.06, 0.1, 0.5}) {
    auto run = validation::at_rest(test::one_joint(H, 1.0, test::table2(0.0)), Drive::locked(), 40.0, 1e-10);
    run.initial.q[0] = amplitude * degree;
    run.sample = 0.01;
    run.tolerances.coordinate = run.tolerances.rate = 1e-13;  // of angles of 1e-3
    const auto history = multibody::simulate(run);
    ASSERT_TRUE(history.report.usable()) << history.report.message;
    const auto zeros = rising_zeros(history);
    ASSERT_GT(zeros.size(), 1U);
    const double period = (zeros.back() - zeros.front()) / static_cast<double>(zeros.size() - 1);
    // Asked for within 1e-4; the integration is good to some 1e-7 over these few periods.
    EXPECT_NEAR(period / closed_period(H, 12.5 / degree, 475.0 / degree, 0.04 * degree, amplitude * degree),
                1.0, 1e-5)
        << amplitude;
    EXPECT_LT(history.energy_error, 1e-6) << amplitude;
  }
}

TEST(ElasticJoint, PassesTheJumpsWithoutThrashing) {
  // Each crossing of 0.04 or 0.06 deg is one event and one restart, with the damping that jumps at both, and
  // in the literal reading with a torque that jumps by 18.5 N m.
  for (const auto reading : {multibody::StiffnessReading::continuous, multibody::StiffnessReading::literal}) {
    const double degree = pi / 180.0;
    auto run = validation::at_rest(test::one_joint(20000.0, 1.0, test::table2(1.0, reading)), Drive::locked(),
                                   60.0, 1e-7);
    run.initial.q[0] = 0.5 * degree;
    run.tolerances.coordinate = run.tolerances.rate = 1e-11;
    const auto history = multibody::simulate(run);
    ASSERT_TRUE(history.report.usable()) << history.report.message;
    int crossings = 0;
    const auto piece = [&](double d) {
      return (std::abs(d) >= 0.04 * degree) + (std::abs(d) >= 0.06 * degree);
    };
    for (std::size_t i = 1; i < history.samples.size(); ++i) {
      crossings +=
          std::abs(piece(history.samples[i].deflection[0]) - piece(history.samples[i - 1].deflection[0]));
    }
    EXPECT_GT(crossings, 4);
    EXPECT_EQ(static_cast<int>(history.events.size()), crossings);
    EXPECT_EQ(history.statistics.restarts, static_cast<long>(history.events.size()) + 1);
    EXPECT_LT(history.statistics.steps, 200 * (crossings + 10));
    EXPECT_LT(history.energy_error, 1e-5);
    EXPECT_GT(history.samples.back().work.lost, 0.0);
    RecordProperty("events", static_cast<int>(history.events.size()));
    RecordProperty("steps", static_cast<int>(history.statistics.steps));
  }
}

TEST(ElasticJoint, BacklashLetsTheLinkFlyFreely) {
  const double gap = 0.01, speed = 0.02, H = 2.0, K = 50.0;
  auto run = validation::at_rest(
      test::one_joint(H, 1.0, multibody::DeflectionLaw({{0.0, 0.0, 0.0, 0.0}, {gap, K, 0.0, 0.0}})),
      Drive::locked(), 20.0, 1e-11);
  run.initial.v[0] = speed;
  run.tolerances = {1e-13, 1e-13};  // of angles of 1e-2 and an energy of 4e-4 J
  const auto history = multibody::simulate(run);
  ASSERT_TRUE(history.report.usable()) << history.report.message;
  // Free flight over 4 gaps and one half period on each side.
  const double period = 4.0 * gap / speed + 2.0 * pi * std::sqrt(H / K);
  const auto zeros = rising_zeros(history);
  ASSERT_GT(zeros.size(), 3U);
  EXPECT_NEAR((zeros.back() - zeros.front()) / static_cast<double>(zeros.size() - 1) / period, 1.0, 1e-6);
  EXPECT_LT(history.energy_error, 1e-7);  // some 4000 steps at 1e-11, all of which lose
}

TEST(ElasticJoint, DryFrictionStopsTheMotorAndKeepsIt) {
  // A free motor against Coulomb friction alone stops after B w/T, having turned B w^2/(2 T); then nothing
  // creeps.
  const double B = 4.0, T = 3.0, w = 0.6;
  auto arm = test::one_joint(1.0, B, multibody::DeflectionLaw::linear(0.0, 0.0));
  arm.joints[0].friction = {T, T, 1e-3, 0.0};
  auto run = validation::at_rest(arm, Drive::limp(), 10.0, 1e-9);
  run.initial.motor_rate[0] = w;
  const auto history = multibody::simulate(run);
  ASSERT_TRUE(history.report.usable()) << history.report.message;
  ASSERT_EQ(history.events.size(), 1U);
  EXPECT_EQ(history.events[0].what, "friction");
  EXPECT_NEAR(history.events[0].time, B * w / T, 1e-8);
  EXPECT_NEAR(history.samples.back().state.motor[0], B * w * w / (2.0 * T), 1e-8);
  EXPECT_EQ(history.samples.back().state.motor_rate[0], 0.0);
  EXPECT_NEAR(history.samples.back().work.lost, 0.5 * B * w * w, 1e-8);
}

TEST(ElasticJoint, BackDriveTorqueHoldsALimpJointUntilTheLoadExceedsIt) {
  const double back_drive = 10.0, K = 1000.0;
  auto arm = test::one_joint(2.0, 4.0, multibody::DeflectionLaw::linear(K, 20.0));
  arm.joints[0].back_drive = back_drive;
  for (const double moment : {4.9, 20.0}) {
    auto run = validation::at_rest(arm, Drive::limp(), 4.0, 1e-8);
    // A constant moment on a spring swings to twice its static deflection, so 4.9 N m stays below 10 and 20
    // does not.
    run.loads.push_back({1,
                         {{0.0, 0.0, moment}, Eigen::Vector3d::Zero()},
                         0.5,
                         100.0,
                         multibody::TimedLoad::Shape::constant});
    const auto history = multibody::simulate(run);
    ASSERT_TRUE(history.report.usable()) << history.report.message;
    const double turned = history.samples.back().state.motor[0];
    if (moment < back_drive) {
      EXPECT_EQ(turned, 0.0);
    } else {
      EXPECT_GT(turned, 1.0);  // (20 - 10)/(2 + 4) * 3.5^2 / 2 = 10 rad
    }
    EXPECT_LT(history.energy_error, 1e-5);
  }
}

TEST(ElasticJoint, ServoAtItsLimitPushesWithTheLimit) {
  // Rigidly geared: 2 + 4 kg m^2 under the limit of 3 N m accelerate with 0.5 rad/s^2, while the course is
  // far away.
  auto arm = test::one_joint(2.0, 4.0, multibody::DeflectionLaw::linear(1e5, 1e3));
  Drive drive = Drive::holding(100.0, 50.0, 20.0, 3.0);
  auto run = validation::at_rest(arm, drive, 4.0, 1e-8);
  const auto history = multibody::simulate(run);
  ASSERT_TRUE(history.report.usable()) << history.report.message;
  EXPECT_NEAR(history.samples.back().drive_torque[0], 3.0, 1e-12);
  EXPECT_NEAR(history.samples.back().state.motor[0], 0.25 * 16.0,
              1e-3);  // the gear's deflection is some 1e-5
  EXPECT_LT(history.energy_error, 1e-6);
}

TEST(ElasticJoint, DrivesSwitchAtATimeOrATorque) {
  auto arm = test::one_joint(2.0, 4.0, multibody::DeflectionLaw::linear(1000.0, 10.0));
  auto run = validation::at_rest(arm, Drive::locked(), 3.0, 1e-8);
  run.initial.v[0] = 0.1;
  run.tolerances = {1e-11, 1e-11};  // the energy is 0.01 J
  multibody::DriveSwitch to_limp;
  to_limp.time = 0.25;
  to_limp.joint = 0;
  to_limp.torque = 1.0;
  to_limp.drives = {Drive::limp()};
  multibody::DriveSwitch to_locked;
  to_locked.time = 2.0;
  to_locked.drives = {Drive::locked()};
  run.switches = {to_limp, to_locked};
  const auto history = multibody::simulate(run);
  ASSERT_TRUE(history.report.usable()) << history.report.message;
  std::vector<double> times;
  for (const auto& event : history.events) {
    if (event.what == "switch") times.push_back(event.time);
  }
  ASSERT_EQ(times.size(), 2U);
  EXPECT_GE(times[0], 0.25);
  EXPECT_LT(times[0], 0.6);
  EXPECT_EQ(times[1], 2.0);
  EXPECT_EQ(history.samples.back().state.motor_rate[0], 0.0);
  EXPECT_LT(history.energy_error, 1e-5);  // the brake's loss is counted
}

}  // namespace snare
