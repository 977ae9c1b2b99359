// Wires that lie on flat faces and over their edges.

#include "coupling/contact/mesh_shape.hpp"
#include "coupling/dynamics/run/simulate.hpp"
#include "tests/support/mesh_files.hpp"
#include "tests/support/soft_wire.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace snare::coupling {
namespace {

using Eigen::Vector3d;
using test::body_below;
using test::soft_wire;

/// A block of 0.2 kg, 40 mm along the wire, that moves up at 0.05 m/s; its top is 1 mm (the wire's radius)
/// and `gap` below the wire.
Motion block_below(int elements, double gap, double tilt) {
  const auto block = std::make_shared<MeshShape>(test::cuboid(0.04, 0.01, 0.04));
  Motion motion = body_below(soft_wire(elements), block, {0.1, -0.006 - gap, 0.0}, 0.05, 0.2);
  motion.bodies[0].start.orientation = Eigen::AngleAxisd(tilt, Vector3d::UnitZ());
  return motion;
}

struct Seen {
  std::size_t most_points = 0;
  double least_force = 0.0, largest_spin = 0.0;
  double deepest_vertex = 0.0;  // inside the block [m]
};

MotionResult run(const Motion& motion, double duration, Seen& seen) {
  MotionOptions options = test::fine_tolerances();
  options.duration = duration;
  options.output_interval = duration / 400.0;
  const MotionContact& contact = motion.contacts[0];
  return simulate(motion, options, [&](const MotionSample& s) {
    const multibody::RigidBodyState& block = s.bodies[0];
    for (const auto& x : s.wires[0].colwise()) {
      const Vector3d in_block = block.orientation.conjugate() * (x - block.position);
      seen.deepest_vertex =
          std::max(seen.deepest_vertex, contact.wire_radius - contact.shape->distance(in_block));
    }
    seen.most_points = std::max(seen.most_points, s.contacts[0].points.size());
    for (const ContactSample& p : s.contacts[0].points)
      seen.least_force = std::min(seen.least_force, p.normal_force);
    seen.largest_spin = std::max(seen.largest_spin, s.bodies[0].spin.norm());
    return false;
  });
}

class FlatFace : public testing::TestWithParam<int> {};

TEST_P(FlatFace, TakesAStraightWireAlongAllOfItsLength) {
  const int elements = GetParam();
  Seen seen;
  const MotionResult r = run(block_below(elements, 1e-4, 0.0), 0.25, seen);
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  EXPECT_NEAR(r.events.front().time, 1e-4 / 0.05, 1e-6);
  // It lets go again: all of the block's energy but what the damping took.
  EXPECT_EQ(r.events.back().kind, MotionEvent::Kind::lift_off);
  EXPECT_LT(seen.largest_spin, 0.05);  // one edge alone would give 5 rad/s
  EXPECT_GE(seen.least_force, 0.0);
  EXPECT_LT(r.largest_penetration, 1e-6);
  EXPECT_LT(seen.deepest_vertex, 1e-6);
  EXPECT_LT(std::abs(r.energy.integrator), 1e-3 * 0.5 * 0.2 * 0.05 * 0.05);
}

INSTANTIATE_TEST_SUITE_P(Meshes, FlatFace, testing::Values(20, 23, 40));

TEST(MotionOnEdges, ATiltedBlockRestsOnBothOfItsEdges) {
  Seen seen;
  const MotionResult r = run(block_below(40, 1e-3, std::numbers::pi / 90.0), 0.25, seen);
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  EXPECT_EQ(seen.most_points, 2u);
  EXPECT_GE(seen.least_force, 0.0);
  EXPECT_LT(r.largest_penetration, 1e-6);
  EXPECT_LT(seen.deepest_vertex, 1e-6);
  EXPECT_LT(std::abs(r.energy.integrator), 1e-3 * 0.5 * 0.2 * 0.05 * 0.05);
}

}  // namespace
}  // namespace snare::coupling
