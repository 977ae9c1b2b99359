#include "coupling/dynamics/contact/body_contact_part.hpp"

#include "coupling/contact/revolved_solids.hpp"
#include "coupling/dynamics/run/simulate.hpp"
#include "tests/support/dae_jacobian.hpp"
#include "tests/support/motion_bodies.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/same_bits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace snare::coupling {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using test::block;
using test::body_of;

MotionOptions fine(double duration) {
  MotionOptions o;
  o.duration = duration;
  o.output_interval = 1e-4;
  o.relative_tolerance = 1e-8;
  o.body_position_tolerance = o.angle_tolerance = 1e-11;
  o.body_velocity_tolerance = o.spin_tolerance = 1e-8;
  return o;
}

/// A ball of 2 kg that flies down to a plane of the world at 0.1 m/s, 1 mm above it.
Motion ball_on_plane(ContactLaw law) {
  Motion motion;
  motion.bodies = {block("ball", 2.0, {0.1, 0.1, 0.1})};
  motion.bodies[0].start.position = {0.0, 0.0, 0.051};
  motion.bodies[0].start.velocity = {0.0, 0.0, -0.1};
  BodyContact contact;
  contact.shape = std::make_shared<HalfSpace>(1.0);
  contact.other = body_of(0);
  contact.X_WP.p = motion.bodies[0].start.position;
  contact.points = {Vector3d::Zero()};
  contact.radius = 0.05;
  contact.law = std::move(law);
  motion.body_contacts = {contact};
  return motion;
}

struct Bounce {
  double speed = 0.0, touch = 0.0, lift_off = 0.0;
  MotionResult result;
};

Bounce bounce(const Motion& motion, double duration) {
  Bounce b;
  double last_force = 0.0;
  b.result = simulate(motion, fine(duration), [&](const MotionSample& s) {
    b.speed = s.bodies[0].velocity.z();
    if (s.contacts[0].normal_force > 0.0) last_force = s.time;
    return false;
  });
  b.lift_off = last_force;
  if (!b.result.events.empty()) b.touch = b.result.events.front().time;
  return b;
}

// Linear spring and dashpot that do not pull: x = (v/w_d) e^(-s t) sin w_d t up to k x + c x' = 0,
// tan(w_d t) = -2 s w_d/(w^2 - 2 s^2).
TEST(BodyContact, LinearLawRestitution) {
  constexpr double m = 2.0, k = 2e4, c = 60.0, v = 0.1;
  const Bounce b = bounce(ball_on_plane(spring_dashpot(k, c)), 0.06);
  ASSERT_TRUE(b.result.report.usable()) << b.result.report.message;
  const double w = std::sqrt(k / m), s = c / (2.0 * m), wd = std::sqrt(w * w - s * s);
  const double t = (M_PI - std::atan2(2.0 * s * wd, w * w - 2.0 * s * s)) / wd;
  const double speed = -v * std::exp(-s * t) * (std::cos(wd * t) - s / wd * std::sin(wd * t));
  EXPECT_NEAR(b.speed / speed, 1.0, 1e-3);
  EXPECT_NEAR(b.touch, 0.01, 1e-6);
  EXPECT_NEAR(b.lift_off - b.touch, t, 1e-3 * t + 2e-4);  // read to the output's interval
  EXPECT_NEAR(b.result.impulse[0].norm(), m * (v + speed), 1e-3 * m * v);
  EXPECT_NEAR(b.result.energy.dissipated, 0.5 * m * (v * v - speed * speed), 1e-3 * 0.5 * m * v * v);
  EXPECT_LT(b.result.momentum_error.norm(), 1e-8);
}

// Hunt and Crossley: m v dv = -(k + c v) x^p dx, so that v/c - k/c^2 ln(k + c v) is the same before and
// after.
TEST(BodyContact, HuntCrossleyRestitution) {
  constexpr double k = 5e6, p = 1.5, c = 4e7, v = 0.1;
  const Bounce b = bounce(ball_on_plane(power_law(k, p, c, 1.0)), 0.06);
  ASSERT_TRUE(b.result.report.usable()) << b.result.report.message;
  const auto invariant = [&](double u) { return u / c - k / (c * c) * std::log(k + c * u); };
  double low = 0.0, high = std::min(v, k / c);
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (invariant(-middle) > invariant(v) ? high : low) = middle;
  }
  EXPECT_NEAR(b.speed / low, 1.0, 1e-3) << low;
}

// A ball that slides into a plane is slowed by Coulomb's force and begins to roll: mu N in all, as long as it
// slides.
TEST(BodyContact, FrictionTakesMuTimesTheImpulse) {
  Motion motion = ball_on_plane(spring_dashpot(2e4, 0.0));
  motion.bodies[0].start.velocity.x() = 1.0;
  MotionFriction& f = motion.body_contacts[0].friction;
  f.law = ContactFriction::smooth;
  f.static_coefficient = f.dynamic_coefficient = 0.2;
  f.static_speed = 1e-3;
  f.dynamic_speed = 1e-2;
  Vector3d velocity, spin;
  const MotionResult r = simulate(motion, fine(0.06), [&](const MotionSample& s) {
    velocity = s.bodies[0].velocity;
    spin = s.bodies[0].spin;
    return false;
  });
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  const double normal = 2.0 * 2.0 * 0.1;
  EXPECT_NEAR(velocity.x(), 1.0 - 0.2 * normal / 2.0, 1e-6);
  EXPECT_NEAR(spin.y(), 0.2 * normal * 0.05 / 0.1, 2e-3 * 0.04);  // the lever is shorter by the depth
  EXPECT_NEAR(r.energy.integrator, 0.0, 1e-6);
}

// What is pressed into the other at the start would be thrown out by the law.
TEST(BodyContact, ABallMayRestButNotBeginInside) {
  Motion motion = ball_on_plane(spring_dashpot(2e4, 0.0));
  const auto begun_at = [&](double depth) {
    motion.bodies[0].start.position.z() = 0.05 - depth;
    motion.body_contacts[0].X_WP.p = motion.bodies[0].start.position;
    return test::refusal([&] { return simulate(motion, fine(1e-4), {}); });
  };
  EXPECT_EQ(begun_at(0.004), "accepted");
  EXPECT_THAT(begun_at(0.006),
              testing::HasSubstr("contact.gap = -0.006 m, must be >= -0.005 m at the start"));
}

/// A block of 1 kg on four feet that carry it, on a plane of the world at the height of its centre, so that
/// friction does not tip it; the weight is tilted in place of the plane.
Motion block_on_ramp(double angle, double friction, ContactFriction law = ContactFriction::stick_slip) {
  Motion motion;
  motion.bodies = {block("block", 1.0, {2e-3, 2e-3, 2e-3})};
  motion.gravity = 9.81 * Vector3d(std::sin(angle), 0.0, -std::cos(angle));
  constexpr double stiffness = 2.5e4;  // of a foot [N/m]
  motion.bodies[0].start.position = {0.0, 0.0, motion.gravity.z() / (4.0 * stiffness)};
  BodyContact contact;
  contact.shape = std::make_shared<HalfSpace>(1.0);
  contact.other = body_of(0);
  contact.X_WP.p = motion.bodies[0].start.position;
  contact.points = {{0.05, 0.03, 0.0}, {-0.05, 0.03, 0.0}, {0.05, -0.03, 0.0}, {-0.05, -0.03, 0.0}};
  contact.law = spring_dashpot(stiffness, 25.0);
  contact.friction.static_coefficient = contact.friction.dynamic_coefficient = friction;
  contact.friction.law = law;
  motion.body_contacts = {contact};
  return motion;
}

struct OnRamp {
  double place = 0.0, speed = 0.0, late_speed = 0.0;  ///< along the ramp at the end; largest of the last half
  bool sticks = false, falls = false;                 ///< whether the dissipated energy fell
  MotionResult result;
};

OnRamp on_ramp(const Motion& motion, double duration) {
  OnRamp r;
  MotionOptions options;
  options.duration = duration;
  double lost = 0.0;
  r.result = simulate(motion, options, [&](const MotionSample& s) {
    r.place = s.bodies[0].position.x();
    r.speed = s.bodies[0].velocity.x();
    if (s.time > 0.5 * duration) r.late_speed = std::max(r.late_speed, std::abs(r.speed));
    r.sticks = s.contacts[0].sticking;
    r.falls = r.falls || s.energy.dissipated < lost - 1e-12;
    lost = s.energy.dissipated;
    return false;
  });
  EXPECT_TRUE(r.result.report.usable()) << r.result.report.message;
  return r;
}

// Below the limit, tan(angle) < mu, a block rests. Let go with straight bristles it swings on them; where
// tan(angle) > mu/2 it slides at first, with v^2 = g z_m (2 sin - mu cos) from the end z_m of the bristles
// on, for v^2/(2 g (mu cos - sin)). Beyond the limit it slides at g (sin - mu cos).
TEST(BodyContact, ABlockRestsOnARampOrSlidesByCoulombsLaw) {
  constexpr double degree = M_PI / 180.0, g = 9.81;
  for (const auto& [angle, friction] : {std::pair{10.0, 0.5}, {26.0, 0.5}, {10.0, 0.2}, {20.0, 0.4}}) {
    SCOPED_TRACE(angle);
    const Motion motion = block_on_ramp(angle * degree, friction);
    const OnRamp r = on_ramp(motion, 2.0);
    const double pull = g * std::sin(angle * degree), limit = g * friction * std::cos(angle * degree);
    const double give = motion.body_contacts[0].friction.bristle_displacement;
    const double way = std::max(0.0, give * (2.0 * pull - limit) / (2.0 * (limit - pull)));
    EXPECT_TRUE(r.sticks);
    EXPECT_GT(r.place, 0.0);
    EXPECT_LT(
        r.place,
        1.02 * (give + way));  // damping of the bristles shortens it; coordinates err by 1e-7 m and less
    // The swing decays as exp(-tau g mu/(2 z_m) t), 10/s at 0.2, from 1 mm/s: after a second it is below the
    // tolerance of velocities.
    EXPECT_LT(r.late_speed, 1e-6);
    EXPECT_FALSE(r.falls);
    ASSERT_FALSE(r.result.events.empty());
    EXPECT_EQ(r.result.events.front().kind, MotionEvent::Kind::touch);
    EXPECT_EQ(r.result.events.front().time, 0.0);
    // A step errs by 1e-8 m, against a weight of 10 N; five such, as errors of a swing that decays cancel.
    EXPECT_NEAR(r.result.energy.integrator, 0.0, 5e-7);
  }
  for (const auto& [angle, friction] : {std::pair{27.0, 0.5}, {40.0, 0.5}, {10.0, 0.1}, {30.0, 0.0}}) {
    SCOPED_TRACE(angle);
    constexpr double time = 0.4;
    const OnRamp r = on_ramp(block_on_ramp(angle * degree, friction), time);
    const double acceleration = g * (std::sin(angle * degree) - friction * std::cos(angle * degree));
    EXPECT_FALSE(r.sticks);
    // The bristles end within 1 ms, in which they hold back less than friction does: 1e-3 m/s at most.
    EXPECT_NEAR(r.speed, acceleration * time, 3e-3);
    EXPECT_FALSE(r.falls);
  }
}

// A block that is thrown along a level plane stops after v^2/(2 mu g) and says when it sticks; by the smooth
// law it would creep on.
TEST(BodyContact, AThrownBlockSlidesAndSticks) {
  Motion motion = block_on_ramp(0.0, 0.4);
  motion.bodies[0].start.velocity.x() = 0.3;
  const OnRamp r = on_ramp(motion, 0.2);
  const double path = 0.3 * 0.3 / (2.0 * 0.4 * 9.81);
  EXPECT_NEAR(r.place, path, 1e-3 * path);
  EXPECT_NEAR(r.result.energy.dissipated, 0.5 * 0.3 * 0.3, 1e-3 * 0.5 * 0.3 * 0.3);
  const auto stick = std::ranges::find(r.result.events, MotionEvent::Kind::stick, &MotionEvent::kind);
  ASSERT_NE(stick, r.result.events.end());
  EXPECT_NEAR(stick->time, 0.3 / (0.4 * 9.81), 1e-3);
}

// A checkpoint keeps the bristles and what touches.
TEST(BodyContact, ABlockThatRestsGoesOnFromACheckpoint) {
  const Motion motion = block_on_ramp(0.17, 0.5);
  MotionOptions options;
  options.duration = 0.05;
  options.checkpoint_interval = 0.02;
  EXPECT_EQ(test::expect_same_bits_from_checkpoints(motion, options).size(), 2U);
}

TEST(BodyContact, JacobianMatchesDifferences) {
  for (const ContactFriction law : {ContactFriction::smooth, ContactFriction::stick_slip}) {
    const MotionOptions options;
    BodyPart a(block("a", 3.0, {0.3, 0.4, 0.5}), Vector3d::Zero(), options);
    BodyPart b(block("b", 2.0, {0.2, 0.3, 0.4}), Vector3d::Zero(), options);
    BodyContact contact;
    contact.shape = std::make_shared<Capsule>(0.2, 0.5);
    contact.points = {{0.1, 0.05, -0.02}, {-0.05, 0.1, 0.1}, {0.4, 0.5, 0.6}};
    contact.radius = 0.1;
    contact.law = power_law(50.0, 1.5, 20.0, 1.0);
    contact.friction.law = law;
    contact.friction.static_coefficient = 0.5;
    contact.friction.dynamic_coefficient = 0.3;
    contact.friction.static_speed = 0.1;
    contact.friction.dynamic_speed = 3.0;
    // Bristles as soft as the bodies are large, so that no row drowns the others.
    contact.friction.bristle_displacement = 0.3;
    contact.friction.bristle_time = 0.2;
    BodyContactPart part(contact, {a, {}}, {b, {}});
    numerics::DaeSystem system({&a, &b, &part});
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    int acting = 0;
    for (int trial = 0; trial < 8; ++trial) {
      VectorXd y(system.size()), rate(system.size());
      for (double& v : y) v = unit(random);
      for (double& v : rate) v = unit(random);
      for (const BodyPart* body : {&a, &b}) {
        y.segment<3>(body->position()) *= 0.1;
        y.segment<4>(body->quaternion()).normalize();
      }
      const Eigen::MatrixXd directions = test::along_unit_quaternions(y, {a.quaternion(), b.quaternion()});
      acting += part.wrenches(y).empty() ? 0 : 1;
      const test::DerivativeError error = test::compare_dae_jacobian(system, y, rate, directions, 1e-5);
      EXPECT_LT(error.relative, 2e-6) << trial << ": " << error.worst;
    }
    EXPECT_GE(acting, 6);
  }
}

// A thruster in a body's axes turns with it: a body that spins at w gets F/(m w) (sin w t, 1 - cos w t).
// Pulses add up.
TEST(FrameLoad, ThrusterTurnsWithItsBody) {
  Motion motion;
  motion.bodies = {block("visitor", 2.0, {0.3, 0.3, 0.3})};
  motion.bodies[0].start.spin = {0.0, 0.0, 2.0};
  FrameLoad load;
  load.carrier = body_of(0);
  load.times = {0.0, 0.5, 0.5, 1.0, 1.0, 1.5};
  load.forces = Eigen::Matrix3Xd::Zero(3, 6);
  load.moments = Eigen::Matrix3Xd::Zero(3, 6);
  for (const Eigen::Index k : {0, 1, 4, 5}) load.forces.col(k) = Vector3d(3.0, 0.0, 0.0);
  motion.loads = {load};
  Vector3d velocity;
  const MotionResult r = simulate(motion, fine(2.0), [&](const MotionSample& s) {
    velocity = s.bodies[0].velocity;
    return false;
  });
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  const auto of = [](double from, double to) -> Vector3d {
    return 3.0 / 2.0 / 2.0 *
           Vector3d(std::sin(2.0 * to) - std::sin(2.0 * from), std::cos(2.0 * from) - std::cos(2.0 * to),
                    0.0);
  };
  EXPECT_LT((velocity - of(0.0, 0.5) - of(1.0, 1.5)).norm(), 1e-6);
  EXPECT_NEAR(r.energy.integrator, 0.0, 1e-6);
  EXPECT_LT(r.momentum_error.norm(), 1e-7);
}

// A half sine has 2/pi of its peak times its time; the way at its end is half that of the whole impulse from
// its beginning.
TEST(FrameLoad, HalfSinesHaveTheirArea) {
  Motion motion;
  motion.bodies = {block("visitor", 2.0, {0.3, 0.3, 0.3})};
  FrameLoad load;
  load.carrier = body_of(0);
  load.in_frame = false;
  load.half_sines = true;
  load.times = {0.1, 0.4, 0.6, 0.9};
  load.forces = load.moments = Eigen::Matrix3Xd::Zero(3, 4);
  load.forces.col(0) = load.forces.col(2) = Vector3d(4.0, 0.0, 0.0);
  motion.loads = {load};
  std::vector<MotionSample> samples;
  MotionOptions options = fine(1.0);
  options.output_interval = 0.1;
  const MotionResult r = simulate(motion, options, [&](const MotionSample& s) {
    samples.push_back(s);
    return false;
  });
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  const double velocity = 2.0 / std::acos(-1.0) * 4.0 * 0.3 / 2.0;
  // Some ten steps a pulse, each to 1e-8 of the velocity.
  EXPECT_NEAR(samples[5].bodies[0].velocity.x(), velocity, 1e-6);
  EXPECT_NEAR(samples[4].bodies[0].position.x(), 0.5 * velocity * 0.3, 1e-6);
  EXPECT_NEAR(samples[10].bodies[0].velocity.x(), 2.0 * velocity, 1e-6);
  EXPECT_LT(r.momentum_error.norm(), 1e-9);
}

// Times that differ by round-off alone, as of two loads of which one counts 0.1 + 0.2, do not stop the run.
TEST(FrameLoad, TimesMayDifferByRoundOff) {
  Motion motion;
  motion.bodies = {block("visitor", 2.0, {0.3, 0.3, 0.3})};
  FrameLoad load;
  load.carrier = body_of(0);
  load.in_frame = false;
  load.forces = load.moments = Eigen::Matrix3Xd::Zero(3, 2);
  load.forces.row(0).setConstant(4.0);
  load.times = {0.1, 0.3};
  motion.loads.push_back(load);
  load.times = {0.1 + 0.2, 0.5};
  motion.loads.push_back(load);
  Vector3d velocity;
  const MotionResult r = simulate(motion, fine(0.6), [&](const MotionSample& s) {
    velocity = s.bodies[0].velocity;
    return false;
  });
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  EXPECT_NEAR(velocity.x(), 0.4 * 4.0 / 2.0, 1e-9);
}

}  // namespace
}  // namespace snare::coupling
