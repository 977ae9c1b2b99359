// Links that bend.
#include "multibody/arm/arm_file.hpp"

#include "tests/support/folder_fixture.hpp"
#include "tests/support/refusal.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace snare::multibody {
namespace {

using testing::HasSubstr;

class FlexibleLink : public test::FolderFixture {
 protected:
  /// A light beam of 2 m on a stiff joint about z, with 10 kg at its end.
  ArmDescription beam(const std::string& link) const {
    const std::string small =
        R"(<inertia ixx="1e-3" ixy="0" ixz="0" iyy="1e-3" iyz="0" izz="1e-3"/></inertial></link>)";
    write("beam.urdf", fmt::format(R"(<robot name="beam"><link name="stand"/>
<link name="beam"><inertial><origin xyz="0 0 0" rpy="0 0 0"/><mass value="0.01"/>{0}
<link name="end"><inertial><origin xyz="0 0 0" rpy="0 0 0"/><mass value="10"/>{0}
<joint name="hinge" type="continuous"><parent link="stand"/><child link="beam"/><axis xyz="0 0 1"/></joint>
<joint name="grip" type="fixed"><parent link="beam"/><child link="end"/><origin xyz="2 0 0" rpy="0 0 0"/></joint></robot>)",
                                   small));
    return read_arm(write("arm.toml", R"(schema = "snare-arm/1"
title = "a beam"
source = "made up"
urdf = "beam.urdf"
tip = "end"
[joint.hinge]
law = "linear"
stiffness_Nm_rad = 1e7
damping_Nms_rad = 1.0
motor_inertia_kg_m2 = 1.0
drive = "locked"
[[pose]]
name = "turned"
angles_deg = [30.0]
)" + link));
  }
};

// The beam with a heavy end: f = sqrt(3 EI/(m L^3))/(2 pi), either way; the inertia of the two bodies about
// themselves takes 2.5e-5 of it.
TEST_F(FlexibleLink, SwingsAsTheBeamWithAHeavyEnd) {
  constexpr double stiffness = 150.0, length = 2.0, mass = 10.0;  // EI [N m^2]
  const ArmDescription arm =
      beam(fmt::format("[link.beam]\nbending_compliance_rad_Nm = {:.17g}\n", length / (3.0 * stiffness)));
  const double beam = std::sqrt(3.0 * stiffness / (mass * std::pow(length, 3))) / (2.0 * std::numbers::pi);
  const auto modes = natural_modes(arm.arm, arm.coordinates(arm.poses[0].angles), arm.drives);
  ASSERT_EQ(modes.size(), 3U);
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(modes[static_cast<std::size_t>(k)].frequency, beam, 1e-4 * beam);
}

// At the limit of a rigid link the frequencies are those without it.
TEST_F(FlexibleLink, StiffensToTheRigidArm) {
  const std::filesystem::path ssrms = std::filesystem::path(SNARE_SOURCE_DIR) / "data/arms/ssrms_like.toml";
  const ArmDescription rigid = read_arm(ssrms);
  const ArmDescription stiff = read_arm(ssrms, {{"link.ssrms_boom_1.bending_compliance_rad_Nm", "1e-12"}});
  const auto frequencies = [](const ArmDescription& arm) {
    return natural_modes(arm.arm, arm.coordinates(arm.poses.back().angles), arm.drives);
  };
  const auto expected = frequencies(rigid), found = frequencies(stiff);
  ASSERT_EQ(found.size(), expected.size() + 2);
  for (std::size_t k = 0; k < expected.size(); ++k)
    EXPECT_NEAR(found[k].frequency, expected[k].frequency, 1e-4 * expected[k].frequency + 1e-9);
  EXPECT_NEAR(stiff.arm.tree.mass(), rigid.arm.tree.mass(), 1e-9);
}

TEST_F(FlexibleLink, PosesAndJointsKnowNothingOfIt) {
  const ArmDescription arm =
      beam("[link.beam]\nbending_compliance_rad_Nm = 1e-3\nbending_damping_time_s = 0.02\n");
  ASSERT_EQ(arm.joints.size(), 1U);
  ASSERT_EQ(arm.arm.motors(), 3);
  ASSERT_EQ(arm.poses[0].angles.size(), 3);
  EXPECT_NEAR(arm.poses[0].angles[0], std::numbers::pi / 6.0, 1e-15);
  EXPECT_EQ(arm.poses[0].angles.tail<2>().norm(), 0.0);
  for (const ElasticJoint& joint : arm.arm.joints) EXPECT_EQ(joint.link, "beam");
  EXPECT_FALSE(arm.arm.joints[0].flexure);
  for (std::size_t k : {1U, 2U}) {
    EXPECT_TRUE(arm.arm.joints[k].flexure);
    EXPECT_EQ(arm.drives[k].mode, DriveMode::locked);
    EXPECT_NEAR(arm.arm.joints[k].spring.pieces()[0].stiffness, 1e3, 1e-9);
    EXPECT_NEAR(arm.arm.joints[k].spring.pieces()[0].damping, 20.0, 1e-9);
  }
}

TEST_F(FlexibleLink, WhatCannotBendIsRefused) {
  const char* needed =
      "bending_compliance_rad_Nm = 1e-3, only of a link on a moving joint that has a mass and a length";
  EXPECT_THAT(test::refusal([&] { return beam("[link.end]\nbending_compliance_rad_Nm = 1e-3\n"); }),
              HasSubstr(needed));
  EXPECT_THAT(test::refusal([&] { return beam("[link.stand]\nbending_compliance_rad_Nm = 1e-3\n"); }),
              HasSubstr(needed));
  EXPECT_THAT(test::refusal([&] { return beam("[link.beam]\nbending_compliance_rad_Nm = 1e-300\n"); }),
              HasSubstr("must be 0, or 1e-15 to 1000"));
  EXPECT_THAT(test::refusal([&] { return beam("[link.beam]\nbending_compliance_rad_Nm = -1e-3\n"); }),
              HasSubstr("must be >= 0 and <= 1000"));
}

}  // namespace
}  // namespace snare::multibody
