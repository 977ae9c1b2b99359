#include "coupling/dynamics/model/start.hpp"
#include "coupling/dynamics/run/simulate.hpp"

#include "base/errors.hpp"
#include "coupling/dynamics/contact/contact_part.hpp"
#include "coupling/dynamics/joints/constraint_set.hpp"
#include "coupling/dynamics/joints/mount_part.hpp"
#include "multibody/arm/arm_run.hpp"
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
using multibody::DeflectionLaw;
using multibody::Drive;

/// Two links of 10 kg and 1 m with axes z and y, on the world or on a free body of 100 kg.
multibody::ElasticArm small_arm(bool floating, double stiffness, double damping) {
  multibody::ElasticArm arm;
  int frame = 0;
  if (floating) {
    frame = arm.tree.add_moving(
        0, "base", multibody::JointKind::free, Vector3d::UnitZ(), {},
        multibody::SpatialInertia::about_centre(100.0, {0.1, 0.0, -0.2}, 40.0 * Eigen::Matrix3d::Identity()));
  }
  for (int i = 0; i < 2; ++i) {
    const multibody::Pose X{Eigen::Matrix3d::Identity(), Vector3d(i == 0 ? 0.0 : 1.0, 0.0, 0.0)};
    frame = arm.tree.add_moving(frame, "link" + std::to_string(i), multibody::JointKind::revolute,
                                Vector3d::Unit(2 - i), X,
                                multibody::SpatialInertia::about_centre(
                                    10.0, {0.5, 0.05, 0.0}, Vector3d(0.1, 0.9, 0.9).asDiagonal()));
    multibody::ElasticJoint joint;
    joint.name = "joint" + std::to_string(i);
    joint.body = arm.tree.size() - 1;
    joint.motor_inertia = 2.0;
    joint.spring = DeflectionLaw::linear(stiffness, damping);
    arm.joints.push_back(joint);
  }
  arm.tree.add_fixed(frame, "tip", {Eigen::Matrix3d::Identity(), {1.0, 0.0, 0.0}});
  return arm;
}

MotionArm standing(const multibody::ElasticArm& arm, const Drive& drive) {
  MotionArm m;
  m.arm = arm;
  m.start = multibody::resting(arm, multibody::zero_state(arm.tree).q);
  m.drives.assign(arm.joints.size(), drive);
  return m;
}

int tip_of(const MotionArm& arm) {
  return arm.arm.tree.find_frame("tip");
}

MotionBody block(double mass, const Vector3d& moments, const Vector3d& position) {
  MotionBody body;
  body.properties.mass = mass;
  body.properties.inertia = moments.asDiagonal();
  body.start.position = position;
  return body;
}

MotionOptions fine(double duration) {
  MotionOptions o;
  o.duration = duration;
  o.output_interval = duration / 20.0;
  o.relative_tolerance = 1e-8;
  o.position_tolerance = o.angle_tolerance = 1e-11;
  o.velocity_tolerance = o.spin_tolerance = 1e-8;
  o.max_order = 5;
  return o;
}

/// Compares the Jacobian of a system with differences at a point, along the spheres of the quaternions that
/// start at `quaternions`.
void expect_jacobian(numerics::DaeSystem& system, const VectorXd& y, const VectorXd& rate,
                     const std::vector<int>& quaternions, double limit) {
  const test::DerivativeError error =
      test::compare_dae_jacobian(system, y, rate, test::along_unit_quaternions(y, quaternions), 1e-3);
  EXPECT_LT(error.relative, limit) << error.worst;
}

TEST(MotionLink, WeldJacobianMatchesDifferences) {
  for (const bool floating : {false, true}) {
    const MotionOptions options;
    const multibody::ElasticArm model = small_arm(floating, 30.0, 1.0);
    multibody::ElasticArmPart arm(model, {Drive::limp(), Drive::limp()}, {});
    const MotionBody held = block(3.0, {0.3, 0.4, 0.5}, Vector3d::Zero()),
                     other = block(2.0, {0.2, 0.3, 0.4}, Vector3d::Zero());
    BodyPart body(held, Vector3d::Zero(), options), second(other, Vector3d::Zero(), options);
    const multibody::Pose X_BF{
        Eigen::AngleAxisd(0.4, Vector3d(1.0, 2.0, -1.0).normalized()).toRotationMatrix(), {0.9, 0.1, -0.2}};
    WeldPart weld("weld", {arm, model.tree.size() - 1, X_BF}, body, {}, options);
    WeldPart next("next", {body, X_BF}, second, {}, options);
    numerics::DaeSystem system({&body, &second, &arm, &weld, &next});
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    VectorXd y(system.size()), rate(system.size());
    for (double& v : y) v = unit(random);
    for (double& v : rate) v = unit(random);
    std::vector<int> quaternions{body.quaternion(), second.quaternion()};
    if (floating) quaternions.push_back(arm.coordinates() + 3);
    for (const int q : quaternions) y.segment<4>(q).normalize();
    arm.settle(0.0, y);
    expect_jacobian(system, y, rate, quaternions, 1e-8);
  }
}

/// strain: of the spring of a mount that gives [m].
void expect_mount_jacobian(wire::Formulation formulation, const MountGive& give = {}, double strain = 0.0) {
  for (const wire::End end : wire::ends) {
    for (const bool driven : {false, true}) {
      const MotionOptions options;
      wire::RodInMotion soft = test::soft_wire(6);
      soft.formulation = formulation;
      wire::RodPart rod("wire", soft, {});
      MotionBody frame = block(0.05, {2e-3, 3e-3, 4e-3}, Vector3d::Zero());
      frame.driven = driven;
      BodyPart body(frame, Vector3d::Zero(), options);
      multibody::Pose X_BM;
      X_BM.p = end == wire::End::left ? Vector3d(-strain, 0.0, 0.0) : Vector3d(0.2 - strain, 0.0, 0.0);
      MountPart mount({"mount", 0, end, {MotionCarrier::Kind::body, 0, 0}, give}, {body, X_BM}, rod, options);
      numerics::DaeSystem system({&rod, &body, &mount});
      std::mt19937 random(3);
      std::uniform_real_distribution<double> unit(-1.0, 1.0);
      VectorXd y = VectorXd::Zero(system.size()), rate(system.size());
      body.place(y);
      Matrix3Xd positions = straight_wire(test::soft_wire(6), Vector3d::Zero(), {0.2, 0.0, 0.0}),
                velocities(3, 7);
      // In the plane, where the carried frames have no holonomy and the Hessian is exact.
      for (int i = 0; i < 7; ++i) {
        positions.col(i) += 2e-3 * Vector3d(unit(random), unit(random), 0.0);
        velocities.col(i) = 0.1 * Vector3d(unit(random), unit(random), 0.0);
      }
      rod.place(positions, velocities, y);
      y.segment<3>(body.velocity()) << 0.1, -0.2, 0.3;
      if (!driven) y.segment<3>(body.spin()) << 0.4, -0.3, 0.5;
      y.segment(mount.multipliers(), mount.constraints()) =
          Vector3d(0.3, -0.5, 0.2).head(mount.constraints());
      for (double& v : rate) v = 0.1 * unit(random);
      expect_jacobian(system, y, rate, {body.quaternion()}, 1e-7);
    }
  }
}

TEST(MotionLink, MountJacobianMatchesDifferences) {
  expect_mount_jacobian(wire::Formulation::vertices);
}
TEST(MotionLink, MountJacobianOfHigherOrderMatchesDifferences) {
  expect_mount_jacobian(wire::Formulation::higher_order);
}

TEST(MotionLink, JacobianOfAMountThatGivesMatchesDifferences) {
  MountGive give{40.0, 3.0};
  expect_mount_jacobian(wire::Formulation::vertices, give);
  expect_mount_jacobian(wire::Formulation::higher_order, give);
  give.slip_force = 0.1;  // at a strain of 2.5 mm
  expect_mount_jacobian(wire::Formulation::vertices, give, 0.01);
  expect_mount_jacobian(wire::Formulation::vertices, give, -0.01);
}

TEST(MotionLink, TwoWeldedBodiesAreOneRigidBody) {
  // Free flight of two welded blocks beside that of the composite body, by the same tolerances.
  MotionBody a = block(2.0, {0.1, 0.2, 0.25}, {0.3, -0.1, 0.2}),
             b = block(3.0, {0.3, 0.15, 0.2}, {-0.4, 0.5, 0.1});
  a.start.orientation = Eigen::AngleAxisd(0.7, Vector3d(1.0, -1.0, 0.5).normalized());
  const Vector3d spin(0.9, -1.1, 0.6), velocity(0.2, 0.1, -0.3);
  a.start.velocity = velocity + spin.cross(a.start.position);
  a.start.spin = a.start.orientation.inverse() * spin;
  Motion welded;
  welded.bodies = {a, b};
  MotionWeld weld;
  weld.carrier = {MotionCarrier::Kind::body, 0, 0};
  weld.body = 1;
  welded.welds = {weld};

  const Vector3d centre = (2.0 * a.start.position + 3.0 * b.start.position) / 5.0;
  MotionBody whole;
  whole.properties.mass = 5.0;
  whole.properties.inertia.setZero();
  for (const MotionBody* part : {&a, &b}) {
    const Eigen::Matrix3d R = part->start.orientation.toRotationMatrix();
    const Vector3d d = part->start.position - centre;
    whole.properties.inertia +=
        R * part->properties.inertia * R.transpose() +
        part->properties.mass * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
  }
  whole.start.position = centre;
  whole.start.velocity = velocity + spin.cross(centre);
  whole.start.spin = spin;
  Motion rigid;
  rigid.bodies = {whole};

  const MotionOptions options = fine(5.0);
  MotionSample last, plain;
  const MotionResult result = simulate(welded, options, [&](const MotionSample& s) {
    last = s;
    return false;
  });
  const MotionResult reference = simulate(rigid, options, [&](const MotionSample& s) {
    plain = s;
    return false;
  });
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  ASSERT_TRUE(reference.report.usable());
  const Vector3d arm = a.start.position - centre;
  const Vector3d expected = plain.bodies[0].position + plain.bodies[0].orientation * arm;
  // Five seconds at 1e-8 a step.
  EXPECT_LT((last.bodies[0].position - expected).norm(), 1e-5);
  EXPECT_LT((last.bodies[1].orientation * spin - plain.bodies[0].orientation * spin).norm(), 1e-5);
  EXPECT_LT(result.largest_drift,
            1e-8);  // what Newton's method may leave at a tolerance of 1e-8 of places of order one
  EXPECT_LT(std::abs(result.energy.integrator), 1e-6 * result.energy.kinetic);
  EXPECT_LT(result.momentum_error.norm(), 1e-6);
  // The force that holds the second block makes its centre go round.
  EXPECT_GT(last.welds[0].force.norm(), 0.1);
}

TEST(MotionLink, ABodyOnAnArmIsPartOfItsLastLink) {
  // Beside the same arm with the block as part of its tree.
  multibody::ElasticArm arm = small_arm(true, 400.0, 10.0);
  const multibody::SpatialInertia inertia =
      multibody::SpatialInertia::about_centre(8.0, Vector3d::Zero(), 0.7 * Eigen::Matrix3d::Identity());
  Motion welded, whole;
  MotionArm standing_arm = standing(arm, Drive::holding(0.0, 300.0, 50.0));
  standing_arm.drives[0].course = {0.0, 0.5, 0.1, 1.0};
  standing_arm.drives[1].course = {0.0, -0.7, 0.1, 1.0};
  welded.arms = {standing_arm};
  welded.bodies = {block(8.0, Vector3d::Constant(0.7), {2.3, 0.2, -0.1})};
  MotionWeld weld;
  weld.carrier = {MotionCarrier::Kind::arm, 0, tip_of(standing_arm)};
  welded.welds = {weld};
  MotionArm loaded = standing_arm;
  loaded.arm.tree.add_fixed(tip_of(loaded), "block", {Eigen::Matrix3d::Identity(), {0.3, 0.2, -0.1}},
                            inertia);
  whole.arms = {loaded};
  MotionSample a, b;
  const MotionOptions options = fine(2.0);
  const MotionResult with = simulate(welded, options, [&](const MotionSample& s) {
    a = s;
    return false;
  });
  const MotionResult without = simulate(whole, options, [&](const MotionSample& s) {
    b = s;
    return false;
  });
  ASSERT_TRUE(with.report.usable()) << with.report.message;
  ASSERT_TRUE(without.report.usable()) << without.report.message;
  EXPECT_LT((a.arms[0].state.q - b.arms[0].state.q).norm(), 1e-6);
  EXPECT_LT((a.arms[0].state.motor - b.arms[0].state.motor).norm(), 1e-6);
  EXPECT_GT((b.arms[0].state.motor).norm(), 0.5);
  EXPECT_GT(with.energy.work, 0.0);
  EXPECT_LT(std::abs(with.energy.integrator), 1e-5 * (with.energy.work + with.energy.dissipated));
  EXPECT_LT(a.momentum.norm(), 1e-5);  // from rest, nothing outside
  EXPECT_LT(a.angular_momentum.norm(), 1e-5);
}

TEST(MotionLink, AWireBetweenMountsThatMoveTogetherIsTheFixedWire) {
  // On a driven body at a constant velocity: Galileo's frame. The wire is plucked in both.
  Motion fixed;
  MotionWire wire{"wire", test::soft_wire(12), {}, Matrix3Xd::Zero(3, 13)};
  wire.positions = straight_wire(wire.rod, Vector3d::Zero(), {0.2, 0.0, 0.0});
  for (int i = 1; i < 12; ++i) wire.velocities.col(i) = std::sin(EIGEN_PI * i / 12) * Vector3d(0.0, 0.3, 0.2);
  fixed.wires = {wire};
  Motion moving = fixed;
  const Vector3d speed(0.4, -0.2, 0.3);
  moving.wires[0].velocities.colwise() += speed;
  MotionBody carrier = block(1.0, Vector3d::Ones(), {0.1, 0.3, 0.0});
  carrier.driven = true;
  carrier.start.velocity = speed;
  moving.bodies = {carrier};
  for (const wire::End end : wire::ends) {
    MotionMount mount;
    mount.end = end;
    mount.carrier = {MotionCarrier::Kind::body, 0, 0};
    moving.mounts.push_back(mount);
  }
  MotionSample a, b;
  const MotionOptions options = fine(0.1);
  const MotionResult still = simulate(fixed, options, [&](const MotionSample& s) {
    a = s;
    return false;
  });
  const MotionResult carried = simulate(moving, options, [&](const MotionSample& s) {
    b = s;
    return false;
  });
  ASSERT_TRUE(still.report.usable()) << still.report.message;
  ASSERT_TRUE(carried.report.usable()) << carried.report.message;
  const Matrix3Xd shift = (speed * 0.1).replicate(1, 13);
  EXPECT_GT((a.wires[0] - wire.positions).norm(), 1e-3);
  EXPECT_LT((b.wires[0] - shift - a.wires[0]).norm(),
            1e-6);  // of some 5e-3, by two integrations at 1e-8 a step
  EXPECT_LT((b.mount_forces[0] - a.mount_forces[0]).norm(), 1e-4 * a.mount_forces[0].norm() + 1e-6);
  EXPECT_LT(carried.largest_drift, 1e-9);
  // The carrier's work is in the balance.
  EXPECT_LT(std::abs(carried.energy.integrator), 1e-6);
  EXPECT_LT(carried.momentum_error.norm(), 1e-6);
}

TEST(MotionLink, ASpinningFrameStretchesItsWireByTheCentrifugalForce) {
  // A straight wire along x on a heavy free body that spins about z through the wire's middle, settled by its
  // damping: EA u'' = -m w^2 x, u = 0 at both ends, so that the mounts' tension is m w^2 l^2/12 (l the
  // length) less ... at x = +-l/2: N = EA u' = m w^2 (l^2/24 - x^2/2).
  Motion motion;
  wire::RodInMotion rod = test::soft_wire(20);
  rod.damping.axial_time = 2e-3;
  rod.damping.bending_time = 1e-2;
  MotionWire wire{"wire", rod, straight_wire(rod, Vector3d::Zero(), {0.2, 0.0, 0.0}), Matrix3Xd::Zero(3, 21)};
  const double spin = 6.0;
  for (int i = 0; i <= 20; ++i)
    wire.velocities.col(i) = spin * Vector3d::UnitZ().cross(wire.positions.col(i) - Vector3d(0.1, 0.0, 0.0));
  motion.wires = {wire};
  MotionBody carrier = block(1e4, Vector3d::Constant(1e4), {0.1, 0.0, 0.0});
  carrier.start.spin = {0.0, 0.0, spin};
  motion.bodies = {carrier};
  for (const wire::End end : wire::ends) {
    MotionMount mount;
    mount.end = end;
    mount.carrier = {MotionCarrier::Kind::body, 0, 0};
    motion.mounts.push_back(mount);
  }
  MotionOptions options = fine(1.0);
  MotionSample last;
  const MotionResult result = simulate(motion, options, [&](const MotionSample& s) {
    last = s;
    return false;
  });
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  const Vector3d along = last.bodies[0].orientation * Vector3d::UnitX();
  const double load = 0.01 * spin * spin;
  // Half of the end elements' mass is on the end vertices: the mount carries its centripetal force, h/2 m w^2
  // l/2, too.
  const double end = load * (0.2 * 0.2 / 24.0 - 0.1 * 0.1 / 2.0);
  EXPECT_NEAR(last.mount_forces[1].dot(along), end, 2e-2 * std::abs(end));
  EXPECT_NEAR(last.mount_forces[0].dot(along), -end, 2e-2 * std::abs(end));
  // In the carrier's frame the wire rests on its chord.
  for (int i = 0; i <= 20; ++i) {
    const Vector3d x =
        last.bodies[0].orientation.inverse() * (last.wires[0].col(i) - last.bodies[0].position);
    EXPECT_LT(x.tail<2>().norm(), 1e-6);
  }
  EXPECT_LT(result.largest_drift, 1e-9);
}

TEST(MotionLink, MomentumAndEnergyOfAWireOnAFloatingArmStay) {
  // Everything floats: arm, block on its tip, wire on the block, a ball that strikes the wire.
  Motion motion;
  motion.arms = {standing(small_arm(true, 200.0, 2.0), Drive::limp())};
  motion.bodies = {block(2.0, {0.02, 0.03, 0.04}, {2.1, 0.0, 0.0})};
  MotionWeld weld;
  weld.carrier = {MotionCarrier::Kind::arm, 0, tip_of(motion.arms[0])};
  motion.welds = {weld};
  wire::RodInMotion rod = test::soft_wire(16);
  rod.properties.left.position = {2.1, 0.1, -0.1};
  rod.properties.right.position = {2.1, 0.1, 0.1};
  rod.properties.left.direction = rod.properties.right.direction = Vector3d::UnitZ();
  rod.properties.left.director = rod.properties.right.director = Vector3d::UnitX();
  motion.wires = {
      {"wire", rod, straight_wire(rod, rod.properties.left.position, rod.properties.right.position), {}}};
  for (const wire::End end : wire::ends) {
    MotionMount mount;
    mount.end = end;
    mount.carrier = {MotionCarrier::Kind::body, 0, 0};
    motion.mounts.push_back(mount);
  }
  MotionBody ball = block(0.05, {2e-5, 3e-5, 4e-5}, {2.105, 0.1125, 0.01});
  ball.start.velocity = {0.0, -0.4, 0.0};
  motion.bodies.push_back(ball);
  MotionContact contact;
  contact.body = 1;
  contact.shape = std::make_shared<Ball>(0.01);
  contact.wire_radius = 0.001;
  motion.contacts = {contact};
  MotionOptions options = fine(0.05);
  Vector3d momentum, angular;
  double worst = 0.0, worst_angular = 0.0, deepest = 0.0;
  const MotionResult result = simulate(motion, options, [&](const MotionSample& s) {
    if (s.time == 0.0) {
      momentum = s.momentum;
      angular = s.angular_momentum;
    }
    worst = std::max(worst, (s.momentum - momentum).norm() / momentum.norm());
    worst_angular = std::max(worst_angular, (s.angular_momentum - angular).norm() / angular.norm());
    deepest = std::max(deepest, s.arms[0].state.v.norm());
    return false;
  });
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  ASSERT_FALSE(result.events.empty());
  EXPECT_GT(deepest, 1e-4);  // the arm feels it
  EXPECT_LT(worst, 1e-7);
  EXPECT_LT(worst_angular, 1e-7);
  const double energy = 0.5 * 0.05 * 0.16;
  EXPECT_LT(std::abs(result.energy.integrator), 1e-3 * energy);
  EXPECT_LT(result.largest_drift, 1e-8);
}

TEST(MotionLink, DrivesOfAnArmSwitchInAMotion) {
  Motion motion;
  MotionArm arm = standing(small_arm(false, 1000.0, 10.0), Drive::locked());
  arm.start.v << 0.1, 0.0;
  multibody::DriveSwitch limp;
  limp.time = 0.5;
  limp.drives.assign(2, Drive::limp());
  arm.switches = {limp};
  motion.arms = {arm};
  MotionOptions options = fine(1.0);
  double before = 0.0, after = 0.0;
  const MotionResult result = simulate(motion, options, [&](const MotionSample& s) {
    (s.time < 0.499 ? before : after) =
        std::max(s.time < 0.499 ? before : after, s.arms[0].state.motor_rate.norm());
    return false;
  });
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  EXPECT_EQ(before, 0.0);
  EXPECT_GT(after, 1e-3);
  EXPECT_LT(std::abs(result.energy.integrator), 1e-5 * result.energy.dissipated);
}

/// Piecewise law, friction that sticks, a servo that reaches its limit, a switch of the drives at 1 s, a
/// load: all that an arm remembers.
MotionArm restless_arm() {
  multibody::ElasticArm arm = small_arm(false, 1.0, 0.0);
  for (multibody::ElasticJoint& joint : arm.joints) {
    joint.spring = DeflectionLaw({{0.0, 300.0, 5.0}, {0.005, 3000.0, 20.0}});
    joint.friction = {0.5, 0.8, 1e-3, 0.2};
  }
  MotionArm part = standing(arm, Drive::holding(0.0, 400.0, 60.0, 12.0));
  part.drives[0].course = {0.0, 0.4, 0.05, 0.8};
  part.drives[1].course = {0.0, -0.3, 0.05, 0.8};
  multibody::DriveSwitch limp;
  limp.time = 1.0;
  limp.drives = {Drive::limp(), Drive::locked()};
  part.switches = {limp};
  part.loads = {
      {tip_of(part), {Vector3d::Zero(), {0.0, 8.0, 5.0}}, 0.3, 0.4, multibody::TimedLoad::Shape::half_sine}};
  return part;
}

TEST(MotionLink, AnArmInAMotionIsTheArmAlone) {
  // The run of the arm by itself passes the same modes.
  const MotionArm part = restless_arm();
  multibody::ArmScenario alone;
  alone.arm = part.arm;
  alone.initial = part.start;
  alone.drives = part.drives;
  alone.switches = part.switches;
  alone.loads = part.loads;
  alone.end = 2.0;
  alone.ida.relative_tolerance = 1e-8;
  alone.tolerances = {1e-11, 1e-8};
  const multibody::ArmHistory history = multibody::simulate(alone);
  ASSERT_TRUE(history.report.usable()) << history.report.message;
  EXPECT_GT(history.events.size(), 5U);
  Motion motion;
  motion.arms = {part};
  MotionOptions options = fine(2.0);
  MotionSample last;
  const MotionResult result = simulate(motion, options, [&](const MotionSample& s) {
    last = s;
    return false;
  });
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  const multibody::ArmSample& expected = history.samples.back();
  EXPECT_LT((last.arms[0].state.q - expected.state.q).norm(), 1e-6);
  EXPECT_LT((last.arms[0].state.motor - expected.state.motor).norm(), 1e-6);
  EXPECT_NEAR(last.energy.kinetic + last.energy.strain, expected.energy, 1e-5);
  EXPECT_NEAR(last.energy.dissipated, expected.work.lost, 1e-5);
  EXPECT_GE(result.statistics.restarts, static_cast<long>(history.events.size()) / 2);
}

TEST(MotionLink, AnArmGoesOnFromACheckpointToTheSameBits) {
  // Checkpoints fall on the load's begin and end and on the switch, and between them.
  Motion motion;
  motion.arms = {restless_arm()};
  MotionOptions options = fine(1.6);
  options.output_interval = 0.04;
  options.checkpoint_interval = 0.1;
  std::vector<VectorXd> whole;
  const auto into = [](std::vector<VectorXd>& list) {
    return [&list](const MotionSample& s) {
      list.push_back(s.arms[0].state.q);
      list.push_back(s.arms[0].state.motor_rate);
      list.push_back(s.arms[0].joint_torque);
      list.push_back(Vector3d(s.energy.dissipated, s.energy.work, s.energy.integrator));
      return false;
    };
  };
  std::vector<MotionState> states;
  const MotionResult through =
      simulate(motion, options, into(whole), nullptr, [&](const MotionState& s) { states.push_back(s); });
  ASSERT_TRUE(through.report.usable()) << through.report.message;
  ASSERT_EQ(states.size(), 15U);
  for (const MotionState& from : states) {
    std::vector<VectorXd> parts(whole.begin(), whole.begin() + 4 * from.sums.samples);
    const MotionResult on = simulate(motion, options, into(parts), &from);
    ASSERT_TRUE(on.report.usable()) << on.report.message;
    EXPECT_EQ(parts, whole) << "from " << from.time << " s";
    EXPECT_EQ(on.last.unknowns, through.last.unknowns);
    EXPECT_EQ(on.last.memory, through.last.memory);
    EXPECT_EQ(on.statistics.steps, through.statistics.steps);
  }
  // The legs change nothing that matters.
  options.checkpoint_interval = std::numeric_limits<double>::infinity();
  std::vector<VectorXd> undivided;
  ASSERT_TRUE(simulate(motion, options, into(undivided)).report.usable());
  ASSERT_EQ(undivided.size(), whole.size());
  for (std::size_t k = 0; k < whole.size(); k += 4) EXPECT_LT((undivided[k] - whole[k]).norm(), 1e-6) << k;
}

TEST(MotionLink, WrongLinksAreNamedAllAtOnce) {
  Motion motion;
  motion.bodies = {block(1.0, Vector3d::Ones(), Vector3d::Zero()),
                   block(1.0, Vector3d::Ones(), Vector3d::UnitX())};
  motion.bodies[1].driven = true;
  motion.wires = {
      {"wire", test::soft_wire(8), straight_wire(test::soft_wire(8), Vector3d::Zero(), {0.2, 0.0, 0.0}), {}}};
  MotionWeld first, second, third;
  first.carrier = {MotionCarrier::Kind::arm, 0, 0};
  second.carrier = {MotionCarrier::Kind::body, 1, 0};
  third.body = 1;
  third.name = "other";
  motion.welds = {first, second, third};
  MotionMount mount;
  mount.wire = 2;
  motion.mounts = {mount};
  EXPECT_THAT(test::refusal([&] { return simulate(motion, {}); }),
              testing::AllOf(testing::HasSubstr("weld.carrier = 0, must be the index of an arm"),
                             testing::HasSubstr("weld.body = 0, must not be held by two welds"),
                             testing::HasSubstr("other.body = 1, must not be driven"),
                             testing::HasSubstr("mount.wire = 2, must be the index of a wire")));
}

}  // namespace
}  // namespace snare::coupling
