#include "coupling/dynamics/laws/law_wire_part.hpp"

#include "coupling/dynamics/run/simulate.hpp"
#include "multibody/arm/arm_part.hpp"
#include "tests/support/dae_jacobian.hpp"
#include "tests/support/motion_bodies.hpp"
#include "tests/support/same_bits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace snare::coupling {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using test::block;
using test::body_of;
using test::fine;

/// Wire of a ring of a radius, from azimuth 0 to theta, about a shaft along z that body 0 carries in the
/// middle.
LawWire ring_wire(double radius, double theta, double length) {
  LawWire w;
  w.p_from = {radius, 0.0, 0.0};
  w.p_to = {radius * std::cos(theta), radius * std::sin(theta), 0.0};
  w.bulge = {std::cos(0.5 * theta), std::sin(0.5 * theta), 0.0};
  w.length = length;
  w.axial_stiffness = 5e4;
  w.radius = 0.75e-3;
  w.shaft.radius = 6e-3;
  w.shaft.half_length = 0.1;
  w.shaft.carrier = body_of(0);
  return w;
}

MovingFrame fixed_at(const Vector3d& p) {
  return MovingFrame({Eigen::Matrix3d::Identity(), p});
}

/// A wire between fixed mounts about a shaft at the origin, told its reach with the ring open, where it is
/// slack.
struct WireAboutShaft {
  BodyPart body{block("shaft", 1.0, {0.1, 0.1, 0.1}), Vector3d::Zero(), MotionOptions()};
  LawWirePart part;
  VectorXd y;  ///< the shaft at rest at the origin

  explicit WireAboutShaft(const LawWire& w) : part(w, fixed_at(w.p_from), fixed_at(w.p_to), {body, {}}) {
    numerics::DaeLayout layout;
    body.declare(layout);
    y = VectorXd::Zero(layout.size());
    y[body.quaternion()] = 1.0;
    const std::vector<double> before{1.0, 1.0, std::numbers::pi, 0.0};
    std::span<const double> memory = before;
    part.restore_state(y, memory);
  }
  /// The unknowns with the shaft at rest at a point.
  [[nodiscard]] VectorXd at(const Vector3d& p) const {
    VectorXd there = y;
    there.segment<3>(body.position()) = p;
    return there;
  }
};

// The length of a string about a shaft in the middle of a ring, beyond the angle at which it touches: 2
// sqrt(R^2 - r^2) + r (theta - 2 acos(r/R)); its ends pull the ring with the moment T r, and the shaft with 2
// T sin(half the turn).
TEST(LawWire, RingHasTheClosedForm) {
  constexpr double radius = 0.1, r = 6.75e-3, length = 0.2;
  for (const double degrees : {170.0, 177.0, 180.0, 200.0, 340.0}) {
    const double theta = degrees * std::numbers::pi / 180.0;
    const LawWire w = ring_wire(radius, theta, length);
    const WireAboutShaft wire(w);
    const LawWirePart& part = wire.part;
    const VectorXd& y = wire.y;
    const double touch = 2.0 * std::acos(r / radius);
    const double taut = theta < touch ? 2.0 * radius * std::sin(0.5 * theta)
                                      : 2.0 * std::sqrt(radius * radius - r * r) + r * (theta - touch);
    const double tension = std::max(0.0, w.axial_stiffness * (taut - length) / length);
    EXPECT_NEAR(part.shape(y).tension, tension, 1e-9 * w.axial_stiffness) << degrees;
    if (tension == 0.0) {
      EXPECT_TRUE(part.wrenches(y).empty()) << degrees;
      continue;
    }
    const std::vector<multibody::Wrench> wrenches = part.wrenches(y);
    EXPECT_NEAR(w.p_to.cross(wrenches[1].force).z(), -tension * r, 1e-9 * tension) << degrees;
    EXPECT_NEAR(w.p_from.cross(wrenches[0].force).z(), tension * r, 1e-9 * tension) << degrees;
    EXPECT_NEAR(
        part.load({0.0, y, y}).normal,
        2.0 * tension * std::sin(0.5 * (theta - touch)) * (theta - touch > std::numbers::pi ? -1.0 : 1.0),
        1e-9 * tension)
        << degrees;
  }
}

// A shaft that is pressed into a mount of its wire: length and force go on, and the force is the slope of the
// energy on both sides.
TEST(LawWire, GoesOnWhereTheShaftReachesAMount) {
  constexpr double r = 6.75e-3, theta = 3.0, length = 0.19;
  const LawWire w = ring_wire(0.1, theta, length);
  const WireAboutShaft wire(w);
  const LawWirePart& part = wire.part;
  // Towards the mount from the side on which the wire lies before the shaft.
  const Vector3d inward = -w.p_to.normalized();
  const auto at = [&](double distance) { return wire.at(w.p_to + distance * inward); };
  const auto force = [&](double distance) { return part.wrenches(at(distance)).at(2).force; };
  const auto energy = [&](double distance) { return part.work(at(distance)).power.energy; };
  EXPECT_NEAR(part.depth(at(r * (1.0 + 1e-9))), part.depth(at(r * (1.0 - 1e-9))), 1e-9);
  EXPECT_LT((force(r * (1.0 + 1e-9)) - force(r * (1.0 - 1e-9))).norm(), 1e-3 * force(r).norm());
  for (const double distance : {1.5 * r, 1.01 * r, 0.99 * r, 0.6 * r}) {
    constexpr double step = 1e-7;
    const double slope = (energy(distance + step) - energy(distance - step)) / (2.0 * step);
    EXPECT_NEAR(force(distance).dot(inward), -slope, 1e-4 * std::abs(slope) + 1e-3) << distance / r;
  }
}

// A shaft thrown at a mount of a slack string: (v/a - ln(1 + a v)/a^2) is the same before, at v, and after,
// at -v, as m v dv/dx = -k x (1 + a v).
TEST(LawWire, MountThrowsTheShaftBack) {
  constexpr double speed = 0.002, a = 1000.0, r = 6.75e-3;
  Motion motion;
  motion.bodies = {block("shaft", 20.0, {2.0, 3.0, 1.0})};
  motion.bodies[0].start.velocity = {speed, 0.0, 0.0};
  LawWire w = ring_wire(0.1, 2.0, 0.25);
  const Vector3d start(0.1 - r - 1e-4, 0.0, 0.0);
  for (Vector3d* p : {&w.p_from, &w.p_to}) *p -= start;
  motion.law_wires.push_back(w);
  Vector3d after = Vector3d::Zero();
  const MotionResult result = simulate(motion, fine(0.2, 1e-2), [&](const MotionSample& s) {
    after = s.bodies[0].velocity;
    return false;
  });
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  const auto kept = [](double v) { return v / a - std::log1p(a * v) / (a * a); };
  EXPECT_NEAR(kept(after.x()), kept(speed), 1e-4 * kept(speed));  // 5e-5; falls with the tolerances
  EXPECT_LT(after.x(), 0.0);
  EXPECT_NEAR(after.y(), 0.0, 1e-12);
  EXPECT_NEAR(result.energy.dissipated, 10.0 * (speed * speed - after.x() * after.x()),
              1e-4 * 10.0 * speed * speed);
  // Its force at rest.
  const WireAboutShaft wire(ring_wire(0.1, 2.0, 0.25));
  const double k = w.axial_stiffness / r;
  const Vector3d inside(0.1 - 0.9 * r, 0.0, 0.0);
  EXPECT_NEAR(wire.part.wrenches(wire.at(inside)).at(2).force.x(), -k * 0.1 * r, 1e-9 * k * r);
  EXPECT_NEAR(wire.part.wrenches(wire.at(inside)).at(0).force.x(), k * 0.1 * r, 1e-9 * k * r);
  EXPECT_NEAR(wire.part.load({0.0, wire.at(inside), wire.at(inside)}).normal, k * 0.1 * r, 1e-9 * k * r);
}

TEST(LawWire, JacobianMatchesDifferences) {
  const multibody::ElasticArm model = test::one_joint("ring", Vector3d(0.1, 0.05, 1.0).normalized());
  multibody::ElasticArmPart arm(model, {multibody::Drive::limp()}, {});
  const MotionOptions options;
  BodyPart a(block("a", 3.0, {0.3, 0.4, 0.5}), Vector3d::Zero(), options);
  BodyPart b(block("b", 2.0, {0.2, 0.3, 0.4}), Vector3d::Zero(), options);
  LawWire w = ring_wire(0.1, 3.1, 0.15);
  w.axial_stiffness = 10.0;
  w.axial_time = 0.05;
  w.friction.law = ContactFriction::smooth;
  w.friction.static_coefficient = 0.4;
  w.friction.dynamic_coefficient = 0.2;
  w.friction.static_speed = 0.05;
  w.friction.dynamic_speed = 2.0;
  w.shaft.half_length = 10.0;
  const auto at = [](const Vector3d& p) { return multibody::Pose{Eigen::Matrix3d::Identity(), p}; };
  const multibody::Pose X_BS{Eigen::AngleAxisd(0.2, Vector3d(1.0, 2.0, -1.0).normalized()).toRotationMatrix(),
                             {0.02, -0.01, 0.02}};
  LawWirePart string(w, {a, at(w.p_from)}, {arm, 0, at(w.p_to)}, {b, X_BS});
  w.kind = LawWire::Kind::rod;
  w.law = spring_dashpot(300.0, 2.0);
  LawWirePart rod(w, {a, at(w.p_from)}, {arm, 0, at(w.p_to)}, {b, X_BS});
  w.kind = LawWire::Kind::push;
  w.push = [](const Eigen::Vector2d& place, double rate) {  // of an energy with a dashpot across the chord
    WirePush p;
    const double s = place.x(), d = place.y() + 0.2;
    p.depth = d;
    p.force = {100.0 * d * d, 200.0 * d * s + 3.0 * rate};
    p.by_place << 0.0, 200.0 * d, 200.0 * d, 200.0 * s;
    p.by_rate.y() = 3.0;
    return p;
  };
  LawWirePart push(w, {a, at(w.p_from)}, {a, at(w.p_to)}, {b, X_BS});
  numerics::DaeSystem system({&arm, &a, &b, &string, &rod, &push});
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int acting = 0;
  for (int trial = 0; trial < 12; ++trial) {
    VectorXd y(system.size()), rate(system.size());
    for (double& v : y) v = 0.2 * unit(random);
    for (double& v : rate) v = unit(random);
    for (const BodyPart* body : {&a, &b}) {
      y.segment<3>(body->position()) *= 0.05;
      y.segment<4>(body->quaternion()) =
          (y.segment<4>(body->quaternion()) * 0.3 + Eigen::Vector4d(1.0, 0, 0, 0)).normalized();
    }
    const Eigen::MatrixXd directions = test::along_unit_quaternions(y, {a.quaternion(), b.quaternion()});
    // In every other trial the shaft is pressed into a mount.
    if (trial % 2 == 1) {
      const Eigen::Matrix3d turned = multibody::rotation(y.segment<4>(b.quaternion()));
      const Vector3d mount =
          y.segment<3>(a.position()) + multibody::rotation(y.segment<4>(a.quaternion())) * w.p_from;
      y.segment<3>(b.position()) = mount - turned * (X_BS.p + X_BS.R * Vector3d(4e-3, 2e-3, 0.0));
    }
    y[arm.coordinates()] *= 0.2;
    arm.settle(0.0, y);
    for (LawWirePart* part : {&string, &rod, &push}) {
      const std::vector<double> held{1.0, 1.0, std::numbers::pi, 0.0};
      std::span<const double> memory = held;
      part->restore_state(y, memory);
      acting += part->wrenches(y).empty() ? 0 : 1;
    }
    const test::DerivativeError error = test::compare_dae_jacobian(system, y, rate, directions, 1e-5);
    EXPECT_LT(error.relative, 2e-6) << trial << ": " << error.worst;
  }
  EXPECT_GE(acting, 24);
}

/// A body with a shaft between three strings of a ring that is turned to an angle, thrown in its plane and
/// along the axis.
Motion thrown(LawWire::Kind kind) {
  Motion motion;
  motion.bodies = {block("visitor", 20.0, {2.0, 3.0, 1.0}), block("ring", 5.0, {0.4, 0.5, 0.6})};
  motion.bodies[0].start.velocity = {0.1, 0.065, 0.004};
  motion.bodies[0].start.spin = {0.1, 0.02, 0.05};
  for (int k = 0; k < 3; ++k) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(2.0 * std::numbers::pi * k / 3.0, Vector3d::UnitZ()).toRotationMatrix();
    LawWire w = ring_wire(0.1, 2.7, 0.1975);
    w.name = "wire " + std::to_string(k);
    w.kind = kind;
    if (kind == LawWire::Kind::rod) w.law = stretched_wire_law(5e5, 0.1, 0.0995);
    w.p_from = turn * w.p_from + Vector3d(0, 0, 0.003 * k);
    w.p_to = turn * w.p_to + Vector3d(0, 0, 0.003 * k);
    w.bulge = turn * w.bulge;
    w.from = w.to = body_of(1);
    w.tightness.watched = true;
    motion.law_wires.push_back(w);
  }
  return motion;
}

// Without friction and damping nothing is lost, whatever the shaft does between the strings; momenta stay.
// Tolerances as those of the integration.
TEST(LawWire, StringsKeepEnergyAndMomentum) {
  const Motion motion = thrown(LawWire::Kind::stretched);
  double highest = 0.0;
  const MotionResult r = simulate(motion, fine(3.0, 1e-2), [&](const MotionSample& s) {
    for (const double tension : s.law_tensions) highest = std::max(highest, tension);
    return false;
  });
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  const double energy = r.energy.kinetic + r.energy.strain;
  EXPECT_GT(highest, 50.0);
  EXPECT_GE(r.events.size(), 4u);
  EXPECT_NEAR(r.energy.dissipated, 0.0, 1e-12);
  EXPECT_NEAR(r.energy.integrator / energy, 0.0, 2e-6);
  EXPECT_LT(r.momentum_error.norm(), 1e-8);
  EXPECT_LT(r.angular_momentum_error.norm(), 1e-8);
}

/// Friction of the shaft on every wire, by its coefficients [-].
void rub(Motion& motion, double at_rest, double sliding) {
  for (LawWire& w : motion.law_wires) {
    w.friction.law = ContactFriction::smooth;
    w.friction.static_coefficient = at_rest;
    w.friction.dynamic_coefficient = sliding;
    w.friction.static_speed = 0.01;
  }
}

// With friction, damping and with the rods all that goes is accounted for.
TEST(LawWire, LossesCloseTheBalance) {
  for (const LawWire::Kind kind : {LawWire::Kind::stretched, LawWire::Kind::rod}) {
    Motion motion = thrown(kind);
    for (LawWire& w : motion.law_wires) w.axial_time = 1e-3;
    rub(motion, 0.3, 0.1);
    const MotionResult r = simulate(motion, fine(3.0, 1e-2), {});
    ASSERT_TRUE(r.report.usable()) << r.report.message;
    const double energy = r.energy.kinetic + r.energy.strain;
    EXPECT_NEAR(r.energy.integrator / energy, 0.0, 1e-4);  // falls with the tolerances
    EXPECT_LT(r.momentum_error.norm(), 1e-8);
    EXPECT_LT(r.angular_momentum_error.norm(), 1e-8);
    if (kind == LawWire::Kind::stretched) {
      EXPECT_GT(r.energy.dissipated, 0.01 * energy);
    }
  }
}

// A shaft in the middle of a rod that is driven into it: x = lever (commanded less actual angle), the angle
// of the tangent.
TEST(LawWire, RodIsMetByItsAngle) {
  LawWire w = ring_wire(0.1, std::numbers::pi, 0.2);  // the chord is the x axis, the bulge y
  w.kind = LawWire::Kind::rod;
  constexpr double k = 1e4, r = 6.75e-3;
  w.law = spring_dashpot(k, 0.0);
  const WireAboutShaft wire(w);
  const LawWirePart& part = wire.part;
  VectorXd y = wire.at({0.02, -0.004, 0.0});
  // From the pivot at x = R the axis stands at an angle above the chord of asin(y/rho); the tangent is
  // asin(r/rho) beyond.
  const auto x = [](double along, double height) {
    const double rho = std::hypot(0.1 - along, height);
    return std::sqrt(rho * rho - r * r) * (std::asin(height / rho) + std::asin(r / rho));
  };
  // The force does the work of k x dx, whichever way the shaft moves.
  const double h = 1e-6, deep = x(0.02, -0.004);
  const double across = k * deep * (x(0.02, -0.004 + h) - x(0.02, -0.004 - h)) / (2.0 * h);
  const double along = k * deep * (x(0.02 + h, -0.004) - x(0.02 - h, -0.004)) / (2.0 * h);
  EXPECT_NEAR(across, k * deep, 3e-3 * k * deep);  // the turn and r/rho change the lever by (0.05)^2
  EXPECT_NEAR(part.load({0.0, y, y}).normal, across, 1e-7 * across);
  EXPECT_NEAR(part.wrenches(y)[2].force.y(), -across, 1e-7 * across);
  EXPECT_NEAR(part.wrenches(y)[2].force.x(), -along, 1e-7 * across);
  const Vector3d on_mounts = part.wrenches(y)[0].force + part.wrenches(y)[1].force;
  EXPECT_NEAR(on_mounts.y(), across, 1e-7 * across);
  EXPECT_NEAR(on_mounts.x(), along, 1e-7 * across);
  // Those of a beam on two supports but for the couple of what acts along the rod, at 4 mm beside it.
  EXPECT_NEAR(part.wrenches(y)[0].force.y(), across * 0.6, 0.03 * std::abs(along));
  y = wire.at({0.02, -0.01, 0.0});
  EXPECT_TRUE(part.wrenches(y).empty());
}

/// Two wires on a free ring that a shaft, askew, pushes into corners of an energy that depends on its place
/// in the plane.
Motion askew_in_a_ring() {
  Motion motion;
  motion.bodies = {block("visitor", 2.0, {0.02, 0.03, 0.01}), block("ring", 5.0, {0.04, 0.05, 0.06})};
  motion.bodies[0].start.velocity = {0.03, 0.2, 0.05};
  motion.bodies[0].start.spin = {0.3, 0.2, 0.5};
  for (const double side : {1.0, -1.0}) {
    LawWire w;
    w.name = side > 0.0 ? "before" : "behind";
    w.kind = LawWire::Kind::push;
    w.from = w.to = body_of(1);
    w.p_from = {-0.1, 0.02 * side, 0.0};
    w.p_to = {0.1, 0.02 * side, 0.0};
    w.side = side;
    w.shaft.carrier = body_of(0);
    w.shaft.X_WS.R = Eigen::AngleAxisd(0.3, Vector3d(1.0, 1.0, 0.0).normalized()).toRotationMatrix();
    w.shaft.half_length = 1.0;
    w.shaft.radius = 6e-3;
    w.push = [](const Eigen::Vector2d& place, double) {  // U = 500 s d^2, which begins at the chord
      WirePush p;
      const double s = place.x(), d = p.depth = place.y();
      if (d <= 0.0) return p;
      p.energy = 500.0 * s * d * d;
      p.force = {500.0 * d * d, 1000.0 * s * d};
      p.by_place << 0.0, 1000.0 * d, 1000.0 * d, 1000.0 * s;
      return p;
    };
    motion.law_wires.push_back(w);
  }
  return motion;
}

TEST(LawWire, PushesKeepEnergyAndMomentum) {
  const Motion motion = askew_in_a_ring();
  const MotionResult r = simulate(motion, fine(3.0, 1e-2), {});
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  EXPECT_GE(r.events.size(), 2u);
  EXPECT_GT(r.peak_force[0], 0.1);
  const double energy = r.energy.kinetic + r.energy.strain;
  EXPECT_NEAR(r.energy.dissipated, 0.0, 1e-12);
  EXPECT_NEAR(r.energy.integrator / energy, 0.0, 2e-6);
  EXPECT_LT(r.momentum_error.norm(), 1e-8);
  EXPECT_LT(r.angular_momentum_error.norm(), 1e-8);
}

TEST(LawWire, FrictionOfAPushIsLost) {
  Motion motion = askew_in_a_ring();
  rub(motion, 0.4, 0.3);
  const MotionResult r = simulate(motion, fine(3.0, 1e-2), {});
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  const double energy = r.energy.kinetic + r.energy.strain;
  EXPECT_GT(r.energy.dissipated, 1e-3 * energy);
  EXPECT_NEAR(r.energy.integrator / energy, 0.0, 1e-4);
  EXPECT_LT(r.momentum_error.norm(), 1e-8);
  EXPECT_LT(r.angular_momentum_error.norm(), 1e-8);
}

// A shaft that is pushed into a wire and slides off beyond its own end: the energy of the law is dissipated.
TEST(LawWire, ShaftThatSlidesOffLeavesItsEnergy) {
  Motion motion;
  motion.bodies = {block("visitor", 2.0, {0.02, 0.03, 0.01})};
  motion.bodies[0].start.position = {0.0, -0.01, 0.0};
  motion.bodies[0].start.velocity = {0.0, 0.2, 0.4};
  LawWire w;
  w.kind = LawWire::Kind::push;
  w.p_from = {-0.1, 0.0, 0.0};
  w.p_to = {0.1, 0.0, 0.0};
  w.shaft.carrier = body_of(0);
  w.shaft.half_length = 0.04;
  w.shaft.radius = 6e-3;
  w.push = [](const Eigen::Vector2d& place, double) {
    WirePush p;
    p.depth = place.y();
    if (p.depth <= 0.0) return p;
    p.energy = 250.0 * p.depth * p.depth;
    p.force = {0.0, 500.0 * p.depth};
    p.by_place << 0.0, 0.0, 0.0, 500.0;
    return p;
  };
  motion.law_wires.push_back(w);
  const MotionResult r = simulate(motion, fine(0.2, 1e-2), {});
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  EXPECT_GT(r.energy.dissipated, 1e-3);
  EXPECT_EQ(r.energy.strain, 0.0);
  EXPECT_NEAR(r.energy.integrator, 0.0, 1e-6);
}

// What is behind the wire when it comes within reach is missed; what was before it is held.
TEST(LawWire, ShaftBehindTheWireIsMissed) {
  WireAboutShaft wire(ring_wire(0.1, 2.0, 0.2));
  const VectorXd far = wire.at({0.0, 0.0, 0.5}), before = wire.at(Vector3d::Zero()),
                 behind = wire.at({0.12 * std::cos(1.0), 0.12 * std::sin(1.0), 0.0});
  for (const VectorXd& y : {far, behind}) wire.part.update_candidates(y);
  EXPECT_TRUE(wire.part.wrenches(behind).empty());
  for (const VectorXd& y : {far, before, behind}) wire.part.update_candidates(y);
  EXPECT_FALSE(wire.part.wrenches(behind).empty());
}

}  // namespace
}  // namespace snare::coupling
