// Wires whose inertia is left out: against the static push, the full wire, and the balances.

#include "base/units.hpp"
#include "coupling/dynamics/model/start.hpp"
#include "coupling/dynamics/run/simulate.hpp"
#include "coupling/statics/push_solver.hpp"
#include "tests/support/same_bits.hpp"
#include "tests/support/soft_wire.hpp"
#include "validation/declared_wire.hpp"
#include "wire/motion/rod_in_motion.hpp"
#include "wire/motion/rod_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

namespace snare::coupling {
namespace {

using base::mm;
using Eigen::Vector3d;

constexpr double span = 175.0 * mm;

/// The declared wire, met by a cylinder of 6 mm in its middle.
Motion head_on(bool quasi_static, double mass, double speed) {
  const wire::WireSpecification w = validation::declared_specification();
  wire::RodInMotion rod = wire::rod_in_motion(w, span, 40);
  rod.damping.bending_time = rod.damping.axial_time = 1e-5;
  rod.quasi_static = quasi_static;
  Motion motion;
  motion.wires.push_back({"wire", rod, resting_wire(rod), {}});
  MotionBody body;
  body.properties.mass = mass;
  body.properties.inertia = 0.16 * Eigen::Matrix3d::Identity();
  const double touch = motion.wires[0].positions.row(1).maxCoeff() - 6.0 * mm - 0.5 * w.diameter;
  body.start.position = {0.5 * span, touch - 0.1 * mm, 0.0};
  body.start.velocity = {0.0, speed, 0.0};
  motion.bodies.push_back(body);
  MotionContact contact;
  contact.shape = std::make_shared<EndlessCylinder>(6.0 * mm);
  contact.wire_radius = 0.5 * w.diameter;
  motion.contacts.push_back(contact);
  return motion;
}

MotionResult run(const Motion& motion, double duration) {
  MotionOptions options;
  options.duration = duration;
  MotionResult result = simulate(motion, options);
  EXPECT_TRUE(result.report.usable()) << result.report.message;
  return result;
}

// The body weighs 3500 times the wire: what the wire's mass does is as small.
TEST(QuasiStaticWire, ReturnsABodyAsTheFullWireDoes) {
  const MotionResult full = run(head_on(false, 8.9, 0.1), 0.04), still = run(head_on(true, 8.9, 0.1), 0.04);
  EXPECT_NEAR(still.impulse[0].y(), full.impulse[0].y(), 3e-4 * full.impulse[0].y());
  EXPECT_NEAR(still.peak_force[0], full.peak_force[0], 1e-3 * full.peak_force[0]);
  EXPECT_LT(still.statistics.steps, full.statistics.steps);
}

// Steps through the touch begin where it does: looked for by steps that fail it took steps of 5e-8 s, and
// twice the matrices.
TEST(QuasiStaticWire, IsTouchedAsTheFullWireWithoutTinySteps) {
  for (const bool quasi_static : {false, true}) {
    const numerics::IdaStatistics s = run(head_on(quasi_static, 8.9, 0.1), 0.002).statistics;
    EXPECT_GT(s.smallest_step, 1e-7) << quasi_static;
    EXPECT_LT(s.newton_failures, 30) << quasi_static;
  }
}

// Between pins the tenth mode of the inertia that is kept has omega^2 = (10 pi/L)^4 EI/(1e-3 rho A), and tau
// omega/2 is its damping ratio.
TEST(QuasiStaticWire, ItsTenthModeIsCriticallyDampedAtLeast) {
  Motion motion = head_on(true, 8.9, 0.1);
  wire::RodInMotion& rod = motion.wires[0].rod;
  const wire::RodDamping declared = rod.damping;
  rod.damping.bending_time = 0.0;
  const double omega = std::pow(10.0 * std::numbers::pi / rod.length, 2) *
                       std::sqrt(rod.properties.bending_stiffness / (1e-3 * rod.mass_per_length));
  EXPECT_NEAR(0.5 * omega * wire::RodModel(rod).damping().bending_time, 1.0, 1e-12);
  rod.damping = declared;
  EXPECT_EQ(wire::RodModel(rod).damping().bending_time, declared.bending_time);
}

// Without any damping declared it follows no waves either: some more steps, not a hundred times as many. The
// slow body gets its speed back.
TEST(QuasiStaticWire, FollowsNoWavesWithoutDamping) {
  Motion bare = head_on(true, 8.9, 0.1);
  bare.wires[0].rod.damping = {};
  const MotionResult damped = run(head_on(true, 8.9, 0.1), 0.04), r = run(bare, 0.04);
  EXPECT_LT(r.statistics.steps, 4 * damped.statistics.steps);
  EXPECT_NEAR(r.impulse[0].y(), 2.0 * 8.9 * 0.1, 3e-4 * 2.0 * 8.9 * 0.1);
}

TEST(QuasiStaticWire, ClosesItsBalances) {
  const MotionResult r = run(head_on(true, 8.9, 0.1), 0.04);
  const double energy = 0.5 * 8.9 * 0.1 * 0.1;
  EXPECT_LT(std::abs(r.energy.integrator), 1e-3 * energy);
  EXPECT_GT(r.energy.dissipated, 0.0);
  EXPECT_LT(r.momentum_error.norm(), 1e-6 * r.impulse[0].norm());
  EXPECT_LT(r.angular_momentum_error.norm(), 1e-6 * r.impulse[0].norm() * span);
}

// What is left out, as it is estimated, is what the full wire has; it grows with the square of the speed.
TEST(QuasiStaticWire, EstimatesWhatItLeavesOut) {
  const MotionResult slow = run(head_on(true, 8.9, 0.05), 0.06), fast = run(head_on(true, 8.9, 0.1), 0.04);
  ASSERT_EQ(slow.left_out.size(), 1u);
  EXPECT_NEAR(fast.left_out[0].kinetic / slow.left_out[0].kinetic, 4.0, 0.4);
  // Of the wire's 2.5 g less than half moves, less fast than the body.
  const double wire_mass = validation::declared_specification().mass_per_length() * 180.0 * mm;
  EXPECT_LT(fast.left_out[0].kinetic, 0.5 * wire_mass * 0.1 * 0.1);
  EXPECT_GT(fast.left_out[0].kinetic, 0.1 * 0.5 * wire_mass * 0.1 * 0.1);
  const MotionResult full = run(head_on(false, 8.9, 0.1), 0.04);
  EXPECT_EQ(full.left_out[0].kinetic, 0.0);
}

// Driven at any speed the force is that of the static push on the same vertices, at the integrator's steps
// and between them. Damping has half of the thousandth.
TEST(QuasiStaticWire, FollowsTheStaticCurve) {
  constexpr int elements = 200;
  constexpr double pace = 20.0 * mm;  // [m/s]
  PushProblem push = validation::declared_wire(0.5 * span, 6.0 * mm);
  PushOptions push_options;
  push_options.elements = elements;
  push_options.grading = 0.0;
  Motion motion = head_on(true, 1.0, 0.0);
  wire::RodInMotion& rod = motion.wires[0].rod;
  rod.elements = elements;
  motion.wires[0].positions = resting_wire(rod);
  motion.bodies[0].driven = true;
  motion.bodies[0].start.position.y() =
      motion.wires[0].positions.row(1).maxCoeff() - 6.75 * mm - 1e-6;  // all but touching
  motion.bodies[0].start.velocity = {0.0, pace, 0.0};
  MotionOptions options;
  options.duration = 0.05;
  options.output_interval = 0.001;
  std::vector<double> forces;
  const MotionResult r = simulate(motion, options, [&](const MotionSample& s) {
    if (s.time > 0.012) {
      push.travel.push_back(pace * s.time - 1e-6);
      forces.push_back(s.contacts[0].force.y());
    }
    return false;
  });
  ASSERT_TRUE(r.report.usable()) << r.report.message;
  const PushCurve curve = solve_push(push, push_options);
  ASSERT_EQ(curve.points.size(), forces.size());
  for (std::size_t k = 0; k < forces.size(); ++k)
    EXPECT_NEAR(forces[k], curve.points[k].force, 1e-3 * curve.points[k].force) << k;
}

// With friction, on a wire of soft material that a body drags along: same bits from a state on the way.
TEST(QuasiStaticWire, GoesOnFromACheckpointWithTheSameBits) {
  wire::RodInMotion rod = test::soft_wire(16);
  rod.quasi_static = true;
  Motion motion = test::body_below(rod, std::make_shared<Ball>(0.01), {0.065, -0.0125, 0.0}, 0.3, 0.05);
  motion.bodies[0].start.velocity.x() = 0.1;
  motion.contacts[0].friction = {0.3, 0.1, 0.01, 1.0};
  MotionOptions options;
  options.duration = 0.04;
  options.checkpoint_interval = 0.012;
  EXPECT_EQ(test::expect_same_bits_from_checkpoints(motion, options).size(), 3u);
}

}  // namespace
}  // namespace snare::coupling
