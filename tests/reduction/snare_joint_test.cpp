#include "reduction/snare_joint.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace snare::reduction {
namespace {

coupling::SnareSpecification small_snare(double friction) {
  coupling::SnareSpecification snare;
  coupling::PushProblem& t = snare.wire;
  t.wire.diameter = 0.75e-3;
  t.wire.youngs_modulus = 193e9;
  t.wire.poisson_ratio = 0.29;
  t.wire.density = 7930.0;
  t.wire.bending_stiffness_override = 0.0094 / 16.0;
  t.wire.axial_stiffness_override = 19300.0 / 4.0;
  t.mount.span = 0.0875;
  t.wire.length = 0.0876;
  t.pusher.radius = 0.003;
  t.pusher.friction = friction;
  snare.seat = 0.005;
  snare.elements = 32;
  return snare;
}

// Three wires at 120 degrees: a small displacement in any direction of the plane meets the same stiffness.
// What is left is of second order in 1 um over the seat of 5 mm.
TEST(SnaredShaft, IsIsotropicInItsPlane) {
  for (const double friction : {0.0, 0.1}) {
    const auto stiffness = [&](double angle) {
      const Eigen::Vector3d u(1e-6 * std::cos(angle), 1e-6 * std::sin(angle), 0.0);
      const coupling::ShaftPath path = coupling::move_shaft(small_snare(friction), {u});
      EXPECT_TRUE(path.report.usable()) << path.report.message;
      return path.points.back().force.dot(u) / u.squaredNorm();
    };
    const double x = stiffness(0.0);
    EXPECT_GT(x, 0.0);
    EXPECT_NEAR(stiffness(0.5 * M_PI) / x, 1.0, 1e-3);
    EXPECT_NEAR(stiffness(0.7) / x, 1.0, 1e-3);
  }
}

// A wire and the mirror image of the way.
TEST(SnaredShaft, MirrorsInX) {
  const coupling::ShaftPath right =
      coupling::move_shaft(small_snare(0.1), {{1e-3, 0.0, 0.0}, {2e-3, 0.0, 0.0}});
  const coupling::ShaftPath left =
      coupling::move_shaft(small_snare(0.1), {{-1e-3, 0.0, 0.0}, {-2e-3, 0.0, 0.0}});
  ASSERT_EQ(right.points.size(), 2u);
  ASSERT_EQ(left.points.size(), 2u);
  const Eigen::Vector3d f = right.points.back().force;
  const Eigen::Vector3d g = left.points.back().force;
  EXPECT_NEAR(f.x(), -g.x(), 1e-6 * f.norm());  // of Newton's tolerance on the multipliers
  EXPECT_NEAR(f.y(), g.y(), 1e-6 * f.norm());
}

// Without friction the work of the shaft is stored. Trapezoids of 40 points: (1/40)^2.
TEST(SnaredShaft, StoresTheWorkWithoutFriction) {
  std::vector<Eigen::Vector3d> way;
  for (int i = 0; i <= 40; ++i) way.push_back({2e-3 * i / 40, 1e-3 * i / 40, 0.0});
  const coupling::ShaftPath path = coupling::move_shaft(small_snare(0.0), way);
  ASSERT_EQ(path.points.size(), way.size()) << path.report.message;
  double work = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i)
    work += 0.5 * (path.points[i].force + path.points[i - 1].force).dot(way[i] - way[i - 1]);
  EXPECT_NEAR(work, path.points.back().energy - path.points.front().energy, 1e-3 * work);
}

// In a closed cycle the loop's area is what friction takes. The slip between two points is taken as one step
// and the force as linear in it: 80 steps a leg leave some 0.5 %, 240 leave 0.02 %.
TEST(SnareJoint, LoopIsTheDissipation) {
  for (const int axis : {0, 2}) {
    const JointCycle cycle = cycle_snare(small_snare(0.1), axis, axis == 2 ? 0.01 : 0.003, 80);
    ASSERT_TRUE(cycle.report.usable()) << cycle.report.message;
    EXPECT_GT(cycle.loop, 0.0);
    EXPECT_NEAR(cycle.dissipated / cycle.loop, 1.0, 0.01) << axis;
    // The slider's own loop, 4 f (a - f/q).
    const double a = axis == 2 ? 0.01 : 0.003;
    const double f = cycle.fitted.friction;
    EXPECT_NEAR(4.0 * f * (a - f / cycle.fitted.stick_stiffness), cycle.loop, 1e-9 * cycle.loop);
  }
}

TEST(SnareJoint, SlidesAtItsFriction) {
  SnareJoint joint;
  joint.axis = {JointAxis{9000.0, 1.0, 5e4}, JointAxis{9000.0, 1.0, 5e4}, JointAxis{0.0, 2.7, 1e4}};
  JointState state;
  EXPECT_NEAR(joint.move(state, {0.0, 0.0, 0.01}).z(), 2.7, 1e-12);
  EXPECT_NEAR(joint.move(state, {0.0, 0.0, 0.01 - 1e-4}).z(), 1.7, 1e-12);
  EXPECT_NEAR(joint.move(state, {1e-3, 0.0, 0.0}).z(), -2.7, 1e-12);
  EXPECT_NEAR(joint.move(state, {1e-3, 0.0, 0.0}).x(), 10.0, 1e-12);
}

}  // namespace
}  // namespace snare::reduction
