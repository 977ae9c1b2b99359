// What an arm carries: a wire on its tip, a body that is welded to it.

#include "scenario/arm_scenarios.hpp"
#include "scenario/scenario.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

namespace snare::scenario {
namespace {

using Eigen::Vector3d;

std::filesystem::path shipped(const std::string& name) {
  return std::filesystem::path(SNARE_SOURCE_DIR) / "data" / "scenarios" / name;
}

NamedMotion run_of(const std::string& name, const std::vector<std::string>& settings = {}) {
  return read_scenario(shipped(name), test::overrides(settings)).motions.runs.at(0);
}

TEST(Carried, TheWireRidesOnTheTipWhereItIsAsked) {
  const coupling::Motion motion = run_of("jemrms_capture.toml").motion;
  ASSERT_EQ(motion.arms.size(), 1U);
  ASSERT_EQ(motion.mounts.size(), 2U);
  EXPECT_TRUE(motion.welds.empty());
  const multibody::Tree& tree = motion.arms[0].arm.tree;
  multibody::Kinematics kinematics(tree);
  multibody::place(tree, motion.arms[0].start.q, kinematics);
  const multibody::Pose tip = multibody::frame_pose(tree, kinematics, motion.mounts[0].carrier.frame);
  EXPECT_NEAR((tip.p - Vector3d(0.0875, 0.05, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((tip.R.col(0) + Vector3d::UnitY()).norm(), 0.0, 1e-12);  // the hand's axis points at the wire
  EXPECT_NEAR((motion.wires[0].positions.col(0) - Vector3d::Zero()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((motion.wires[0].positions.col(40) - Vector3d(0.175, 0.0, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_GT(motion.wires[0].positions(1, 20), 0.018);
}

TEST(Carried, AnArmThatCarriesTheBodyStartsWithItsMotion) {
  const coupling::Motion motion = run_of("jemrms_payload_on_wire.toml").motion;
  ASSERT_EQ(motion.welds.size(), 1U);
  const multibody::Tree& tree = motion.arms[0].arm.tree;
  multibody::Kinematics kinematics(tree);
  multibody::place(tree, motion.arms[0].start.q, kinematics);
  multibody::set_moving(tree, motion.arms[0].start.v, kinematics);
  const multibody::FrameMotion tip = multibody::frame_motion(tree, kinematics, motion.welds[0].carrier.frame);
  EXPECT_NEAR((tip.linear - Vector3d(0.0, 0.01, 0.0)).norm(), 0.0, 1e-10);  // six joints can give it exactly
  EXPECT_NEAR(tip.angular.norm(), 0.0, 1e-10);
}

TEST(Carried, ADragAgainstTheWorldNeedsAWireThatStands) {
  const auto read = [](const char* name) { return run_of(name, {"damping.mass_rate_1_s=5.0"}); };
  EXPECT_EQ(read("jemrms_payload_on_wire.toml").motion.wires[0].rod.damping.mass_rate, 5.0);
  EXPECT_THAT(test::refusal([&] { return read("jemrms_capture.toml"); }),
              testing::HasSubstr("damping.mass_rate_1_s = 5.0, must be 0: it drags against the world"));
}

// Short runs, begun just before the touch.
TEST(Carried, CaptureKeepsItsBalances) {
  for (const char* name : {"jemrms_capture.toml", "jemrms_payload_on_wire.toml"}) {
    const NamedMotion asked = run_of(
        name,
        {"wires[wire].elements=24", "bodies[payload].position_mm=[-10.0, -487.96, 0.0]", "duration_s=0.05"});
    const Eigen::VectorXd start = asked.motion.arms[0].start.v;
    double arm_moved = 0.0;
    const coupling::MotionResult result =
        coupling::simulate(asked.motion, asked.options, [&](const coupling::MotionSample& sample) {
          arm_moved = std::max(arm_moved, (sample.arms[0].state.v - start).norm());
          return false;
        });
    ASSERT_TRUE(result.report.usable()) << name << ": " << result.report.message;
    ASSERT_FALSE(result.events.empty()) << name;
    EXPECT_GT(result.peak_force[0], 0.1) << name;
    EXPECT_GT(arm_moved, 1e-7) << name;
    const double energy = 0.5 * 500.0 * 0.01 * 0.01;  // of the payload
    EXPECT_LT(std::abs(result.energy.integrator), 2e-3 * energy) << name;
    EXPECT_LT(result.momentum_error.norm(), 1e-2 * result.impulse[0].norm() + 1e-5) << name;
    EXPECT_LT(result.largest_drift, 1e-6) << name;
  }
}

// The two ways of an arm alone, beside its own integration: a joint's motor that has jumped, and a push of
// half a sine at the tip.
TEST(Carried, AnArmAloneMovesAsByItself) {
  const auto largest = [](const std::string& name, int joint) {
    const NamedMotion run = run_of(name, {"duration_s=3.0"});
    double most = 0.0;
    const coupling::MotionResult result =
        coupling::simulate(run.motion, run.options, [&](const coupling::MotionSample& s) {
          if (s.time > 0.2) most = std::max(most, std::abs(s.arms[0].joint_torque[joint]));
          return false;
        });
    EXPECT_TRUE(result.report.usable()) << result.report.message;
    return most;
  };
  const auto alone = [](multibody::ArmScenario run, int joint, double sample) {
    run.sample = sample;
    double most = 0.0;
    for (const multibody::ArmSample& s : multibody::simulate(run).samples)
      if (s.time > 0.2) most = std::max(most, std::abs(s.joint_torque[joint]));
    return most;
  };
  const std::filesystem::path arms = std::filesystem::path(SNARE_SOURCE_DIR) / "data/arms";
  const multibody::ArmDescription jemrms = multibody::read_arm(arms / "jemrms_like.toml");
  // Both at tolerances of 1e-8 and better of some 1e-3 rad.
  EXPECT_NEAR(largest("jemrms_step.toml", 1) /
                  alone(joint_step(jemrms, jemrms.poses[1].angles, 2, 0.5 * EIGEN_PI / 180.0, 3.0), 1, 0.02),
              1.0, 1e-3);
  const multibody::ArmDescription ssrms = multibody::read_arm(arms / "ssrms_like.toml");
  Eigen::VectorXd pose(7);
  pose << 0, 0, 30, -60, 30, 0, 0;
  EXPECT_NEAR(
      largest("ssrms_push.toml", 5) /
          alone(tip_impulse(ssrms, pose * EIGEN_PI / 180.0, Hold::limp, {0.0, 20.0, 0.0}, 0.1, 3.0), 5, 0.02),
      1.0, 1e-3);
}

// Mounts that give are parts of the motion, wherever they stand; what the wire itself gives in its mount is
// its end cell's.
TEST(Carried, MountsGiveWhereTheyStandAndWhereTheyMove) {
  const std::string mount =
      "wires[wire].mount={kind=\"clamped\",translational_stiffness_N_m=42e3,translational_damping_Ns_m=5.0,"
      "slip_tension_N=30.0,rotational_stiffness_Nm_rad=0.6,side=\"right\"}";
  const coupling::Motion still =
      run_of("air_table.toml", {mount, "bodies[target].position_mm=[40.0,-97.0,0.0]"}).motion;
  ASSERT_EQ(still.mounts.size(), 1U);
  EXPECT_EQ(still.mounts[0].end, wire::End::right);
  EXPECT_EQ(still.mounts[0].carrier.kind, coupling::MotionCarrier::Kind::world);
  EXPECT_EQ(still.mounts[0].give.stiffness, 42e3);
  EXPECT_EQ(still.mounts[0].give.damping, 5.0);
  EXPECT_EQ(still.mounts[0].give.slip_force, 30.0);
  const wire::SpatialRodProperties& rod = still.wires[0].rod.properties;
  EXPECT_EQ(rod.right.rotational_stiffness, 0.6);
  EXPECT_TRUE(std::isinf(rod.left.rotational_stiffness));
  EXPECT_TRUE(std::isinf(rod.right.translational_stiffness));
  // The wire begins at rest: its buckled ends push the mount outward.
  EXPECT_GT(still.wires[0].positions(0, 40), 0.175 + 1e-4);
  EXPECT_EQ(still.wires[0].positions(0, 0), 0.0);

  const coupling::Motion carried =
      run_of("jemrms_capture.toml", {"wires[wire].mount={translational_stiffness_N_m=42e3}"}).motion;
  ASSERT_EQ(carried.mounts.size(), 2U);
  for (const coupling::MotionMount& m : carried.mounts) EXPECT_EQ(m.give.stiffness, 42e3);
}

TEST(Carried, WhatAMountCannotGiveIsRefused) {
  static constexpr test::WrongSetting wrong[] = {
      {"wires[wire].mount={translational_damping_Ns_m=5.0}", "only beside translational_stiffness_N_m"},
      {"wires[wire].mount={slip_tension_N=5.0}", "only beside translational_stiffness_N_m"},
      {"wires[wire].mount={kind=\"pinned\",rotational_stiffness_Nm_rad=1.0}", "only of clamped mounts"},
      {"wires[wire].mount={side=\"top\"}", "must be \"left\", \"right\" or \"both\""},
      {"wires[wire].mount={translational_stiffness_N_m=0.0}", "must be > 0 and"},
      {"wires[wire].mount={stiffness=1.0}", "unknown key"}};
  test::expect_refused(wrong, [](const char* s) { return run_of("air_table.toml", {s}); });
  EXPECT_THAT(test::refusal([] {
                return run_of("air_table.toml", {"wires[wire].model=\"quadratic\"",
                                                 "wires[wire].mount={translational_stiffness_N_m=42e3}"});
              }),
              testing::HasSubstr("a law stands for the wire and for what its mounts give"));
}

}  // namespace
}  // namespace snare::scenario
