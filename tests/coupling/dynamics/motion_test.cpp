#include "coupling/dynamics/model/start.hpp"
#include "coupling/dynamics/run/simulate.hpp"

#include "base/errors.hpp"
#include "coupling/contact/curve.hpp"
#include "coupling/dynamics/contact/contact_part.hpp"
#include "coupling/dynamics/joints/body_part.hpp"
#include "tests/support/dae_jacobian.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/soft_wire.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace snare::coupling {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// A soft wire of 0.2 m between clamps, free ends on request.
wire::RodInMotion soft_rod(int elements, wire::SpatialEnd::Kind kind) {
  wire::RodInMotion rod = test::soft_wire(elements);
  rod.properties.left.kind = rod.properties.right.kind = kind;
  return rod;
}

/// A ball on a body of 50 g below the wire's middle, moving up; the body's centre is beside the ball's.
Motion ball_below(const wire::RodInMotion& rod, double speed) {
  Motion motion;
  motion.wires.push_back({"wire", rod, straight_wire(rod, Vector3d::Zero(), {0.2, 0.0, 0.0}), {}});
  MotionBody body;
  body.properties.mass = 0.05;
  body.properties.inertia = Vector3d(2e-5, 3e-5, 4e-5).asDiagonal();
  body.start.position = {0.08, -0.0125, 0.004};
  body.start.velocity = {0.0, speed, 0.0};
  motion.bodies.push_back(body);
  MotionContact contact;
  contact.shape = std::make_shared<Ball>(0.01);
  contact.X_BS.p = {0.015, 0.0, -0.004};
  contact.wire_radius = 0.001;
  motion.contacts.push_back(contact);
  return motion;
}

double relative(const Vector3d& change, const Vector3d& scale) {
  return change.norm() / scale.norm();
}

TEST(MotionCurve, IsSmoothAndHitsItsVertices) {
  wire::RodInMotion constants = soft_rod(12, wire::SpatialEnd::Kind::clamp);
  constants.grading = 1.0;
  const wire::RodPart rod("wire", constants, {});
  const auto at = [&](double s) {
    const CurveWeights w = curve_weights(rod, s);
    double value = 0.0;
    double slope = 0.0;
    for (int k = 0; k < 4; ++k) {
      const double x = rod.coordinate(w.first + k);
      value += w.value[k] * x * x;
      slope += w.slope[k] * x * x;
    }
    EXPECT_NEAR(w.value.sum(), 1.0, 1e-14);  // a rigid shift moves the curve with it
    EXPECT_NEAR(w.slope.sum(), 0.0, 1e-10);
    return std::pair{value, slope};
  };
  // The slopes are those of parabolas, so a parabola is reproduced.
  for (int i = 0; i <= 54; ++i) {
    const double s = 0.0037 * i;
    EXPECT_NEAR(at(s).first, s * s, 1e-15);
    EXPECT_NEAR(at(s).second, 2.0 * s, 1e-13);
  }
}

TEST(MotionJacobian, MatchesDifferencesInContact) {
  Motion motion = ball_below(soft_rod(8, wire::SpatialEnd::Kind::clamp), 0.1);
  motion.contacts[0].friction = {0.3, 0.1, 0.01, 1.0, ContactFriction::smooth};
  const MotionOptions options;
  wire::RodPart rod("wire", motion.wires[0].rod, {});
  BodyPart body(motion.bodies[0], Vector3d::Zero(), options);
  motion.contacts[0].foundation = {3e8, 1.0};  // as soft as the wire, so that no row drowns the others
  ContactPart contact(motion.contacts[0], motion.contacts[0].shape, rod, body);
  numerics::DaeSystem system({&rod, &body, &contact});
  VectorXd y = VectorXd::Zero(system.size());
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Matrix3Xd positions = motion.wires[0].positions;
  Matrix3Xd velocities = Matrix3Xd::Zero(3, 9);
  for (int i = 1; i < 8; ++i) {
    positions.col(i) += 1e-3 * Vector3d(unit(random), unit(random), 0.0);
    velocities.col(i) = 0.1 * Vector3d(unit(random), unit(random), 0.0);
  }
  rod.place(positions, velocities, y);
  body.place(y);
  y.segment<4>(body.quaternion()) = Eigen::Vector4d(0.98, 0.1, -0.12, 0.11).normalized();
  y.segment<3>(body.spin()) << 0.3, -0.2, 0.5;
  y[body.position() + 1] += contact.search().nearest(y).gap + 2e-6;
  contact.update_candidates(y);
  ASSERT_GT(contact.sums(y).force.norm(), 0.05);
  VectorXd rate(y.size());
  for (double& r : rate) r = 0.1 * unit(random);
  // Directions of a size that suits each unknown; the quaternion moves along the sphere, as it does in a
  // motion.
  const Eigen::MatrixXd directions = test::along_unit_quaternions(y, {body.quaternion()});
  const test::DerivativeError error = test::compare_dae_jacobian(system, y, rate, directions, 1e-3);
  // The derivative's integral by Gauss's rule, not that of the rule, beside differences of the force.
  EXPECT_LT(error.relative, 1e-4) << error.worst;
}

TEST(Motion, MomentumOfAFreeWireAndABodyStays) {
  Motion motion = ball_below(soft_rod(16, wire::SpatialEnd::Kind::free), 0.5);
  MotionOptions options;
  options.duration = 0.02;
  options.output_interval = 0.001;
  options.relative_tolerance = 1e-9;
  options.position_tolerance = 1e-12;
  options.velocity_tolerance = 1e-9;
  options.angle_tolerance = 1e-12;
  options.spin_tolerance = 1e-9;
  options.body_position_tolerance = 1e-12;
  options.body_velocity_tolerance = 1e-9;
  options.max_order = 5;
  Vector3d momentum;
  Vector3d angular;
  double worst = 0.0;
  double worst_angular = 0.0;
  bool closed = false;
  const MotionResult result = simulate(motion, options, [&](const MotionSample& s) {
    if (s.time == 0.0) {
      momentum = s.momentum;
      angular = s.angular_momentum;
    }
    closed = closed || s.contacts[0].closed;
    worst = std::max(worst, relative(s.momentum - momentum, momentum));
    worst_angular = std::max(worst_angular, relative(s.angular_momentum - angular, angular));
    return false;
  });
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  EXPECT_TRUE(closed);
  EXPECT_LT(worst, 1e-9);
  EXPECT_LT(worst_angular, 1e-9);  // of the integrator at its tolerance of 1e-9 a step
  EXPECT_LT(result.largest_drift, 1e-9);
}

TEST(Motion, EnergyOfADampedImpactIsAccountedFor) {
  Motion motion = ball_below(soft_rod(16, wire::SpatialEnd::Kind::clamp), 0.3);
  motion.bodies[0].start.velocity.x() = 0.2;  // slides along the wire
  motion.contacts[0].friction = {0.3, 0.1, 0.01, 1.0};
  MotionOptions options;
  options.duration = 0.05;
  options.relative_tolerance = 1e-6;
  options.position_tolerance = 1e-9;
  options.velocity_tolerance = 1e-6;
  const MotionResult result = simulate(motion, options);
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  const double energy = 0.5 * 0.05 * (0.09 + 0.04);
  EXPECT_GT(result.energy.dissipated, 1e-3 * energy);
  EXPECT_LT(std::abs(result.energy.integrator), 1e-3 * energy);
  EXPECT_LT(result.largest_penetration, 1e-6);
  EXPECT_GT(result.peak_force[0], 0.0);
  EXPECT_LT(result.momentum_error.norm(), 1e-6 * result.impulse[0].norm());
}

TEST(Motion, ALawTakesThePlaceOfTheFoundation) {
  Motion motion = ball_below(soft_rod(16, wire::SpatialEnd::Kind::clamp), 0.3);
  const double stiffness = 2e4;
  motion.contacts[0].law = spring_dashpot(stiffness, 0.0);
  MotionOptions options;
  options.duration = 0.01;
  options.output_interval = 1e-4;
  double force = 0.0;
  const MotionResult result = simulate(motion, options, [&](const MotionSample& s) {
    if (s.contacts[0].closed) {
      EXPECT_NEAR(s.contacts[0].normal_force, std::max(0.0, -stiffness * s.contacts[0].gap), 2e-2);
      force = std::max(force, s.contacts[0].normal_force);
    }
    return false;
  });
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  EXPECT_GT(force, 0.01);
}

TEST(Motion, ObserverStopsIt) {
  const Motion motion = ball_below(soft_rod(8, wire::SpatialEnd::Kind::clamp), 0.1);
  MotionOptions options;
  options.output_interval = 1e-3;
  const MotionResult result = simulate(motion, options, [](const MotionSample& s) { return s.time > 2e-3; });
  EXPECT_EQ(result.report.termination, numerics::Termination::interrupted);
  EXPECT_LT(result.report.time, 0.1);
}

TEST(Motion, WrongNumbersAreNamedAllAtOnce) {
  Motion motion = ball_below(soft_rod(8, wire::SpatialEnd::Kind::clamp), 0.1);
  motion.wires[0].rod.length = -1.0;
  motion.bodies[0].properties.mass = 0.0;
  motion.contacts[0].wire = 3;
  EXPECT_THAT(test::refusal([&] { return simulate(motion, {}); }),
              testing::AllOf(testing::HasSubstr("wire.length = -1, must be > 0"),
                             testing::HasSubstr("body.mass = 0, must be > 0"),
                             testing::HasSubstr("contact.wire = 3, must be the index of a wire")));
}

}  // namespace
}  // namespace snare::coupling
