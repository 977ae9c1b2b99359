#include "scenario/arm_scenarios.hpp"

#include "multibody/dynamics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace snare {

namespace {

using scenario::Hold;

multibody::ArmDescription shipped(const std::string& name) {
  return multibody::read_arm(std::filesystem::path(SNARE_SOURCE_DIR) / "data" / "arms" / name);
}

/// The constants of Abiko et al., Table 2, in degrees as printed; the continuous reading.
double torque_of_table2(double degrees) {
  const double size = std::abs(degrees);
  return (degrees < 0 ? -1.0 : 1.0) * (size < 0.04 ? 12.5 * size : 0.5 + 475.0 * (size - 0.04));
}
double damping_of_table2(double degrees) {
  const double size = std::abs(degrees);
  return size < 0.04 ? 48.9 : size < 0.06 ? 87.3 : 17.6;
}

struct ReferenceSwing {
  double begin, end, peak;
};

/// One inertia on Table 2 by Runge and Kutta with steps too small for the jumps to matter. [deg, s, kg m^2]
std::vector<ReferenceSwing> reference_swings(double inertia, double start, double end) {
  const double per_degree = 180.0 / EIGEN_PI, h = 2e-5;
  const auto acceleration = [&](double d, double v) {
    return -(torque_of_table2(d) + damping_of_table2(d) * v) * per_degree / inertia;
  };
  std::vector<ReferenceSwing> found;
  double d = start, v = 0.0, zero = -1.0, peak = 0.0;
  for (int i = 0; i * h < end; ++i) {
    const double a1 = acceleration(d, v), v2 = v + 0.5 * h * a1, a2 = acceleration(d + 0.5 * h * v, v2);
    const double v3 = v + 0.5 * h * a2, a3 = acceleration(d + 0.5 * h * v2, v3), v4 = v + h * a3;
    const double a4 = acceleration(d + h * v3, v4), before = d;
    d += h / 6.0 * (v + 2 * v2 + 2 * v3 + v4);
    v += h / 6.0 * (a1 + 2 * a2 + 2 * a3 + a4);
    if (std::abs(d) > std::abs(peak)) peak = d;
    if ((d < 0) != (before < 0)) {
      const double now = (i + before / (before - d)) * h;
      if (zero >= 0) found.push_back({zero, now, peak});
      zero = now;
      peak = 0.0;
    }
  }
  return found;
}

}  // namespace

TEST(ArmScenarios, StepOfTheJemrmsJointVibratesAsTable2Says) {
  auto arm = shipped("jemrms_like.toml");
  // The other joints stay rigid in the reference, so give them none of their softness here.
  for (std::size_t k = 1; k < arm.arm.joints.size(); ++k) {
    arm.arm.joints[k].spring = multibody::DeflectionLaw::linear(1e9, 1e6);
  }
  const double degree = EIGEN_PI / 180.0, step = 0.5;
  auto run = scenario::joint_step(arm, arm.poses[0].angles, 0, step * degree, 60.0);
  run.ida.relative_tolerance = 1e-8;
  const auto history = multibody::simulate(run);
  ASSERT_TRUE(history.report.usable()) << history.report.message;
  const auto found = scenario::swings(history, arm.arm, 0);

  multibody::DynamicsWorkspace workspace(arm.arm.tree);
  const double inertia = multibody::mass_matrix(arm.arm.tree, run.initial.q, workspace)(0, 0);
  const auto expected = reference_swings(inertia, -step, 60.0);
  ASSERT_GE(found.size(), 4U);
  ASSERT_GE(expected.size(), 4U);
  // The first two vibrations are four swings. The reference is good to some 1e-5 (its steps across the jumps
  // of the damping, 2e-5 s of some 0.1 s); the nearly rigid joints add some 27215/1e9 = 3e-5 of softness.
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(found[i].begin / expected[i].begin, 1.0, 3e-4) << i;
    EXPECT_NEAR(found[i].end / expected[i].end, 1.0, 3e-4) << i;
    EXPECT_NEAR(found[i].peak / (expected[i].peak * degree), 1.0, 1e-3) << i;
  }
  // What the paper tells: the frequency varies with the amplitude; and it decays.
  EXPECT_LT(found[3].frequency(), found[0].frequency());
  EXPECT_LT(found.back().frequency(), 0.9 * found[0].frequency());
  EXPECT_LT(std::abs(found[3].peak), 0.8 * std::abs(found[0].peak));
  EXPECT_LT(history.energy_error, 1e-5);
  RecordProperty("frequency_1_Hz", std::to_string(found[0].frequency()));
  RecordProperty("frequency_4_Hz", std::to_string(found[3].frequency()));
}

TEST(ArmScenarios, LiteralTable2AtAllJointsRunsThrough) {
  // The loads of the swinging arm hold joints at the jump for a while; with true jumps this run ends there.
  auto arm = shipped("jemrms_like.toml");
  const double degree = EIGEN_PI / 180.0;
  for (multibody::ElasticJoint& joint : arm.arm.joints) {
    joint.spring = multibody::DeflectionLaw({{0.0, 12.5 / degree, 48.9 / degree},
                                             {0.04 * degree, 475.0 / degree, 87.3 / degree},
                                             {0.06 * degree, 475.0 / degree, 17.6 / degree}},
                                            multibody::StiffnessReading::literal,
                                            multibody::DampingRate::deflection, 4e-4 * degree);
  }
  auto run = scenario::joint_step(arm, arm.poses[1].angles, 2, 0.5 * degree, 20.0);
  run.ida.relative_tolerance = 1e-6;
  run.tolerances.coordinate = run.tolerances.rate = 1e-8;
  const auto history = multibody::simulate(run);
  ASSERT_TRUE(history.report.usable()) << history.report.message;
  EXPECT_GT(history.events.size(), 10U);
  EXPECT_LT(history.statistics.steps, 60L * static_cast<long>(history.events.size()));
  EXPECT_LT(history.energy_error, 1e-3);
  RecordProperty("events", static_cast<int>(history.events.size()));
  RecordProperty("steps", static_cast<int>(history.statistics.steps));
}

TEST(ArmScenarios, HeldArmSwingsBackAndTheLimpArmDoesNot) {
  const auto arm = shipped("ssrms_like.toml");
  const Eigen::VectorXd pose = arm.poses[1].angles;
  const auto drift = [&](Hold hold) {
    auto run = scenario::tip_impulse(arm, pose, hold, {0.0, 200.0, 0.0}, 0.5, 60.0);
    run.sample = 0.1;
    const auto history = multibody::simulate(run);
    EXPECT_TRUE(history.report.usable()) << history.report.message;
    EXPECT_LT(history.energy_error, 1e-4);
    EXPECT_GT(history.samples.back().work.loads, 0.0);
    return (history.samples.back().state.q - history.samples.front().state.q).norm();
  };
  const double held = drift(Hold::as_described), limp = drift(Hold::limp);
  EXPECT_LT(held, 1e-3);
  EXPECT_GT(limp, 20.0 * held);
}

TEST(ArmScenarios, FreeBaseAnswersTheArmAndKeepsTheMomentum) {
  const auto arm = shipped("ssrms_on_station.toml");
  const Eigen::VectorXd from = Eigen::VectorXd::Zero(7), to = arm.poses[0].angles;
  auto run = scenario::joint_motion(arm, from, to, 100.0, 120.0);
  run.sample = 1.0;
  const auto history = multibody::simulate(run);
  ASSERT_TRUE(history.report.usable()) << history.report.message;
  const auto& first = history.samples.front();
  const auto& last = history.samples.back();
  // From rest to rest: the centre of mass of the whole has not moved, the base has.
  multibody::Kinematics before(arm.arm.tree), after(arm.arm.tree);
  multibody::place(arm.arm.tree, first.state.q, before);
  multibody::place(arm.arm.tree, last.state.q, after);
  const Eigen::Vector3d moved =
      multibody::centre_of_mass(arm.arm.tree, after) - multibody::centre_of_mass(arm.arm.tree, before);
  const double base = (last.state.q.head<3>() - first.state.q.head<3>()).norm();
  EXPECT_GT(base, 1e-3);
  EXPECT_LT(moved.norm(), 1e-6 * base);  // a momentum of zero, integrated at 1e-7
  double largest = 0.0, scale = 0.0;
  for (const auto& sample : history.samples) {
    largest = std::max(largest, sample.momentum.force.norm());
    scale = std::max(scale, 1505.0 * (sample.state.v.tail<7>().norm()));
  }
  EXPECT_LT(largest, 1e-6 * scale);
  EXPECT_LT(history.energy_error, 1e-4);
}

// A link that begins with a speed swings on its spring; the motor behind it does not go along, and no energy
// comes in.
TEST(ArmScenarios, ABrakeHoldsItsMotorFromTheStart) {
  const auto arm = shipped("bench_arm.toml");
  auto run = scenario::joint_step(arm, arm.poses[0].angles, 0, 0.0, 0.5);
  run.initial.v[0] = run.initial.motor_rate[0] = 0.1;
  const auto history = multibody::simulate(run);
  ASSERT_TRUE(history.report.usable()) << history.report.message;
  for (const multibody::ArmSample& s : history.samples) EXPECT_EQ(s.state.motor[0], run.initial.motor[0]);
  EXPECT_LT(history.energy_error, 1e-4);
}

}  // namespace snare
