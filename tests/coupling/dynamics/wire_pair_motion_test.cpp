// Wires that meet each other in motion: balances, statics, friction, several at a time.

#include "coupling/contact/revolved_solids.hpp"
#include "tests/support/crossed_wires.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/same_bits.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/math/tools/roots.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace snare::coupling {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using test::crossed_wires;
using test::wire_between;
using End = wire::SpatialEnd::Kind;

using std::numbers::pi;
constexpr double degree = pi / 180.0;

void free_ends(MotionWire& w) {
  w.rod.properties.left.kind = w.rod.properties.right.kind = End::free;
}

/// The upper wire of a crossing flies down on the lower one and along it, and turns.
Motion thrown(double angle, const MotionFriction& friction) {
  Motion motion = crossed_wires(angle, 2e-4, 16);
  motion.wire_pairs[0].friction = friction;
  MotionWire& upper = motion.wires[0];
  free_ends(upper);
  upper.velocities = Matrix3Xd::Zero(3, 17);
  const Vector3d spin(0.5, 1.0, 2.0);
  for (int i = 0; i <= 16; ++i)
    upper.velocities.col(i) = Vector3d(0.05, -0.4, 0.1) + spin.cross(upper.positions.col(i));
  return motion;
}

// Without damping and friction, through contact and lift-off, on a clamped wire and on a free one.
TEST(WirePairBalance, EnergyOfAConservativeImpactStays) {
  for (const bool free : {false, true}) {
    for (const double angle : {70.0, 12.0}) {
      SCOPED_TRACE(testing::Message() << (free ? "free, " : "clamped, ") << angle);
      Motion motion = thrown(angle * degree, {});
      for (MotionWire& w : motion.wires) w.rod.damping = {};
      motion.wire_pairs[0].foundation = {1e8, 0.0};
      if (free) free_ends(motion.wires[1]);
      MotionOptions options = test::fine_tolerances();
      // BDF takes energy from waves that it does not follow.
      options.relative_tolerance = 1e-9;
      options.position_tolerance = 1e-11;
      options.velocity_tolerance = 1e-7;
      options.max_order = 3;
      options.duration = 0.01;
      const MotionResult r = simulate(motion, options);
      ASSERT_TRUE(r.report.usable()) << r.report.message;
      ASSERT_GE(r.events.size(), 2u);
      const double energy = r.last.sums.start_energy;
      EXPECT_LT(std::abs(r.energy.integrator), 2e-4 * energy);
      EXPECT_LT(std::abs(r.energy.dissipated), 1e-9 * energy);
      const double impulse = r.impulse[0].norm();
      EXPECT_GT(impulse, 1e-5);
      EXPECT_LT(r.momentum_error.norm(), (free ? 1e-10 : 1e-6) * impulse);
      EXPECT_LT(r.angular_momentum_error.norm(), 1e-6 * impulse * 0.1);
    }
  }
}

// With friction, damping and weight.
TEST(WirePairBalance, MomentumAndAngularMomentumWithFriction) {
  for (const double angle : {70.0, 12.0}) {
    SCOPED_TRACE(angle);
    Motion motion = thrown(angle * degree, {0.4, 0.3, 0.01, 1.0});
    motion.gravity = {0.3, -5.0, 0.2};
    MotionOptions options = test::fine_tolerances();
    options.duration = 0.02;
    const MotionResult r = simulate(motion, options);
    ASSERT_TRUE(r.report.usable()) << r.report.message;
    const double impulse = r.impulse[0].norm();
    EXPECT_GT(impulse, 1e-5);
    EXPECT_GT(r.energy.dissipated, 0.0);
    EXPECT_LT(r.momentum_error.norm(), 1e-7 * impulse);
    EXPECT_LT(r.angular_momentum_error.norm(), 1e-6 * impulse * 0.1);
    EXPECT_LT(std::abs(r.energy.integrator), 2e-3 * r.last.sums.start_energy);
  }
}

// Within the first element, where part of the force falls on the vertex that the clamp holds.
TEST(WirePairBalance, WhatIsPressedOnAMountIsItsReaction) {
  Motion motion = thrown(90.0 * degree, {0.4, 0.3, 0.01, 1.0});
  motion.wires[0].positions.row(2).array() -= 0.096;
  MotionOptions options = test::fine_tolerances();
  // What Newton's method leaves, times the stiffness of the contact, is missing from the clamp's force.
  options.newton_share = 1e-6;
  options.velocity_tolerance = 1e-5;
  options.position_tolerance = 1e-9;
  options.duration = 0.005;
  const MotionResult r = simulate(motion, options);
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  const double impulse = r.impulse[0].norm();
  EXPECT_GT(impulse, 1e-5);
  EXPECT_LT(r.momentum_error.norm(), 1e-6 * impulse);
  EXPECT_LT(r.angular_momentum_error.norm(), 1e-6 * impulse * 0.1);
}

/// Deflection [m] of a clamped wire of bending stiffness EI under tension at its middle, by the force there,
/// with the tension that its way round adds: w' = F/(2T) (1 - cosh(k (L/4 - x))/cosh(k L/4)), k^2 = T/EI.
double taut_deflection(double force, double span, double tension_at_rest, double stretch, double bending) {
  double tension = tension_at_rest;
  double deflection = 0.0;
  for (int k = 0; k < 50; ++k) {
    const double wave = std::sqrt(tension / bending);
    constexpr int steps = 2000;
    double longer = 0.0;
    deflection = 0.0;
    for (int i = 0; i < steps; ++i) {
      const double x = 0.5 * span * (i + 0.5) / steps;
      const double slope = force / (2.0 * tension) *
                           (1.0 - std::cosh(wave * (0.25 * span - x)) / std::cosh(0.25 * span * wave));
      deflection += slope * 0.5 * span / steps;
      longer += slope * slope * 0.5 * span / steps;  // both halves of 1/2 int w'^2
    }
    tension = tension_at_rest + stretch * longer / span;
  }
  return deflection;
}

// Two taut wires across each other, nearer than their thickness by 2 mm, come to rest with the force that
// bends both.
TEST(WirePairStatics, TautWiresPressAsTensionedBeamsDo) {
  constexpr double overlap = 2e-3, strain = 0.02;
  std::vector<double> errors;
  for (const int elements : {20, 40, 80}) {
    Motion motion = crossed_wires(90.0 * degree, -overlap, elements, strain);
    for (std::size_t w = 0; w < 2; ++w) {
      MotionWire& wire = motion.wires[w];
      // Crossing at the middles; drawn apart at the start.
      const Vector3d middle(0.0, w == 0 ? 0.0 : -2e-3 + overlap, 0.0);
      const Vector3d along = w == 0 ? Vector3d::UnitX() : Vector3d::UnitZ();
      const auto name = wire.name;
      wire = wire_between(name, middle - 0.1 * along, middle + 0.1 * along, elements, strain);
      for (int i = 0; i <= elements; ++i) {
        const double x = static_cast<double>(i) / elements;
        wire.positions(1, i) += (w == 0 ? 1.0 : -1.0) * (0.55 * overlap) * std::pow(std::sin(pi * x), 2);
      }
      wire.rod.damping.mass_rate = 400.0;
    }
    MotionOptions options = test::fine_tolerances();
    options.duration = 0.15;
    options.output_interval = 0.05;
    MotionSample last;
    const MotionResult r = simulate(motion, options, [&](const MotionSample& s) {
      last = s;
      return false;
    });
    ASSERT_TRUE(r.report.usable()) << r.report.message;
    EXPECT_LT(last.energy.kinetic, 1e-12);
    // Both bend alike, by half the overlap less what they sink in.
    const auto deflection = [&](double force) {
      return taut_deflection(force, 0.2, 1e3 * strain, 1e3, 1e-3);
    };
    const double wanted = 0.5 * (overlap + last.contacts[0].gap);
    double low = 0.01, high = 2.0;
    for (int k = 0; k < 60; ++k) (deflection(0.5 * (low + high)) < wanted ? low : high) = 0.5 * (low + high);
    errors.push_back(last.contacts[0].normal_force / low - 1.0);
    // Normals turn by up to the half length of the contact over the thickness, 0.02.
    EXPECT_NEAR(last.contacts[0].normal_force, last.contacts[0].force.y(), 2e-4 * low);
    EXPECT_NEAR(last.mount_forces[0].y() + last.mount_forces[1].y(), -last.contacts[0].force.y(), 1e-4 * low);
  }
  // Second order: an eighth of the wave length of the bend, sqrt(EI/T) = 7 mm, is met by 80 elements of 2.5
  // mm.
  EXPECT_LT(std::abs(errors[2]), 2e-3);
  EXPECT_LT(std::abs(errors[2]), 0.4 * std::abs(errors[1]))
      << errors[0] << ' ' << errors[1] << ' ' << errors[2];
  EXPECT_LT(std::abs(errors[1]), 0.01);
}

/// A free wire lies across two taut rails and slides along itself in tilted weight. Returns the ratio of
/// tangential to normal force on both rails together at the end, and the way it went [m].
struct Ride {
  MotionResult result;
  double ratio = 0.0, way = 0.0, speed = 0.0;
  bool sticks = false;
};
Ride ride(double tilt, double coefficient) {
  Motion motion;
  motion.wires.push_back(wire_between("rider", {-0.05, 0.0, 0.0}, {0.05, 0.0, 0.0}, 20));
  free_ends(motion.wires[0]);
  for (const double x : {-0.02, 0.03}) {
    motion.wires.push_back(
        wire_between(x < 0.0 ? "left" : "right", {x, -2e-3, -0.1}, {x, -2e-3, 0.1}, 20, 0.02));
    motion.wires.back().rod.damping.mass_rate = 300.0;
    WirePair pair;
    pair.wires = {0, static_cast<int>(motion.wires.size()) - 1};
    pair.radii = {1e-3, 1e-3};
    pair.friction = {coefficient, coefficient, 0.0, 0.0};
    motion.wire_pairs.push_back(pair);
  }
  motion.gravity = 9.81 * Vector3d(std::sin(tilt), -std::cos(tilt), 0.0);
  MotionOptions options = test::fine_tolerances();
  options.duration = 0.06;
  MotionSample last;
  Ride ride;
  double tangential = 0.0, normal = 0.0;
  ride.result = simulate(motion, options, [&](const MotionSample& s) {
    last = s;
    if (s.time > 0.03) {
      tangential += s.contacts[0].force.x() + s.contacts[1].force.x();
      normal += s.contacts[0].normal_force + s.contacts[1].normal_force;
    }
    return false;
  });
  ride.ratio = -tangential / normal;
  ride.way = last.wires[0].row(0).mean();
  ride.speed = last.momentum.x();
  ride.sticks = last.contacts[0].sticking && last.contacts[1].sticking;
  return ride;
}

// Under a friction of 0.3 it rests at a tilt of 0.2, and slides at one of 0.5 with g (sin - 0.3 cos).
TEST(WirePairFriction, ARiderSticksOrSlidesAsItsTiltSays) {
  const Ride rests = ride(std::atan(0.2), 0.3);
  ASSERT_TRUE(rests.result.report.usable()) << rests.result.report.message;
  EXPECT_TRUE(rests.sticks);
  EXPECT_NEAR(rests.ratio, 0.2, 5e-3);   // the mean of some swings on the rails
  EXPECT_LT(std::abs(rests.way), 3e-5);  // the rails give by some 10 um
  const Ride slides = ride(std::atan(0.5), 0.3);
  ASSERT_TRUE(slides.result.report.usable()) << slides.result.report.message;
  EXPECT_FALSE(slides.sticks);
  EXPECT_NEAR(slides.ratio, 0.3, 1e-3);  // the rider bends by 5e-4 rad
  const double acceleration = 9.81 * (0.5 - 0.3) * std::cos(std::atan(0.5));
  EXPECT_NEAR(slides.way, 0.5 * acceleration * 0.06 * 0.06, 0.03 * slides.way);
}

TEST(WirePairTouch, NoWireIsPassedByHoweverFast) {
  for (const double angle : {90.0, 20.0}) {
    for (const double speed : {0.05, 5.0, 100.0}) {
      Motion motion = crossed_wires(angle * degree, 0.02, 12);
      free_ends(motion.wires[0]);
      motion.wires[0].velocities = Vector3d(0.0, -speed, 0.0).replicate(1, 13);
      MotionOptions options;
      options.duration = 0.0202 / speed;
      options.output_interval = options.duration;
      const MotionResult r = simulate(motion, options);
      ASSERT_GE(r.events.size(), 1u) << angle << ' ' << speed << ' ' << r.report.message;
      EXPECT_NEAR(r.events[0].time, 0.02 / speed, 1e-7 / speed);
      EXPECT_NEAR(r.events[0].approach_speed, speed, 1e-6 * speed);
      EXPECT_EQ(r.events[0].contact, 0);
    }
  }
}

TEST(WirePairTouch, AnOverlapAtTheStartIsRefused) {
  const Motion motion = crossed_wires(1.0, -1e-4, 8);
  const std::string said = test::refusal([&] { return simulate(motion, {}); });
  EXPECT_THAT(said, testing::HasSubstr("pair.gap = -"));
  EXPECT_THAT(said, testing::HasSubstr("must be >= 0 m at the start"));
  Motion wrong = crossed_wires(1.0, 1e-4, 8);
  wrong.wire_pairs[0].wires = {1, 1};
  wrong.wire_pairs[0].radii = {0.0, 1e-3};
  wrong.wire_pairs[0].foundation.damping = -1.0;
  EXPECT_THAT(test::refusal([&] { return simulate(wrong, {}); }),
              testing::AllOf(testing::HasSubstr("pair.wires = 1, must be two different wires"),
                             testing::HasSubstr("pair.radii = 0, must be > 0"),
                             testing::HasSubstr("pair.foundation.damping = -1, must be >= 0")));
}

TEST(WirePairState, GoingOnFromACheckpointGivesTheSameBits) {
  const Motion motion = thrown(60.0 * degree, {0.4, 0.3, 0.01, 1.0});
  MotionOptions options;
  options.duration = 0.01;
  options.checkpoint_interval = 0.003;
  EXPECT_EQ(test::expect_same_bits_from_checkpoints(motion, options).size(), 3u);
}

/// The three slack wires of a snare about a free shaft: each from a fixed ring to a turning one below it,
/// along the outside at the start. The turning ring carries its ends round by `turn` [rad] in `time` [s],
/// until the wires lie across the middle, each over the next one and under the one before.
Motion snare_about_a_shaft(double turn, double time, int elements) {
  constexpr double ring = 0.08, apart = 8e-3, radius = 1e-3, shaft = 0.008, open = 100.0 * degree;
  Motion motion;
  const auto on_ring = [](double a, double z) { return Vector3d(ring * std::cos(a), ring * std::sin(a), z); };
  for (int w = 0; w < 3; ++w) {
    const double begin = 120.0 * degree * w;
    const Vector3d from = on_ring(begin, 0.5 * apart), to = on_ring(begin + open, -0.5 * apart);
    MotionWire wire =
        wire_between(std::string("wire ") + "abc"[w], from, to, elements, 0.0, End::twisting_pin);
    wire.rod.length = 2.0 * ring * std::sin(84.0 * degree);
    wire.rod.damping.mass_rate = 0.0;
    // An arc of a circle of that length, by its half angle.
    const double chord = (to - from).norm();
    double low = 1e-3, high = pi - 1e-3;
    for (int k = 0; k < 80; ++k) {
      const double half = 0.5 * (low + high);
      (wire.rod.length * std::sin(half) / half > chord ? low : high) = half;
    }
    const double bend = 0.5 * wire.rod.length / low;
    const Vector3d along = (to - from).normalized();
    const Vector3d outward = on_ring(begin + 0.5 * open, 0.0).normalized();
    for (int i = 0; i <= elements; ++i) {
      const double phi = low * (2.0 * i / elements - 1.0);
      wire.positions.col(i) =
          0.5 * (from + to) + bend * std::sin(phi) * along + bend * (std::cos(phi) - std::cos(low)) * outward;
    }
    wire.positions.col(0) = from;
    wire.positions.col(elements) = to;
    motion.wires.push_back(wire);
    MotionBody mover;
    mover.name = std::string("mover ") + "abc"[w];
    mover.driven = true;
    mover.start.position = to;
    const double first = begin + open;
    const auto turned = [turn, time](double t) {  // from rest to rest
      const double x = std::min(t / time, 1.0);
      return turn * (x - std::sin(2.0 * pi * x) / (2.0 * pi));
    };
    const auto rate = [turn, time](double t) {
      return t < time ? turn / time * (1.0 - std::cos(2.0 * pi * t / time)) : 0.0;
    };
    const auto rise = [turn, time](double t) {
      return t < time ? turn / (time * time) * 2.0 * pi * std::sin(2.0 * pi * t / time) : 0.0;
    };
    mover.course_velocity = [=](double t) {
      const double a = first + turned(t);
      return Vector3d(ring * rate(t) * Vector3d(-std::sin(a), std::cos(a), 0.0));
    };
    mover.course_acceleration = [=](double t) {
      const double a = first + turned(t);
      return Vector3d(ring * (rise(t) * Vector3d(-std::sin(a), std::cos(a), 0.0) -
                              rate(t) * rate(t) * Vector3d(std::cos(a), std::sin(a), 0.0)));
    };
    motion.bodies.push_back(mover);
    MotionMount mount;
    mount.name = std::string("turning side of ") + "abc"[w];
    mount.wire = w;
    mount.end = wire::End::right;
    mount.carrier = {MotionCarrier::Kind::body, w, 0};
    motion.mounts.push_back(mount);
  }
  MotionBody shaft_body;
  shaft_body.name = "shaft";
  shaft_body.properties.mass = 0.1;
  shaft_body.properties.inertia = 1e-4 * Eigen::Matrix3d::Identity();
  shaft_body.start.position = {0.004, 0.002, 0.0};
  motion.bodies.push_back(shaft_body);
  for (int w = 0; w < 3; ++w) {
    MotionContact contact;
    contact.name = std::string("shaft on ") + "abc"[w];
    contact.wire = w;
    contact.body = 3;
    contact.shape = std::make_shared<EndlessCylinder>(shaft);
    contact.wire_radius = radius;
    contact.friction = {0.2, 0.2, 0.01, 1.0};
    motion.contacts.push_back(contact);
    WirePair pair;
    pair.wires = {w, (w + 1) % 3};
    pair.name = std::string("wires ") + "abc"[w] + ' ' + "abc"[(w + 1) % 3];
    pair.radii = {radius, radius};
    pair.friction = {0.2, 0.2, 0.01, 1.0};
    motion.wire_pairs.push_back(pair);
  }
  return motion;
}

TEST(WirePairSnare, ThreeWiresCloseOnEachOtherAndOnAShaft) {
  const Motion motion = snare_about_a_shaft(70.0 * degree, 0.4, 24);
  MotionOptions options;
  options.duration = 0.5;
  options.output_interval = 0.005;
  double most_energy = 0.0;
  const MotionResult r = simulate(motion, options, [&](const MotionSample& s) {
    most_energy = std::max(most_energy, s.energy.kinetic + s.energy.strain + s.energy.work);
    return false;
  });
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  for (std::size_t k = 0; k < 6; ++k) EXPECT_GT(r.peak_force[k], 0.01) << k;
  EXPECT_LT(r.largest_penetration, 1e-4);
  const double impulse = r.impulse[0].norm() + r.impulse[1].norm() + r.impulse[2].norm();
  EXPECT_LT(r.momentum_error.norm(), 1e-3 * impulse);
  EXPECT_LT(std::abs(r.energy.integrator), 5e-3 * most_energy);
}

}  // namespace
}  // namespace snare::coupling
