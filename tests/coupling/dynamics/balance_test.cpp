// Balances of energy, momentum and angular momentum along a motion, and going on from a state.

#include "base/errors.hpp"
#include "coupling/dynamics/model/start.hpp"
#include "coupling/dynamics/run/simulate.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/same_bits.hpp"
#include "tests/support/soft_wire.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <thread>
#include <vector>

namespace snare::coupling {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr double length = 0.2;

wire::RodInMotion soft_rod(wire::SpatialEnd::Kind left, wire::SpatialEnd::Kind right) {
  wire::RodInMotion rod = test::soft_wire(16);
  rod.properties.left.kind = left;
  rod.properties.right.kind = right;
  return rod;
}

/// A ball on a body of 50 g that comes obliquely from below, beside its centre of mass and out of the plane.
Motion oblique_impact(const wire::RodInMotion& rod) {
  Motion motion;
  motion.wires.push_back({"wire", rod, straight_wire(rod, Vector3d::Zero(), {length, 0.0, 0.0}), {}});
  MotionBody body;
  body.properties.mass = 0.05;
  body.properties.inertia = Vector3d(2e-5, 3e-5, 4e-5).asDiagonal();
  body.start.position = {0.065, -0.0125, 0.004};
  body.start.velocity = {0.1, 0.3, 0.02};
  motion.bodies.push_back(body);
  MotionContact contact;
  contact.shape = std::make_shared<Ball>(0.01);
  contact.X_BS.p = {0.015, 0.0, -0.004};
  contact.wire_radius = 0.001;
  contact.friction = {0.3, 0.1, 0.01, 1.0};
  motion.contacts.push_back(contact);
  return motion;
}

using End = wire::SpatialEnd::Kind;
class MotionReactions : public testing::TestWithParam<std::pair<End, End>> {};

// With friction, weight, damping in the wire and against the world, drag, constant forces.
TEST_P(MotionReactions, BalanceMomentumAndAngularMomentum) {
  wire::RodInMotion rod = soft_rod(GetParam().first, GetParam().second);
  rod.damping.mass_rate = 5.0;
  Motion motion = oblique_impact(rod);
  motion.gravity = {0.3, -0.5, 0.2};
  motion.bodies[0].force = {0.01, 0.0, -0.02};
  motion.bodies[0].linear_drag = 0.01;
  motion.bodies[0].angular_drag = 1e-5;
  motion.bodies[0].start.spin = {1.0, -2.0, 3.0};
  MotionOptions options = test::fine_tolerances();
  options.duration = 0.08;
  const MotionResult result = simulate(motion, options);
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  ASSERT_FALSE(result.events.empty());
  const double impulse = result.impulse[0].norm();
  EXPECT_GT(impulse, 1e-3);
  EXPECT_LT(result.momentum_error.norm(), 1e-6 * impulse);
  EXPECT_LT(result.angular_momentum_error.norm(), 1e-6 * impulse * length);
}
INSTANTIATE_TEST_SUITE_P(Mounts, MotionReactions,
                         testing::Values(std::pair{End::clamp, End::clamp}, std::pair{End::clamp, End::pin},
                                         std::pair{End::twisting_pin, End::clamp},
                                         std::pair{End::pin, End::pin}, std::pair{End::clamp, End::free}));

// A body that is moved as prescribed pushes the wire: its force comes from outside and works.
TEST(MotionBalance, ADrivenBodyIsAccountedFor) {
  Motion motion = oblique_impact(soft_rod(End::clamp, End::clamp));
  motion.bodies[0].driven = true;
  motion.contacts[0].friction = {};
  MotionOptions options = test::fine_tolerances();
  // what Newton's method leaves, times the stiffness of the contact, is missing from its force
  options.newton_share = 1e-8;
  options.duration = 0.03;
  const MotionResult result = simulate(motion, options);
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  const double impulse = result.impulse[0].norm();
  EXPECT_GT(result.energy.work, 1e-5);
  EXPECT_LT(result.momentum_error.norm(), 1e-6 * impulse);
  EXPECT_LT(result.angular_momentum_error.norm(), 1e-6 * impulse * length);
  EXPECT_LT(std::abs(result.energy.integrator), 1e-3 * result.energy.work);
}

// Bent, spinning about its chord and tumbling, with damping of the material: only the shape is damped.
TEST(MotionBalance, AFreeDampedWireKeepsItsAngularMomentum) {
  for (const double bending_time : {2e-4, 0.0}) {
    wire::RodInMotion rod = soft_rod(End::free, End::free);
    rod.damping.bending_time = bending_time;
    Motion motion;
    Matrix3Xd x(3, 17);
    Matrix3Xd v(3, 17);
    const Vector3d spin(30.0, 5.0, -8.0);
    for (int i = 0; i <= 16; ++i) {
      const double s = length * i / 16;
      x.col(i) = Vector3d(s, 0.02 * std::sin(M_PI * s / length), 0.01 * std::sin(2.0 * M_PI * s / length));
      v.col(i) = spin.cross(x.col(i) - Vector3d(0.1, 0.0, 0.0)) +
                 Vector3d(0.0, 0.2 * std::cos(M_PI * s / length), 0.0);
    }
    motion.wires.push_back({"wire", rod, x, v});
    MotionOptions options;
    options.relative_tolerance = 1e-10;
    options.position_tolerance = 1e-13;
    options.velocity_tolerance = 1e-10;
    options.twist_tolerance = 1e-12;
    options.max_order = 5;
    options.newton_share = 0.01;  // round-off bounds the rest
    options.duration = 0.02;
    options.output_interval = 0.002;
    Vector3d start;
    double worst = 0.0;
    const MotionResult result = simulate(motion, options, [&](const MotionSample& s) {
      if (s.time == 0.0) start = s.angular_momentum;
      worst = std::max(worst, (s.angular_momentum - start).norm() / start.norm());
      return false;
    });
    ASSERT_TRUE(result.report.usable()) << result.report.message;
    EXPECT_LT(worst, 1e-9) << "with a bending time of " << bending_time;
    EXPECT_LT(result.momentum_error.norm(), 1e-9 * 0.01 * length);
    // What the wire lost is what its damping took.
    const double scale = result.last.sums.start_energy;
    EXPECT_GT(result.energy.dissipated, 1e-3 * scale);
    EXPECT_LT(std::abs(result.energy.integrator), 1e-6 * scale);
  }
}

// Without damping and friction: kinetic and strain energy of wire and body, through contact and lift-off.
TEST(MotionBalance, EnergyOfAConservativeImpactStays) {
  wire::RodInMotion rod = soft_rod(End::clamp, End::clamp);
  rod.damping = {};
  Motion motion = oblique_impact(rod);
  motion.contacts[0].friction = {};
  MotionOptions options = test::fine_tolerances();
  options.duration = 0.1;
  const MotionResult result = simulate(motion, options);
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  EXPECT_EQ(result.events.back().kind, MotionEvent::Kind::lift_off);
  EXPECT_LT(std::abs(result.energy.integrator),
            1e-3 * 0.5 * 0.05 * motion.bodies[0].start.velocity.squaredNorm());
}

// A hook hangs on the wire by a bar of 4 mm, swings and slides to and fro for a minute.
TEST(SlowMotionBalance, NothingDriftsInAMinute) {
  wire::RodInMotion rod = soft_rod(End::clamp, End::clamp);
  rod.elements = 12;
  Motion motion = oblique_impact(rod);
  motion.gravity = {0.0, -9.81, 0.0};
  motion.bodies[0].start.position = {0.08, 0.003 - 0.05, 0.0};
  motion.bodies[0].start.velocity = {0.1, 0.0, 0.0};
  motion.contacts[0].shape = std::make_shared<EndlessCylinder>(0.002);
  motion.contacts[0].X_BS.p = {0.0, 0.05, 0.0};
  motion.contacts[0].friction = {};
  MotionOptions options;
  options.duration = 60.0;
  options.output_interval = 0.01;
  double swing = 0.0;
  double closed = 0.0;
  const MotionResult result = simulate(motion, options, [&](const MotionSample& s) {
    if (s.time > 50.0) swing = std::max(swing, std::abs(s.bodies[0].spin.z()));
    closed += s.contacts[0].closed ? 0.01 : 0.0;
    return false;
  });
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  EXPECT_GT(closed, 55.0);  // [s]: it is a test of the contact,
  EXPECT_GT(swing, 0.1);    // and of one that moves [rad/s]
  EXPECT_LT(result.largest_drift, 1e-9);
  // F = 4/3 k sqrt(2 (R + r)) d^(3/2) (M.8).
  const double modulus =
      default_modulus(rod.properties.axial_stiffness, rod.properties.bending_stiffness, 0.002);
  const double give =
      std::pow(result.peak_force[0] / (4.0 / 3.0 * modulus * std::sqrt(2.0 * 0.003)), 2.0 / 3.0);
  EXPECT_LT(result.largest_penetration, 1.3 * give);
  const double weight = 0.052 * 9.81;
  EXPECT_LT(result.momentum_error.norm(), 1e-6 * weight * options.duration);
  EXPECT_LT(result.angular_momentum_error.norm(), 1e-6 * weight * options.duration * length);
}

TEST(MotionState, GoingOnFromACheckpointGivesTheSameBits) {
  Motion motion = oblique_impact(soft_rod(End::clamp, End::pin));
  motion.bodies[0].start.spin = {1.0, -2.0, 3.0};
  MotionOptions options;
  options.duration = 0.05;
  options.checkpoint_interval = 0.012;
  const std::vector<MotionState> states = test::expect_same_bits_from_checkpoints(motion, options);
  ASSERT_EQ(states.size(), 4u);
  EXPECT_EQ(states[1].time, 0.024);
}

// Times that differ by less than 1e-13 s are the same: a leg between two checkpoints must be longer, or none
// ever ends.
TEST(MotionState, LegsAreLongerThanRoundOff) {
  const Motion motion = oblique_impact(soft_rod(End::clamp, End::pin));
  MotionOptions options;
  for (const double duration : {1e-300, 1e-13, 1e-12, 1e-11}) {
    options.duration = duration;
    options.checkpoint_interval = 0.1 * duration;
    const MotionResult result = simulate(motion, options);
    EXPECT_TRUE(result.report.usable()) << result.report.message;
    EXPECT_NEAR(result.report.time, duration, 1e-13);
  }
}

// No law of contact knows what happens at such a speed.
TEST(MotionState, ABodyThatIsTooFastEndsTheRun) {
  Motion motion = oblique_impact(soft_rod(End::clamp, End::pin));
  motion.bodies[0].name = "visitor";
  motion.bodies[0].force = {0.0, -1e4, 0.0};  // away from the wire
  MotionOptions options;
  options.duration = 0.1;
  options.max_step = 1e-4;
  const MotionResult result = simulate(motion, options);
  EXPECT_FALSE(result.report.usable());
  EXPECT_THAT(result.report.message,
              testing::MatchesRegex("visitor moves at 20.. m/s; bodies are computed up to 2000 m/s"));
  EXPECT_NEAR(result.report.time, 2000.0 / (1e4 / 0.05),
              1e-4);  // of a constant acceleration, at most a step further
}

// Runs share nothing that they change, the motion with its shapes included.
TEST(MotionState, RunsAtTheSameTimeGiveTheSameBits) {
  const Motion motion = oblique_impact(soft_rod(End::clamp, End::clamp));
  MotionOptions options;
  options.duration = 0.02;
  const MotionResult alone = simulate(motion, options);
  std::array<MotionResult, 2> both;
  {
    std::vector<std::jthread> threads;
    for (MotionResult& r : both) threads.emplace_back([&] { r = simulate(motion, options); });
  }
  for (const MotionResult& r : both) {
    EXPECT_EQ(r.last.unknowns, alone.last.unknowns);
    EXPECT_EQ(r.last.integrals, alone.last.integrals);
  }
}

TEST(MotionState, AnEndedMotionGoesOn) {
  const Motion motion = oblique_impact(soft_rod(End::clamp, End::clamp));
  MotionOptions options = test::fine_tolerances();
  options.duration = 0.02;
  const MotionResult half = simulate(motion, options);
  options.duration = 0.04;
  const MotionResult on = simulate(motion, options, {}, &half.last);
  const MotionResult through = simulate(motion, options);
  ASSERT_TRUE(on.report.usable()) << on.report.message;
  EXPECT_EQ(on.report.time, 0.04);
  // The start at first order in between costs some errors of a step.
  EXPECT_LT((on.impulse[0] - through.impulse[0]).norm(), 1e-4 * through.impulse[0].norm());
  EXPECT_LT((on.last.unknowns.head(3 * 17) - through.last.unknowns.head(3 * 17)).lpNorm<Eigen::Infinity>(),
            1e-6);
}

TEST(MotionState, AFailureKeepsWhatWasReached) {
  Motion motion = oblique_impact(soft_rod(End::clamp, End::clamp));
  motion.contacts[0].friction = {};
  // A law that breaks down at some depth.
  motion.contacts[0].law = ContactLaw(
      linear_law()->with(Eigen::VectorXd::Constant(1, 1e3)),
      [](double depth, double) -> Vector3d { return Vector3d::Constant(depth > 2e-5 ? std::nan("") : 0.0); });
  MotionOptions options;
  options.duration = 0.05;
  options.output_interval = 1e-4;
  double written = 0.0;
  const MotionResult result = simulate(motion, options, [&](const MotionSample& s) {
    written = s.time;
    return false;
  });
  EXPECT_FALSE(result.report.usable());
  EXPECT_GT(result.report.time, 1e-3);
  EXPECT_LT(result.report.time, 0.02);
  EXPECT_NEAR(written, result.report.time, options.output_interval);
  EXPECT_EQ(result.last.time, result.report.time);
  EXPECT_TRUE(result.last.unknowns.allFinite());
  EXPECT_THAT(result.report.message, testing::HasSubstr(" s, step "));
}

TEST(MotionState, OfAnotherMotionIsRefused) {
  const Motion motion = oblique_impact(soft_rod(End::clamp, End::clamp));
  MotionOptions options;
  options.duration = 0.001;
  MotionState state = simulate(motion, options).last;
  state.memory.pop_back();
  options.duration = 0.002;
  EXPECT_THROW((void)simulate(motion, options, {}, &state), base::InputError);
  state.unknowns.conservativeResize(10);
  EXPECT_THAT(test::refusal([&] { return simulate(motion, options, {}, &state); }),
              testing::HasSubstr("state = 10 unknowns, must be that of the same motion"));
}

}  // namespace
}  // namespace snare::coupling
