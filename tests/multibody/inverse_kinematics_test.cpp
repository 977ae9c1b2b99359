#include "multibody/inverse_kinematics.hpp"

#include "multibody/arm/arm_file.hpp"
#include "multibody/kinematics.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace snare::multibody {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double pi = std::numbers::pi;

/// An arm of six hinges with a spherical wrist: turn, two links of 1 m and 0.8 m, wrist about x, y, x, tip
/// 0.2 m on.
Tree six_hinges() {
  Tree tree;
  const auto point = SpatialInertia::about_centre(1.0, Vector3d::Zero(), Matrix3d::Identity());
  int frame = tree.add_moving(0, "base", JointKind::revolute, Vector3d::UnitZ(), {}, point);
  frame = tree.add_moving(frame, "upper", JointKind::revolute, Vector3d::UnitY(), {}, point);
  frame = tree.add_moving(frame, "fore", JointKind::revolute, Vector3d::UnitY(),
                          {Matrix3d::Identity(), {1.0, 0.0, 0.0}}, point);
  frame = tree.add_moving(frame, "roll", JointKind::revolute, Vector3d::UnitX(),
                          {Matrix3d::Identity(), {0.8, 0.0, 0.0}}, point);
  frame = tree.add_moving(frame, "bend", JointKind::revolute, Vector3d::UnitY(), {}, point);
  frame = tree.add_moving(frame, "turn", JointKind::revolute, Vector3d::UnitX(), {}, point);
  tree.add_fixed(frame, "tip", {Matrix3d::Identity(), {0.2, 0.0, 0.0}});
  return tree;
}

std::vector<ReachingJoint> all(double limit) {
  std::vector<ReachingJoint> joints;
  for (int k = 0; k < 6; ++k) joints.push_back({k, -limit, limit});
  return joints;
}

/// The pose of the tip by its rotations, written out: no code of the tree.
Pose tip_of(const VectorXd& q) {
  const Matrix3d turn = AngleAxisd(q[0], Vector3d::UnitZ()).toRotationMatrix();
  const Matrix3d upper = turn * AngleAxisd(q[1], Vector3d::UnitY());
  const Matrix3d fore = upper * AngleAxisd(q[2], Vector3d::UnitY());
  const Matrix3d hand = fore * AngleAxisd(q[3], Vector3d::UnitX()) * AngleAxisd(q[4], Vector3d::UnitY()) *
                        AngleAxisd(q[5], Vector3d::UnitX());
  return {hand, upper.col(0) + 0.8 * fore.col(0) + 0.2 * hand.col(0)};
}

VectorXd angles(std::initializer_list<double> list) {
  VectorXd q(static_cast<Eigen::Index>(list.size()));
  Eigen::Index k = 0;
  for (const double a : list) q[k++] = a;
  return q;
}

// Closed form of such an arm: shoulder to the left or right, elbow up or down, wrist turned over or not make
// eight solutions.
TEST(InverseKinematics, FindsTheEightSolutionsOfASphericalWrist) {
  const Tree tree = six_hinges();
  const VectorXd q = angles({0.4, -0.3, 0.9, 0.5, 0.7, -0.2});
  const Reach reach = reach_pose(tree, tree.find_frame("tip"), tip_of(q), q, all(pi));
  EXPECT_EQ(reach.solutions, 8);
  EXPECT_LT((reach.q - q).cwiseAbs().maxCoeff(), 1e-8);
}

// The same tip with the elbow on the other side and with the wrist turned over: the posture decides.
TEST(InverseKinematics, TakesTheSolutionNextToThePosture) {
  const Tree tree = six_hinges();
  const VectorXd q = angles({0.4, -0.3, 0.9, 0.5, 0.7, -0.2});
  const Pose X = tip_of(q);
  // Wrist at w: with the elbow on the other side its links swap the angle about the line to it.
  const Vector3d w = X.p - 0.2 * X.R.col(0);
  const double r = std::hypot(w.x(), w.y()), d2 = r * r + w.z() * w.z();
  const double elbow = -std::acos((d2 - 1.0 - 0.64) / 1.6);
  const double upper = std::atan2(-w.z(), r) - std::atan2(0.8 * std::sin(elbow), 1.0 + 0.8 * std::cos(elbow));
  VectorXd other = q;
  other[1] = upper;
  other[2] = elbow;
  const Reach down = reach_pose(tree, tree.find_frame("tip"), X, other, all(pi));
  ASSERT_TRUE(down.found());
  EXPECT_NEAR(down.q[0], q[0], 1e-8);
  EXPECT_NEAR(down.q[1], upper, 1e-8);
  EXPECT_NEAR(down.q[2], elbow, 1e-8);
  const Pose there = tip_of(down.q);
  EXPECT_LT((there.p - X.p).norm(), 1e-9);
  EXPECT_LT((there.R - X.R).norm(), 1e-9);
  // Turned over: (a + pi, -b, c - pi) of the wrist's three angles.
  const Reach over = reach_pose(tree, tree.find_frame("tip"), X,
                                angles({0.4, -0.3, 0.9, 0.5 - pi, -0.7, -0.2 + pi}), all(2.0 * pi));
  ASSERT_TRUE(over.found());
  EXPECT_LT((over.q - angles({0.4, -0.3, 0.9, 0.5 - pi, -0.7, -0.2 + pi})).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(InverseKinematics, SaysHowFarAwayItStays) {
  const Tree tree = six_hinges();
  Pose far;
  far.p = {3.0, 0.0, 0.0};
  const Reach reach =
      reach_pose(tree, tree.find_frame("tip"), far, angles({0.1, 0.1, 0.1, 0.1, 0.1, 0.1}), all(pi));
  EXPECT_FALSE(reach.found());
  EXPECT_EQ(reach.beyond, -1);
  EXPECT_NEAR(reach.distance, 1.0, 0.01);  // stretched out: 1 + 0.8 + 0.2
}

TEST(InverseKinematics, KeepsLimits) {
  const Tree tree = six_hinges();
  const VectorXd q = angles({0.4, -0.3, 0.9, 0.5, 0.7, -0.2});
  std::vector<ReachingJoint> joints = all(pi);
  joints[0].upper = 0.3;  // the shoulder may not be where the one half of the solutions has it
  joints[0].lower = -0.3;
  const Reach reach = reach_pose(tree, tree.find_frame("tip"), tip_of(q), q, joints);
  EXPECT_FALSE(reach.found());
  EXPECT_EQ(reach.beyond, 0);
  EXPECT_NEAR(reach.beyond_at, 0.4, 1e-8);
}

// Seven joints of the shipped arm, one held: from a posture close by it comes back to where the tip was.
TEST(InverseKinematics, ReachesWithARedundantArmOfWhichAJointIsHeld) {
  const ArmDescription arm = read_arm(std::string(SNARE_SOURCE_DIR) + "/data/arms/ssrms_like.toml");
  const Tree& tree = arm.arm.tree;
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> any(-1.5, 1.5), little(-0.15, 0.15);
  std::vector<ReachingJoint> joints;
  for (int j = 1; j < 7; ++j) {
    const auto k = static_cast<std::size_t>(j);
    joints.push_back({arm.arm.joints[k].body, arm.joints[k].lower, arm.joints[k].upper});
  }
  for (int trial = 0; trial < 5; ++trial) {
    VectorXd q(7), posture(7);
    for (int j = 0; j < 7; ++j) q[j] = any(engine) + (j == 3 ? 1.5 : 0.0);  // the elbow bent
    posture = q;
    for (int j = 1; j < 7; ++j) posture[j] += little(engine);
    const VectorXd there = arm.coordinates(q);
    Kinematics k(tree);
    place(tree, there, k);
    const Reach reach =
        reach_pose(tree, arm.tip, frame_pose(tree, k, arm.tip), arm.coordinates(posture), joints);
    ASSERT_TRUE(reach.found());
    EXPECT_LT((reach.q - there).cwiseAbs().maxCoeff(), 1e-6) << trial;
  }
}

}  // namespace
}  // namespace snare::multibody
