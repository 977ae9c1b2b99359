// Wires start with the motion of their carriers: forces at the start and everything after it depend on
// relative motion alone.

#include "coupling/dynamics/model/start.hpp"
#include "coupling/dynamics/run/simulate.hpp"
#include "tests/support/motion_bodies.hpp"
#include "tests/support/soft_wire.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace snare::coupling {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

struct Start {
  std::vector<Vector3d> mount_forces;
  Matrix3Xd wire;  ///< at the end
};

Start run(const Motion& motion, MotionOptions options, double tighter = 1.0) {
  options.relative_tolerance /= tighter;
  for (double* t : {&options.position_tolerance, &options.velocity_tolerance, &options.twist_tolerance,
                    &options.body_position_tolerance, &options.body_velocity_tolerance,
                    &options.angle_tolerance, &options.spin_tolerance})
    *t /= tighter;
  options.output_interval = options.duration;
  Start s;
  const MotionResult r = simulate(motion, options, [&](const MotionSample& sample) {
    if (sample.time == 0.0) s.mount_forces = sample.mount_forces;
    s.wire = sample.wires[0];
    return false;
  });
  EXPECT_TRUE(r.report.usable()) << r.report.message;
  return s;
}

/// Forces of the mounts at the start; nothing is integrated.
std::vector<Vector3d> start_forces(const Motion& motion) {
  std::vector<Vector3d> forces;
  static_cast<void>(simulate(motion, {}, [&](const MotionSample& sample) {
    forces = sample.mount_forces;
    return true;
  }));
  return forces;
}

/// A bent wire between two bodies, or with both ends on one, with mounts of every kind; the bodies move and
/// turn.
Motion random_scene(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto vector = [&]() -> Vector3d { return {unit(random), unit(random), unit(random)}; };
  Motion motion;
  wire::RodInMotion rod = test::soft_wire(8);
  using Kind = wire::SpatialEnd::Kind;
  for (wire::SpatialEnd* end : {&rod.properties.left, &rod.properties.right})
    end->kind = std::vector{Kind::clamp, Kind::pin, Kind::twisting_pin}[random() % 3];
  if (random() % 2 == 0) rod.formulation = wire::Formulation::higher_order;
  Matrix3Xd x = straight_wire(rod, Vector3d::Zero(), {0.2, 0.0, 0.0});
  for (int i = 1; i < 8; ++i) x.col(i) += 5e-4 * vector();
  motion.wires.push_back({"wire", rod, x, {}});
  for (int k = 0; k < 2; ++k) {
    MotionBody body = test::block(k == 0 ? "a" : "b", 2.0, {0.02, 0.03, 0.025});
    body.start.position = Vector3d(0.2 * k, 0.0, 0.0) + 0.05 * vector();
    body.start.velocity = vector();
    body.start.spin = 3.0 * vector();
    if (random() % 4 == 0) {
      body.driven = true;
      body.start.spin.setZero();
    }
    motion.bodies.push_back(body);
  }
  const bool one_carrier = random() % 2 == 0;
  motion.mounts = {{"left", 0, wire::End::left, test::body_of(0)},
                   {"right", 0, wire::End::right, test::body_of(one_carrier ? 0 : 1)}};
  return motion;
}

Motion superposed(Motion motion, const Vector3d& velocity, const Vector3d& spin) {
  for (MotionBody& b : motion.bodies) {
    b.start.velocity += velocity + spin.cross(b.start.position);
    b.start.spin += spin;  // the bodies' axes are those of the world
  }
  return motion;
}

double largest_difference(const std::vector<Vector3d>& a, const std::vector<Vector3d>& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) largest = std::max(largest, (a[k] - b[k]).norm());
  return largest;
}

double largest(const std::vector<Vector3d>& a) {
  return largest_difference(a, std::vector<Vector3d>(a.size(), Vector3d::Zero()));
}

TEST(CarriedStart, IsGalileiInvariant) {
  std::mt19937 random(41);
  MotionOptions options;
  options.duration = 1e-3;
  for (int trial = 0; trial < 40; ++trial) {
    SCOPED_TRACE(trial);
    const Motion motion = random_scene(random);
    const Vector3d along(3.0, -7.0, 2.0);
    const Motion carried = superposed(motion, along, Vector3d::Zero());
    const Start rest = run(motion, options), moving = run(carried, options);
    const double scale = largest(rest.mount_forces);
    EXPECT_GT(scale, 1e-4);
    EXPECT_LT(largest_difference(rest.mount_forces, moving.mount_forces), 1e-6 * scale);
    // Relative tolerances are shares of velocities, which differ: to what tighter ones change in both.
    const double error = std::max((run(motion, options, 10.0).wire - rest.wire).cwiseAbs().maxCoeff(),
                                  (run(carried, options, 10.0).wire - moving.wire).cwiseAbs().maxCoeff());
    const Matrix3Xd shifted = moving.wire.colwise() - options.duration * along;
    EXPECT_LT((shifted - rest.wire).cwiseAbs().maxCoeff(), std::max(error, options.position_tolerance));
  }
}

// A rotation that is superposed on all bodies is none of the wire in itself: no dashpot answers. At the start
// a light wire, of 0.2 mg, has forces of stiffness and damping alone; its inertia adds some 1e-9 N to tenths
// of newtons.
TEST(CarriedStart, FeelsNoSuperposedRotation) {
  std::mt19937 random(43);
  for (int trial = 0; trial < 40; ++trial) {
    SCOPED_TRACE(trial);
    Motion motion = random_scene(random);
    motion.wires[0].rod.mass_per_length = 1e-9;
    for (MotionBody& b : motion.bodies) b.driven = false;
    const std::vector<Vector3d> rest = start_forces(motion),
                                turning =
                                    start_forces(superposed(motion, Vector3d::Zero(), {4.0, -3.0, 5.0}));
    EXPECT_GT(largest(rest), 1e-2);
    EXPECT_LT(largest_difference(rest, turning), 1e-6 * largest(rest));
  }
}

// Between two carriers that part along the chord a straight wire is stretched at one rate everywhere.
TEST(CarriedStart, StretchesEvenlyBetweenTwoCarriers) {
  Motion motion;
  const wire::RodInMotion rod = test::soft_wire(8);
  motion.wires.push_back({"wire", rod, straight_wire(rod, Vector3d::Zero(), {0.2, 0.0, 0.0}), {}});
  for (int k = 0; k < 2; ++k) {
    motion.bodies.push_back(test::block(k == 0 ? "a" : "b", 2.0, {0.02, 0.03, 0.025}));
    motion.bodies.back().driven = true;
    motion.bodies.back().start.velocity.x() = k == 0 ? 1.0 : 1.5;
  }
  motion.mounts = {{"left", 0, wire::End::left, test::body_of(0)},
                   {"right", 0, wire::End::right, test::body_of(1)}};
  const std::vector<Vector3d> forces = start_forces(motion);
  // N = tau EA e', of both ends alike: 1e-4 s, 1e3 N, 0.5 m/s over 0.2 m.
  EXPECT_NEAR(forces[0].x(), -0.25, 1e-9);
  EXPECT_NEAR(forces[1].x(), 0.25, 1e-9);
}

}  // namespace
}  // namespace snare::coupling
