#include "multibody/arm/arm_file.hpp"
#include "tests/multibody/valid_arm.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

namespace snare {

namespace {

multibody::ArmDescription shipped(const std::string& name) {
  return multibody::read_arm(std::filesystem::path(SNARE_SOURCE_DIR) / "data" / "arms" / name);
}

}  // namespace

TEST(ArmFile, ShippedArmsHaveTheirPublishedSums) {
  const auto ssrms = shipped("ssrms_like.toml");
  EXPECT_EQ(ssrms.arm.motors(), 7);
  EXPECT_NEAR(ssrms.arm_mass, 1505.32, 0.01);  // the sum of set 2
  const auto jemrms = shipped("jemrms_like.toml");
  EXPECT_EQ(jemrms.arm.motors(), 6);
  EXPECT_NEAR(jemrms.arm_mass, 780.0, 1e-9);
  EXPECT_NEAR(multibody::reach(jemrms), 9.9, 1e-9);
  const auto station = shipped("ssrms_on_station.toml");
  EXPECT_EQ(station.arm.tree.velocities(), 13);
  EXPECT_NEAR(station.arm.tree.mass(), 400000.0 + 1505.32, 0.01);
  const auto loaded = shipped("jemrms_with_payload.toml");
  EXPECT_NEAR(loaded.arm.tree.mass(), 1280.0, 1e-9);
}

TEST(ArmFile, DynamicsOfTheUrdfAreFrictionWhereTheFileHasNone) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("snare_arm_dynamics_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "two_links.urdf") << test::edited(
      test::valid_urdf, "velocity=\"1\"/>", "velocity=\"1\"/><dynamics damping=\"0.7\" friction=\"3.5\"/>");
  const multibody::ArmDescription of_urdf = multibody::parse_arm(folder / "x.toml", test::valid_arm);
  EXPECT_EQ(of_urdf.arm.joints[0].friction.viscous, 0.7);
  EXPECT_EQ(of_urdf.arm.joints[0].friction.coulomb, 3.5);
  EXPECT_EQ(of_urdf.arm.joints[0].friction.breakaway, 3.5);
  EXPECT_EQ(of_urdf.arm.joints[1].friction.viscous, 0.0);
  const multibody::ArmDescription of_file = multibody::parse_arm(
      folder / "x.toml",
      test::edited(test::valid_arm, "[every_joint]\n", "[every_joint]\ncoulomb_Nm = 0.5\n"));
  EXPECT_EQ(of_file.arm.joints[0].friction.viscous, 0.7);
  EXPECT_EQ(of_file.arm.joints[0].friction.coulomb, 0.5);
  std::filesystem::remove_all(folder);
}

TEST(ArmFile, NumbersLikelyInAnotherUnitAreDoubted) {
  const auto warnings = [](const char* from, const char* to) {
    return multibody::parse_urdf("x.urdf", test::edited(test::valid_urdf, from, to)).warnings;
  };
  EXPECT_THAT(multibody::parse_urdf("x.urdf", test::valid_urdf).warnings, testing::IsEmpty());
  EXPECT_THAT(
      warnings("lower=\"-3\" upper=\"3\"", "lower=\"-180\" upper=\"180\""),
      testing::ElementsAre("joint shoulder: its limits of -180 to 180 rad are more than a turn: are they in "
                           "degrees? URDF is in radians"));
  EXPECT_THAT(warnings("lower=\"-3\" upper=\"3\"", "lower=\"-6.2832\" upper=\"6.2832\""), testing::IsEmpty());
  // sqrt(9e5 / 10) = 300 m on an arm of 1.7 m.
  EXPECT_THAT(warnings("ixx=\"0.1\" ixy=\"0\" ixz=\"0\" iyy=\"0.9\" iyz=\"0\" izz=\"0.9\"",
                       "ixx=\"1e5\" ixy=\"0\" ixz=\"0\" iyy=\"9e5\" iyz=\"0\" izz=\"9e5\""),
              testing::ElementsAre(
                  "link upper: its radius of gyration of 300 m is larger than the robot's reach of 1.7 "
                  "m: is the inertia in kg mm2? URDF is in kg m2"));
  for (const char* file :
       {"ssrms_like.toml", "jemrms_like.toml", "ssrms_on_station.toml", "jemrms_with_payload.toml"})
    EXPECT_THAT(shipped(file).warnings, testing::IsEmpty()) << file;
}

TEST(ArmFile, TheHeavySsrmsHasTheMassAndLengthOfHonda) {
  const auto arm = shipped("ssrms_like_1800kg.toml");
  // The base end effector, 243.66 kg, stands on the world.
  EXPECT_NEAR(arm.arm.tree.mass() + 243.66, 1800.0, 1.0);
  multibody::Kinematics kinematics(arm.arm.tree);
  multibody::place(arm.arm.tree, arm.coordinates(arm.poses[0].angles), kinematics);
  EXPECT_NEAR(multibody::frame_pose(arm.arm.tree, kinematics, arm.tip).p.x(), 17.6, 1e-3);
}

TEST(ArmFile, BodiesAreThoseOfTheirSources) {
  struct Case {
    const char* file;
    double mass;
    Eigen::Vector3d moments;
  };
  // HTV: a uniform cylinder of 16 t, 9.8 m, 4.4 m. Visitor: a uniform sphere of 1.3 m radius, rounded.
  const double htv_axial = 0.5 * 16000.0 * 2.2 * 2.2,
               htv_across = 16000.0 * (3.0 * 2.2 * 2.2 + 9.8 * 9.8) / 12.0;
  for (const Case& c : {Case{"htv_like.urdf", 16000.0, {htv_axial, htv_across, htv_across}},
                        Case{"visitor_small.urdf", 1300.0, Eigen::Vector3d::Constant(0.4 * 1300.0 * 1.69)},
                        Case{"air_table_body.urdf", 8.9, Eigen::Vector3d::Constant(0.16)},
                        Case{"payload_abiko.urdf", 500.0, {415.0, 83.0, 415.0}}}) {
    const auto robot =
        multibody::read_urdf(std::filesystem::path(SNARE_SOURCE_DIR) / "data" / "arms" / c.file);
    double mass = 0.0;
    Eigen::Vector3d moments = Eigen::Vector3d::Zero();
    for (const auto& link : robot.links) {
      mass += link.inertia.mass;
      moments += link.inertia.about_own_centre().diagonal();
    }
    EXPECT_NEAR(mass, c.mass, 1e-9) << c.file;
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(moments[k] / c.moments[k], 1.0, 0.03) << c.file;
  }
}

TEST(ArmFile, VisitorsAtTheTipLowerTheFirstFrequency) {
  // With a point mass far heavier than the arm the first frequency falls as 1/sqrt(mass): 16 t against 1.3 t.
  const std::vector<multibody::Drive> locked(7, multibody::Drive::locked());
  const auto first = [&](const std::string& name) {
    const auto arm = shipped(name);
    return multibody::natural_modes(arm.arm, arm.coordinates(arm.poses[0].angles), locked)[0].frequency;
  };
  const double bare = first("ssrms_like.toml"), visitor = first("ssrms_with_visitor.toml"),
               htv = first("ssrms_with_htv.toml");
  EXPECT_LT(visitor, bare);
  EXPECT_LT(htv, visitor);
  EXPECT_LT(visitor / htv, std::sqrt(16000.0 / 1300.0) * 1.2);
  EXPECT_GT(visitor / htv, 0.6 * std::sqrt(16000.0 / 1300.0));
}

TEST(ArmFile, JointsOfTheJemrmsAreThoseOfTable2) {
  const auto arm = shipped("jemrms_like.toml");
  const auto& pieces = arm.arm.joints[0].spring.pieces();
  ASSERT_EQ(pieces.size(), 3U);
  // In SI as converted by hand: 716 and 27215 N m/rad; 2802, 5002, 1008 N m s/rad.
  EXPECT_NEAR(pieces[0].stiffness, 716.0, 0.5);
  EXPECT_NEAR(pieces[1].stiffness, 27215.0, 1.0);
  EXPECT_NEAR(pieces[2].stiffness, 27215.0, 1.0);
  EXPECT_NEAR(pieces[0].damping, 2802.0, 0.5);
  EXPECT_NEAR(pieces[1].damping, 5002.0, 0.5);
  EXPECT_NEAR(pieces[2].damping, 1008.0, 0.5);
  EXPECT_NEAR(pieces[1].from, 0.04 * EIGEN_PI / 180.0, 1e-15);
  EXPECT_NEAR(arm.arm.joints[0].motor_inertia, 80.0, 1e-9);
}

TEST(ArmFile, ThePoseOfAUrdfIsRollPitchYaw) {
  // A link turned by 90 deg about z, then one metre along its own x.
  const std::string text =
      "<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='fixed'><parent link='a'/><child "
      "link='b'/><origin xyz='1 2 3' rpy='0 0 1.5707963267948966'/></joint><link name='c'/><joint name='k' "
      "type='fixed'><parent link='b'/><child link='c'/><origin xyz='1 0 0'/></joint></robot>";
  multibody::Tree tree;
  multibody::add_robot(tree, 0, multibody::RootJoint::fixed, multibody::parse_urdf("r.urdf", text));
  const Eigen::Vector3d p = tree.frame(tree.find_frame("c")).X_BF.p;
  EXPECT_NEAR((p - Eigen::Vector3d(1.0, 3.0, 3.0)).norm(), 0.0, 1e-15);
}

TEST(ArmFile, HeldSsrmsWithItsCapacityIsNearTheShuttlesFrequency) {
  auto arm = shipped("ssrms_like.toml");
  const int frame = arm.tip;
  arm.arm.tree.add_fixed(
      frame, "load", {},
      multibody::SpatialInertia::about_centre(116000.0, {3.0, 0.0, 0.0}, 1e6 * Eigen::Matrix3d::Identity()));
  const auto modes = multibody::natural_modes(arm.arm, arm.coordinates(arm.poses[0].angles),
                                              std::vector<multibody::Drive>(7, multibody::Drive::locked()));
  EXPECT_GT(modes[0].frequency, 0.01);  // the stiffness is assumed: order of magnitude only
  EXPECT_LT(modes[0].frequency, 0.06);
}

}  // namespace snare
