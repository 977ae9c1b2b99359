#include "scenario/scenario.hpp"

#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace snare::scenario {
namespace {

using Eigen::Vector3d;

std::filesystem::path shipped(const std::string& name) {
  return std::filesystem::path(SNARE_SOURCE_DIR) / "data" / "scenarios" / name;
}

/// The first motion of a scenario.
NamedMotion first_run(const std::filesystem::path& file, const std::vector<base::Override>& overrides = {}) {
  return std::get<WireMotions>(read_scenario(file, overrides).content).runs.at(0);
}

TEST(ArmContactScenario, TheWireRidesOnTheTipWhereItIsAsked) {
  const coupling::Motion motion = first_run(shipped("jemrms_capture.toml")).motion;
  ASSERT_EQ(motion.arms.size(), 1U);
  ASSERT_EQ(motion.mounts.size(), 2U);
  EXPECT_TRUE(motion.welds.empty());
  const multibody::Tree& tree = motion.arms[0].arm.tree;
  multibody::Kinematics kinematics(tree);
  multibody::place(tree, motion.arms[0].start.q, kinematics);
  const multibody::Pose tip = multibody::frame_pose(tree, kinematics, motion.mounts[0].carrier.frame);
  EXPECT_NEAR((tip.p - Vector3d(0.0875, 0.05, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((tip.R.col(0) + Vector3d::UnitY()).norm(), 0.0, 1e-12);  // the hand's axis points at the wire
}

TEST(ArmContactScenario, AnArmThatCarriesTheBodyStartsWithItsMotion) {
  const coupling::Motion motion = first_run(shipped("jemrms_payload_on_wire.toml")).motion;
  ASSERT_EQ(motion.welds.size(), 1U);
  const multibody::Tree& tree = motion.arms[0].arm.tree;
  multibody::Kinematics kinematics(tree);
  multibody::place(tree, motion.arms[0].start.q, kinematics);
  multibody::set_moving(tree, motion.arms[0].start.v, kinematics);
  const multibody::FrameMotion tip = multibody::frame_motion(tree, kinematics, motion.welds[0].carrier.frame);
  EXPECT_NEAR((tip.linear - Vector3d(0.0, 0.01, 0.0)).norm(), 0.0, 1e-10);  // six joints can give it exactly
  EXPECT_NEAR(tip.angular.norm(), 0.0, 1e-10);
}

TEST(ArmContactScenario, MistakesInAllFilesAreListedAtOnce) {
  EXPECT_THAT(
      test::refusal([&] {
        return read_scenario(shipped("jemrms_capture.toml"),
                             {{"carries", "probe"}, {"pose", "crooked"}, {"contact.wire.diameter_mm", "-1.0"}});
      }),
      testing::AllOf(testing::HasSubstr("--set: carries = probe, must be \"wire\" or \"body\""),
                     testing::HasSubstr("--set: pose = crooked, must be a pose of the arm: \"straight\", \"bent\""),
                     testing::HasSubstr("wire.diameter_mm = -1.0")));
}

TEST(ArmContactScenario, ALawNeedsAWireThatStands) {
  const auto folder = std::filesystem::temp_directory_path() / "snare_arm_contact_law";
  std::filesystem::create_directories(folder);
  std::filesystem::copy_file(shipped("air_table.toml"), folder / "air_table.toml",
                             std::filesystem::copy_options::overwrite_existing);
  std::ofstream(folder / "x.toml")
      << "schema = \"snare-scenario/1\"\nkind = \"arm_contact\"\ntitle = \"t\"\narm = \""
      << (std::filesystem::path(SNARE_SOURCE_DIR) / "data/arms/jemrms_like.toml").string()
      << "\"\npose = \"bent\"\ncontact = \"air_table.toml\"\ncarries = \"wire\"\nhold = \"limp\"\n";
  EXPECT_THAT(test::refusal([&] { return read_scenario(folder / "x.toml"); }),
              testing::HasSubstr("x.toml:7: carries = \"wire\", must be \"body\" with the model quadratic of Table 4"));
  std::filesystem::remove_all(folder);
}

TEST(ArmContactScenario, ADragAgainstTheWorldNeedsAWireThatStands) {
  const auto read = [](const char* name) {
    return first_run(shipped(name), {{"contact.damping.mass_rate_1_s", "5.0"}});
  };
  EXPECT_EQ(read("jemrms_payload_on_wire.toml").motion.wires[0].rod.damping.mass_rate, 5.0);
  EXPECT_THAT(test::refusal([&] { return read("jemrms_capture.toml"); }),
              testing::HasSubstr("contact = \"jemrms_capture_contact.toml\", has damping.mass_rate_1_s"));
}

/// A short run of the shipped capture, begun just before the touch.
coupling::MotionResult run(const std::string& name, double duration, double& arm_moved) {
  const NamedMotion asked = first_run(shipped(name), {{"contact.solver.elements", "24"},
                                                      {"contact.body.distance_mm", "0.02"},
                                                      {"duration_s", std::to_string(duration)}});
  const Eigen::VectorXd start = asked.motion.arms[0].start.v;
  return coupling::simulate(asked.motion, asked.options, [&](const coupling::MotionSample& sample) {
    arm_moved = std::max(arm_moved, (sample.arms[0].state.v - start).norm());
    return false;
  });
}

TEST(ArmContactScenario, CaptureKeepsItsBalances) {
  for (const char* name : {"jemrms_capture.toml", "jemrms_payload_on_wire.toml"}) {
    double arm_moved = 0.0;
    const coupling::MotionResult result = run(name, 0.05, arm_moved);
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

}  // namespace
}  // namespace snare::scenario
