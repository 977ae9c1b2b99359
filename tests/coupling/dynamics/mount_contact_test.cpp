// Mounts of wires stop what strikes them.                                                    theory.md (M.35)

#include "coupling/contact/foundation.hpp"
#include "coupling/dynamics/contact/contact_part.hpp"
#include "coupling/dynamics/joints/body_part.hpp"
#include "coupling/dynamics/run/simulate.hpp"
#include "tests/support/dae_jacobian.hpp"
#include "tests/support/soft_wire.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <random>

namespace snare::coupling {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double pin = 0.006, wire_radius = 0.001;  // [m]
constexpr double length = 0.008;            // that gives way: four diameters, more than both radii [m]
constexpr double stiffness = 1e3 / length;  // [N/m]

/// A pin across the plane of the wire of 0.2 m, so deep in its left mount, from a direction.
struct AtTheMount {
  Motion motion;
  wire::RodPart rod;
  BodyPart body;
  ContactPart contact;
  numerics::DaeSystem system;
  VectorXd y;

  static Motion pressed(const Vector3d& from, double depth, double speed, const MotionFriction& friction) {
    Motion m = test::body_below(test::soft_wire(20), std::make_shared<EndlessCylinder>(pin),
                                (pin + wire_radius - depth) * from, 0.0, 1.0);
    m.bodies[0].start.velocity = -speed * from;
    m.contacts[0].friction = friction;
    return m;
  }
  AtTheMount(const Vector3d& from, double depth, double speed, const MotionFriction& friction = {})
      : motion(pressed(from, depth, speed, friction)),
        rod("wire", motion.wires[0].rod, {}),
        body(motion.bodies[0], Vector3d::Zero(), {}),
        contact(motion.contacts[0], motion.contacts[0].shape, rod, body),
        system({&rod, &body, &contact}),
        y(VectorXd::Zero(system.size())) {
    rod.place(motion.wires[0].positions, Eigen::Matrix3Xd::Zero(3, rod.vertices()), y);
    body.place(y);
    contact.update_candidates(y);
  }
};

// A shaft's radius with the wire's, but four diameters at least; of a wire whose diameter is not said, those
// of a solid one.
TEST(MountContact, GivesWayOverALengthOfShaftOrWire) {
  constexpr double EA = 1e3, EI = 1e-3, diameter = 0.002;
  EXPECT_DOUBLE_EQ(mount_length(EA, EI, diameter, 0.02), 0.021);
  for (const double radius : {0.0, 0.006, std::numeric_limits<double>::infinity()})
    EXPECT_DOUBLE_EQ(mount_length(EA, EI, diameter, radius), 0.008);
  EXPECT_DOUBLE_EQ(mount_length(EA, EI, 0.0, 0.001), 4.0 * 0.004);
}

// F = EA/l d (1 + a d'), along the wire as from its side, where the last of the wire bears next to nothing.
TEST(MountContact, PressesBackByItsDepthFromAnySide) {
  const double damping = ElasticFoundation{}.damping;
  for (const Vector3d& from :
       {Vector3d(-1.0, 0.0, 0.0), Vector3d(-0.6, 0.8, 0.0), Vector3d(-0.6, -0.8, 0.0)}) {
    for (const double depth : {1e-7, 1e-6, 1e-5}) {
      for (const double speed : {0.0, 2e-3, -2e-3}) {
        const ContactPart::Sums s = [&] {
          const AtTheMount t(from, depth, speed);
          return t.contact.sums(t.y);
        }();
        const double expected = stiffness * depth * std::max(0.0, 1.0 + damping * speed);
        EXPECT_LT((s.force + expected * from).norm(), 1e-3 * stiffness * depth)
            << from.transpose() << ' ' << depth;
        EXPECT_LT((s.on_mounts[0] - s.force).norm(), 1e-3 * stiffness * depth);
        EXPECT_NEAR(s.lost_power, (expected - stiffness * depth) * speed, 1e-3 * stiffness * depth * 2e-3);
      }
    }
  }
}

// The friction of a mount opposes what slides on it, by the smooth law.
TEST(MountContact, RubsAgainstWhatSlides) {
  MotionFriction friction;
  friction.static_coefficient = 0.4;
  friction.dynamic_coefficient = 0.25;
  AtTheMount t(Vector3d(-1.0, 0.0, 0.0), 1e-6, 0.0, friction);
  t.y.segment<3>(t.body.velocity()) = Vector3d(0.0, 0.03, 0.04);
  const Vector3d force = t.contact.sums(t.y).force;
  EXPECT_LT((force - stiffness * 1e-6 * Vector3d(1.0, 0.25 * 0.6, 0.25 * 0.8)).norm(),
            1e-3 * stiffness * 1e-6);
}

// A pin that the wire points at has no direction along it: the derivatives hold there too.
TEST(MountContact, JacobianMatchesDifferences) {
  MotionFriction friction;
  friction.static_coefficient = friction.dynamic_coefficient = 0.3;
  friction.bristle_displacement = friction.bristle_time = 1e-4;
  for (const Vector3d& from : {Vector3d(-1.0, 0.0, 0.0), Vector3d(-0.6, 0.64, 0.48)}) {
    AtTheMount t(from, 1e-5, 1e-4, friction);
    t.y.segment<3>(t.body.velocity()) += Vector3d(0.002, -0.03, 0.02);
    t.y.segment<3>(t.body.spin()) << 0.3, -0.2, 0.5;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    VectorXd rate(t.y.size());
    for (double& r : rate) r = 0.1 * unit(random);
    const Eigen::MatrixXd directions = test::along_unit_quaternions(t.y, {t.body.quaternion()});
    const test::DerivativeError error = test::compare_dae_jacobian(t.system, t.y, rate, directions, 1e-6);
    EXPECT_LT(error.relative, 1e-4) << error.worst;
  }
}

// Without damping the mount is a spring: it returns the body after half a period, and momentum is kept.
TEST(MountContact, ReturnsABodyAsASpring) {
  constexpr double mass = 1.0, speed = 0.02, way = 1e-5;
  Motion motion = AtTheMount::pressed(Vector3d(-1.0, 0.0, 0.0), -way, speed, {});
  motion.contacts[0].foundation.damping = 0.0;
  MotionOptions options = test::fine_tolerances();
  options.peak_window = 0.0;
  const double half_period = std::numbers::pi * std::sqrt(mass / stiffness), before = way / speed;
  options.duration = before + half_period + 2e-3;
  double last_speed = 0.0;
  const MotionResult r = simulate(motion, options, [&](const MotionSample& s) {
    last_speed = s.bodies[0].velocity.x();
    return false;
  });
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  EXPECT_NEAR(last_speed, -speed, 1e-3 * speed);
  EXPECT_NEAR(r.peak_force[0], speed * std::sqrt(mass * stiffness),
              2e-3 * speed * std::sqrt(mass * stiffness));
  ASSERT_EQ(r.events.size(), 2u);
  EXPECT_NEAR(r.events[0].time, before, 2e-3 * half_period);
  EXPECT_NEAR(r.events[1].time - r.events[0].time, half_period, 5e-3 * half_period);
  EXPECT_LT(r.momentum_error.norm(), 1e-6 * mass * speed);
}

}  // namespace
}  // namespace snare::coupling
