// Where a wire touches, shapes of every kind in motion, and touches that no step may pass by.

#include "base/errors.hpp"
#include "coupling/contact/curve.hpp"
#include "coupling/contact/mesh_shape.hpp"
#include "coupling/contact/revolved_solids.hpp"
#include "coupling/dynamics/contact/contact_part.hpp"
#include "coupling/dynamics/run/simulate.hpp"
#include "tests/support/mesh_files.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/soft_wire.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <random>

namespace snare::coupling {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using test::body_below;
using test::soft_wire;

using std::numbers::pi;

/// z of the shape along the wire's x.
Matrix3d along_the_wire() {
  return AngleAxisd(0.5 * pi, Vector3d::UnitY()).toRotationMatrix();
}

// A wire in waves that dips into a long capsule below it more than once: nearest point and force against
// dense sampling.
TEST(ContactPart, NearestPointAndForceAreThoseOfASampledWire) {
  wire::RodInMotion constants = soft_wire(12);
  constants.grading = 1.0;
  Motion motion =
      body_below(constants, std::make_shared<Capsule>(0.003, 0.2), {0.07, -0.0045, 0.002}, 0.0, 1.0);
  MotionContact& contact = motion.contacts[0];
  contact.X_BS.R = along_the_wire();
  contact.X_BS.p = {0.03, 0.0, 0.0};
  contact.foundation.modulus = 1e9;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (Eigen::Index i = 1; i < 12; ++i) {
    for (int k = 2; k >= 0; --k) motion.wires[0].positions(k, i) += 4e-3 * unit(random);
  }
  wire::RodPart rod("wire", constants, {});
  BodyPart body(motion.bodies[0], Vector3d::Zero(), {});
  ContactPart part(contact, contact.shape, rod, body);
  numerics::DaeSystem system({&rod, &body, &part});
  VectorXd y = VectorXd::Zero(system.size());
  rod.place(motion.wires[0].positions, Eigen::Matrix3Xd::Zero(3, 13), y);
  body.place(y);
  part.update_candidates(y);
  const auto gap = [&](double s, Vector3d& normal) {
    const CurveWeights w = curve_weights(rod, s);
    Vector3d x = Vector3d::Zero();
    for (int k = 0; k < 4; ++k) x += w.value[k] * y.segment<3>(rod.position_of(w.first + k));
    const DistanceField field =
        contact.shape->at(along_the_wire().transpose() * (x - Vector3d(0.1, -0.0045, 0.002)));
    normal = along_the_wire() * field.normal;
    return field.distance - 0.001;
  };
  constexpr int samples = 200000;
  double least = 1e9;
  int stretches = 0;
  bool inside = false;
  Vector3d force = Vector3d::Zero();
  for (int k = 0; k < samples; ++k) {
    Vector3d normal;
    const double g = gap(0.2 * (k + 0.5) / samples, normal);
    least = std::min(least, g);
    if (g < 0.0 && !inside) ++stretches;
    inside = g < 0.0;
    force += 0.2 / samples * contact.foundation.load(g, 0.0)[0] * normal;
  }
  ASSERT_GE(stretches, 2);
  EXPECT_NEAR(part.search().nearest(y).gap, least, 1e-8);
  EXPECT_EQ(part.samples(y).size(), static_cast<std::size_t>(stretches));
  // Gauss's rule on deep stretches of many millimetres; contacts are micrometres deep.
  EXPECT_LT((part.sums(y).force - force).norm(), 0.02 * force.norm());
}

// A wire that crosses a rounded edge meets F = 4/3 k sqrt(2/c) d^(3/2), c = 1/(R + r).        theory.md (M.8)
TEST(ContactPart, AStraightWireAcrossAPinMeetsTheForceOfItsDepth) {
  constexpr double radius = 0.006, wire_radius = 0.001;
  for (const double depth : {1e-8, 1e-7, 1e-6}) {
    for (const double place : {0.1, 0.1003, 0.1049}) {
      Motion motion = body_below(soft_wire(20), std::make_shared<EndlessCylinder>(radius),
                                 {place, -radius - wire_radius + depth, 0.0}, 0.0, 1.0);
      MotionContact& contact = motion.contacts[0];
      contact.foundation.modulus = 5e12;
      wire::RodPart rod("wire", motion.wires[0].rod, {});
      BodyPart body(motion.bodies[0], Vector3d::Zero(), {});
      ContactPart part(contact, contact.shape, rod, body);
      numerics::DaeSystem system({&rod, &body, &part});
      VectorXd y = VectorXd::Zero(system.size());
      rod.place(motion.wires[0].positions, Eigen::Matrix3Xd::Zero(3, 21), y);
      body.place(y);
      part.update_candidates(y);
      const double expected = 4.0 / 3.0 * contact.foundation.modulus *
                              std::sqrt(2.0 * (radius + wire_radius)) * depth * std::sqrt(depth);
      EXPECT_NEAR(part.sums(y).force.y(), expected, 2e-4 * expected) << depth << ' ' << place;
    }
  }
}

/// A foundation on which newtons leave no trace of a micrometre [N/m^2].
constexpr double stiff = 1e12;

/// Peak force and impulse of 50 g at 0.3 m/s.
MotionResult impact(std::shared_ptr<const ContactShape> shape, const Matrix3d& turn, double reach) {
  Motion motion = body_below(soft_wire(16), std::move(shape), {0.0937, -reach - 0.0011, 0.0}, 0.3, 0.05);
  motion.contacts[0].foundation.modulus = stiff;
  motion.contacts[0].X_BS.R = turn;
  MotionOptions options;
  options.duration = 0.06;
  return simulate(motion, options);
}

TEST(MotionOfMeshes, StrikeLikeTheSolidsTheyTessellate) {
  constexpr double radius = 0.01;
  constexpr int around = 36;
  // Chords stand inside by up to the sagitta, 4e-5 m of a push of some 1e-2 m; an edge between facets meets
  // the wire at up to pi/36 from where the cylinder would, which turns the force by so much and shortens its
  // part along the push by half the square, 0.4 %.
  constexpr double share = 0.01;
  const MotionResult cylinder = impact(finite_cylinder(radius, 0.04), Matrix3d::Identity(), radius);
  const MotionResult cylinder_mesh =
      impact(std::make_shared<MeshShape>(
                 test::revolved_mesh({{0.0, -0.02}, {radius, -0.02}, {radius, 0.02}, {0.0, 0.02}}, around)),
             Matrix3d::Identity(), radius);
  const MotionResult ball = impact(std::make_shared<Ball>(radius), Matrix3d::Identity(), radius);
  const MotionResult ball_mesh =
      impact(std::make_shared<MeshShape>(test::revolved_mesh(test::half_circle(radius, around / 2), around)),
             Matrix3d::Identity(), radius);
  for (const auto& [exact, mesh] : {std::pair{&cylinder, &cylinder_mesh}, std::pair{&ball, &ball_mesh}}) {
    ASSERT_TRUE(exact->report.usable()) << exact->report.message;
    ASSERT_TRUE(mesh->report.usable()) << mesh->report.message;
    EXPECT_GT(exact->impulse[0].y(), 0.05 * 0.3);  // it rebounds
    EXPECT_NEAR(mesh->impulse[0].y(), exact->impulse[0].y(), share * exact->impulse[0].y());
    EXPECT_NEAR(mesh->peak_force[0], exact->peak_force[0], 2.0 * share * exact->peak_force[0]);
    EXPECT_LT(mesh->largest_penetration, 1e-6);
  }
}

TEST(MotionPoints, TwoRimsBearHalfEach) {
  // An hourglass along the wire: its two rims touch at once.
  const auto hourglass = std::make_shared<RevolvedShape>(Profile(
      {0.0, -0.02}, {{{0.01, -0.02}, 0.0}, {{0.005, 0.0}, 0.0}, {{0.01, 0.02}, 0.0}, {{0.0, 0.02}, 0.0}}));
  Motion motion = body_below(soft_wire(20), hourglass, {0.1, -0.012, 0.0}, 0.3, 0.05);
  motion.contacts[0].X_BS.R = along_the_wire();
  motion.contacts[0].foundation.modulus = stiff;
  MotionOptions options;
  options.duration = 0.01;
  options.relative_tolerance = 1e-7;
  options.position_tolerance = 1e-10;
  options.velocity_tolerance = options.spin_tolerance = 1e-7;
  options.force_tolerance = 1e-5;
  std::size_t most = 0;
  double uneven = 0.0;
  double turned = 0.0;
  const MotionResult result = simulate(motion, options, [&](const MotionSample& s) {
    most = std::max(most, s.contacts[0].points.size());
    if (s.contacts[0].points.size() == 2) {
      const ContactSample& a = s.contacts[0].points[0];
      const ContactSample& b = s.contacts[0].points[1];
      uneven = std::max(uneven, std::abs(a.normal_force - b.normal_force) / (0.1 + a.normal_force));
      EXPECT_NEAR(a.arc + b.arc, 0.2, 1e-6);
      EXPECT_NEAR(s.contacts[0].normal_force, a.normal_force + b.normal_force, 1e-12);
    }
    turned = std::max(turned, s.bodies[0].spin.norm());
    return false;
  });
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  EXPECT_EQ(most, 2u);
  EXPECT_LT(uneven, 1e-3);  // the integrator's tolerances, amplified by the wire's axial modes
  EXPECT_LT(turned, 1e-3);
  ASSERT_GE(result.events.size(), 2u);
  EXPECT_NE(result.events[0].point, result.events[1].point);
  EXPECT_NEAR(result.events[0].time, 1e-3 / 0.3, 1e-6);
  EXPECT_LT(result.largest_penetration, 1e-6);
}

TEST(MotionPoints, SeveralShapesOnSeveralBodiesTouchTogether) {
  // Two bodies strike two wires at once, one of them both wires.
  Motion motion = body_below(soft_wire(16), std::make_shared<Ball>(0.01), {0.06, -0.012, 0.0}, 0.3, 0.05);
  motion.wires.push_back(motion.wires[0]);
  motion.wires[1].name = "second";
  motion.wires[1].rod.properties.left.position.z() = motion.wires[1].rod.properties.right.position.z() = 0.05;
  motion.wires[1].positions.row(2).setConstant(0.05);
  // A third one out of reach, so that nobody mistakes one wire for another.
  motion.wires.push_back(motion.wires[0]);
  motion.wires[2].name = "third";
  motion.wires[2].rod.properties.left.position.y() = motion.wires[2].rod.properties.right.position.y() = 0.1;
  motion.wires[2].positions.row(1).setConstant(0.1);
  motion.bodies.push_back(motion.bodies[0]);
  motion.bodies[1].name = "bar";
  motion.bodies[1].start.position = {0.14, -0.012, 0.025};
  MotionContact bar = motion.contacts[0];
  bar.body = 1;
  bar.shape = std::make_shared<Capsule>(0.01, 0.05);
  bar.name = "bar on the first";
  motion.contacts.push_back(bar);
  bar.wire = 1;
  bar.name = "bar on the second";
  motion.contacts.push_back(bar);
  bar.wire = 2;
  bar.name = "bar on the third";
  motion.contacts.push_back(bar);
  MotionOptions options;
  options.duration = 0.02;
  const MotionResult result = simulate(motion, options, [](const MotionSample& s) {
    if (s.time == 0.0) {
      EXPECT_NEAR(s.contacts[3].gap, 0.101, 1e-12);
    }
    EXPECT_GT(s.contacts[3].gap, 0.09);
    return false;
  });
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  ASSERT_GE(result.events.size(), 3u);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(result.events[static_cast<std::size_t>(k)].time, 1e-3 / 0.3, 1e-6);
  EXPECT_EQ(result.events[0].contact + result.events[1].contact + result.events[2].contact, 3);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_GT(result.peak_force[k], 0.05);
  EXPECT_EQ(result.peak_force[3], 0.0);
  EXPECT_LT(result.momentum_error.norm(), 5e-3 * result.impulse[0].norm());
}

TEST(MotionPoints, NowhereInsideAThinPinThatTheWireWraps) {
  // A pin thinner than the wire's elements pushes a V into it: no vertex and nothing between comes inside.
  const auto pin = std::make_shared<EndlessCylinder>(0.002);
  Motion motion = body_below(soft_wire(20), pin, {0.0987, -0.0035, 0.0}, 0.6, 0.05);
  motion.contacts[0].foundation.modulus = stiff;
  MotionOptions options;
  options.duration = 0.03;
  double deepest = 1.0;
  wire::RodPart rod("wire", motion.wires[0].rod, {});
  const MotionResult result = simulate(motion, options, [&](const MotionSample& s) {
    if (!s.contacts[0].closed) return false;
    for (int k = 0; k <= 2000; ++k) {
      const CurveWeights w = curve_weights(rod, 0.2 * k / 2000.0);
      const Vector3d x = s.wires[0].middleCols<4>(w.first) * w.value;
      const Vector3d d = s.bodies[0].orientation.conjugate() * (x - s.bodies[0].position);
      deepest = std::min(deepest, std::hypot(d.x(), d.y()) - 0.003);
    }
    return false;
  });
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  EXPECT_GT(result.peak_force[0], 0.1);
  EXPECT_GT(deepest, -2e-6);  // what may be skipped between two points, and the error of the dense output
}

TEST(MotionPoints, AnOverlapAtTheStartIsRefused) {
  const Motion motion =
      body_below(soft_wire(8), std::make_shared<Ball>(0.01), {0.1, -0.0106, 0.0}, 0.0, 0.05);
  const std::string said = test::refusal([&] { return simulate(motion, {}); });
  EXPECT_THAT(said, testing::HasSubstr("contact.gap = -0.000"));
  EXPECT_THAT(said, testing::HasSubstr("must be >= 0 m at the start"));
  Motion edge = body_below(soft_wire(8), finite_cylinder(0.01, 0.02), {0.1, -0.02, 0.0}, 0.0, 0.05);
  edge.contacts[0].wire_radius = 0.0;
  EXPECT_THROW((void)simulate(edge, {}), base::InputError);
}

/// A pin that is moved across the wire, until just after it touches.
MotionResult touch_of(double radius, double speed, double swing, double max_step) {
  wire::RodInMotion rod = soft_wire(12);
  Motion motion = body_below(rod, std::make_shared<Capsule>(radius, 0.05),
                             {0.0937, -radius - 1e-4 - 0.001, 0.0}, speed, 1.0);
  motion.bodies[0].driven = true;
  motion.contacts[0].wire_radius = 1e-4;
  Eigen::Matrix3Xd velocities = Eigen::Matrix3Xd::Zero(3, 13);
  for (Eigen::Index i = 1; i < 12; ++i)
    velocities(1, i) = swing * std::sin(pi * static_cast<double>(i) / 12.0);
  motion.wires[0].velocities = velocities;
  MotionOptions options;
  options.duration = 1.05e-3 / speed;
  options.output_interval = options.duration;
  options.max_step = max_step;
  return simulate(motion, options);
}

TEST(NoTunnelling, EveryPinTouchesAtItsTime) {
  for (const double radius : {1e-4, 7e-4, 5e-3}) {
    for (const double speed : {0.05, 0.5, 5.0, 50.0}) {
      const MotionResult r = touch_of(radius, speed, 0.0, 1e9);
      ASSERT_GE(r.events.size(), 1u) << radius << ' ' << speed;
      // The wire rests: the way of 1 mm at a constant speed.
      EXPECT_NEAR(r.events[0].time, 1e-3 / speed, 1e-8 / speed) << radius << ' ' << speed;
      EXPECT_NEAR(r.events[0].approach_speed, speed, 1e-9 * speed);
    }
  }
}

TEST(NoTunnelling, AgreesWithSmallStepsOnAWireThatSwings) {
  for (const double radius : {1e-4, 5e-3}) {
    for (const double speed : {0.5, 50.0}) {
      const double swing = -0.3 * speed;  // towards the pin
      const MotionResult r = touch_of(radius, speed, swing, 1e9);
      const MotionResult small = touch_of(radius, speed, swing, 0.02 * (radius + 1e-4) / speed);
      ASSERT_GE(r.events.size(), 1u) << radius << ' ' << speed << r.report.message;
      ASSERT_GE(small.events.size(), 1u);
      // Positions carry the tolerance of 1e-7 m a step over some tens of steps.
      EXPECT_NEAR(r.events[0].time, small.events[0].time, 5e-6 / speed) << radius << ' ' << speed;
    }
  }
}

}  // namespace
}  // namespace snare::coupling
