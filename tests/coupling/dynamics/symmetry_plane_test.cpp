// Motions that stay in a plane: which they are, and that they are those of space.

#include "coupling/dynamics/run/symmetry_plane.hpp"

#include "coupling/contact/revolved_solids.hpp"
#include "coupling/contact/union_shape.hpp"
#include "coupling/dynamics/model/modes.hpp"
#include "coupling/dynamics/run/simulate.hpp"
#include "tests/support/soft_wire.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <vector>

namespace snare::coupling {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A soft wire across x, met from below beside its middle by a ball off the body's centre, with friction and
/// weight.
Motion impact(wire::Formulation formulation) {
  wire::RodInMotion rod = test::soft_wire(12);
  rod.formulation = formulation;
  Motion motion =
      test::body_below(rod, std::make_shared<EndlessCylinder>(5e-3), {0.07, -6e-3 - 1e-4, 0.0}, 0.05, 0.05);
  motion.bodies[0].start.spin = {0.0, 0.0, 1.0};
  motion.bodies[0].properties.inertia = Vector3d(1e-5, 2e-5, 3e-5).asDiagonal();
  motion.contacts[0].X_BS.p = {1e-3, 0.0, 0.0};
  motion.contacts[0].friction = {0.4, 0.3, 0.01, 1.0};
  motion.gravity = {0.3, -1.0, 0.0};
  return motion;
}

/// The same with the axes exchanged: x, y, z become those of the columns.
Motion turned(Motion motion, const Matrix3d& turn) {
  for (MotionWire& w : motion.wires) {
    w.positions = turn * w.positions;
    for (wire::SpatialEnd* end : {&w.rod.properties.left, &w.rod.properties.right}) {
      end->position = turn * end->position;
      end->direction = turn * end->direction;
      end->director = turn * end->director;
    }
  }
  for (MotionBody& b : motion.bodies) {
    b.start.position = turn * b.start.position;
    b.start.velocity = turn * b.start.velocity;
    b.start.spin = turn * b.start.spin;
    b.properties.inertia = turn * b.properties.inertia * turn.transpose();
  }
  for (MotionContact& c : motion.contacts) {
    c.X_BS.p = turn * c.X_BS.p;
    c.X_BS.R = turn * c.X_BS.R;
  }
  motion.gravity = turn * motion.gravity;
  return motion;
}

/// Whose columns are the axes k + 1, k + 2 and k.
Matrix3d exchange(int k) {
  Matrix3d turn;
  turn << Vector3d::Unit((k + 1) % 3), Vector3d::Unit((k + 2) % 3), Vector3d::Unit(k);
  return turn;
}

MotionResult run(const Motion& motion, double duration = 0.05) {
  MotionOptions options = test::fine_tolerances();
  options.duration = duration;
  MotionResult result = simulate(motion, options);
  EXPECT_TRUE(result.report.usable()) << result.report.message;
  return result;
}

// A body that drifts out of the plane by a nanometre a second makes it a motion in space; what it does else
// is the same.
TEST(SymmetryPlane, TheMotionInItIsThatOfSpace) {
  for (const wire::Formulation formulation : {wire::Formulation::vertices, wire::Formulation::higher_order}) {
    Motion motion = impact(formulation);
    ASSERT_TRUE(symmetry_normal(motion));
    EXPECT_EQ(*symmetry_normal(motion), 2);
    const MotionResult plane = run(motion);
    motion.bodies[0].start.velocity.z() = 1e-9;
    ASSERT_FALSE(symmetry_normal(motion));
    const MotionResult space = run(motion);
    EXPECT_GT(plane.peak_force[0], 0.05);
    EXPECT_NEAR(plane.peak_force[0], space.peak_force[0], 1e-6 * space.peak_force[0]);
    EXPECT_LT((plane.impulse[0] - space.impulse[0]).norm(), 1e-6 * space.impulse[0].norm());
    EXPECT_LT((plane.last.unknowns - space.last.unknowns).cwiseAbs().maxCoeff(), 1e-5);
    EXPECT_NEAR(plane.energy.dissipated, space.energy.dissipated, 1e-6 * space.energy.dissipated);
    EXPECT_LT(plane.momentum_error.norm(), 1e-6 * plane.impulse[0].norm());
    EXPECT_LT(plane.angular_momentum_error.norm(), 1e-6 * 0.1 * plane.impulse[0].norm());
  }
}

TEST(SymmetryPlane, IsFoundAcrossAnyAxis) {
  const MotionResult first = run(impact(wire::Formulation::higher_order));
  for (const int k : {0, 1}) {
    const Motion motion = turned(impact(wire::Formulation::higher_order), exchange(k));
    ASSERT_TRUE(symmetry_normal(motion)) << k;
    EXPECT_EQ(*symmetry_normal(motion), k);
    const MotionResult other = run(motion);
    EXPECT_NEAR(other.peak_force[0], first.peak_force[0], 1e-7 * first.peak_force[0]);
    EXPECT_LT((other.impulse[0] - exchange(k) * first.impulse[0]).norm(), 1e-7 * first.impulse[0].norm());
  }
}

TEST(SymmetryPlane, IsNoneWhereAnythingLeavesIt) {
  const auto stays = [](const std::function<void(Motion&)>& change) {
    Motion motion = impact(wire::Formulation::vertices);
    change(motion);
    return symmetry_normal(motion).has_value();
  };
  EXPECT_TRUE(stays([](Motion&) {}));
  EXPECT_TRUE(stays([](Motion& m) { m.bodies[0].driven = true; }));
  EXPECT_FALSE(stays([](Motion& m) { m.gravity.z() = 1e-9; }));
  EXPECT_FALSE(stays([](Motion& m) { m.bodies[0].start.position.z() = 1e-6; }));
  EXPECT_FALSE(stays([](Motion& m) { m.bodies[0].start.spin.x() = 1e-9; }));
  EXPECT_FALSE(stays([](Motion& m) { m.bodies[0].force.z() = 1e-9; }));
  EXPECT_FALSE(stays(
      [](Motion& m) { m.bodies[0].properties.inertia(0, 2) = m.bodies[0].properties.inertia(2, 0) = 1e-9; }));
  EXPECT_FALSE(
      stays([](Motion& m) { m.bodies[0].start.orientation = Eigen::AngleAxisd(0.1, Vector3d::UnitX()); }));
  EXPECT_FALSE(stays([](Motion& m) {
    m.wires[0].velocities = Eigen::Matrix3Xd::Zero(3, 13);
    m.wires[0].velocities(2, 5) = 1e-9;
  }));
  EXPECT_FALSE(stays([](Motion& m) {
    m.contacts[0].X_BS.R = Eigen::AngleAxisd(0.1, Vector3d::UnitX()).toRotationMatrix();
  }));
  EXPECT_FALSE(stays([](Motion& m) {
    m.bodies[0].driven = true;
    m.bodies[0].course_velocity = [](double) { return Vector3d(0.0, 0.1, 0.0); };
  }));
  EXPECT_FALSE(stays([](Motion& m) { m.loads.emplace_back(); }));
}

// Every shape beside its mirror image, in planes that it has and in others.
TEST(SymmetryPlane, ShapesAreTheirMirrorImagesWhereTheySayThatTheyAre) {
  const std::shared_ptr<const ContactShape> cone = truncated_cone(4e-3, 2e-3, 6e-3);
  const std::vector<std::shared_ptr<const ContactShape>> shapes{
      std::make_shared<Ball>(5e-3),
      std::make_shared<HalfSpace>(0.1),
      std::make_shared<EndlessCylinder>(3e-3),
      std::make_shared<Capsule>(2e-3, 8e-3),
      cone,
      std::make_shared<UnionShape>(
          std::vector<std::shared_ptr<const ContactShape>>{std::make_shared<Ball>(5e-3), cone})};
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-0.01, 0.01);
  int mirrored = 0;
  for (const auto& shape : shapes) {
    for (const Vector3d& n : {Vector3d(0.0, 0.0, 1.0), Vector3d(0.6, 0.8, 0.0), Vector3d(0.6, 0.0, 0.8)}) {
      for (const double offset : {0.0, 2e-3}) {
        if (!shape->is_mirrored(n, offset)) continue;
        ++mirrored;
        for (int k = 0; k < 50; ++k) {
          const Vector3d p(unit(random), unit(random), unit(random));
          const Vector3d image = p - 2.0 * (n.dot(p) - offset) * n;
          EXPECT_NEAR(shape->distance(image), shape->distance(p), 1e-15);
        }
      }
    }
  }
  EXPECT_EQ(mirrored, 3 + 2 + 3 + 2 + 1 + 1);
}

// Small motions about a state in the plane swing out of it as well.
TEST(SymmetryPlane, ModesLeaveIt) {
  Motion motion = impact(wire::Formulation::vertices);
  motion.bodies[0].start.position.y() -= 0.05;
  const MotionOptions options = test::fine_tolerances();
  const auto modes = [&] { return small_motions_at(motion, options, run(motion, 1e-4).last).modes; };
  const std::vector<MotionMode> plane = modes();
  motion.bodies[0].start.velocity.z() = 1e-9;
  const std::vector<MotionMode> space = modes();
  ASSERT_EQ(plane.size(), space.size());
  for (std::size_t k = 0; k < plane.size(); ++k)
    EXPECT_NEAR(plane[k].frequency, space[k].frequency, 1e-5 * space[k].frequency);
}

}  // namespace
}  // namespace snare::coupling
