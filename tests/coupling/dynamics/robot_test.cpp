#include "coupling/dynamics/model/robot.hpp"

#include "coupling/contact/shape.hpp"
#include "coupling/dynamics/run/simulate.hpp"
#include "tests/support/motion_bodies.hpp"
#include "tests/support/same_bits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <vector>

namespace snare::coupling {
namespace {

using Eigen::Vector3d;

constexpr double stiffness = 1e4, mass = 40.0, radius = 0.02, wall_radius = 0.03, speed = 0.05;

/// A robot with a ball that flies along y at a ball that stands, 5 mm before it.
Motion robot_at_a_wall(double delay, double damping = 0.0) {
  Motion motion;
  MotionBody robot;
  robot.name = "robot";
  robot.driven = true;
  robot.start.position = {0.0, -(radius + wall_radius + 0.005), 0.0};
  robot.start.velocity = {0.0, speed, 0.0};
  robot.robot = MotionRobot{mass, delay, {{0, -1.0}}};
  motion.bodies = {robot};
  BodyContact contact;
  contact.shape = std::make_shared<Capsule>(wall_radius, 0.0);
  contact.other = test::body_of(0);
  contact.X_WP.p = robot.start.position;
  contact.points = {Vector3d::Zero()};
  contact.radius = radius;
  contact.law = spring_dashpot(stiffness, damping);
  motion.body_contacts = {contact};
  return motion;
}

MotionOptions fine(double duration) {
  MotionOptions o;
  o.duration = duration;
  o.output_interval = 0.01;
  o.relative_tolerance = 1e-9;
  o.body_position_tolerance = 1e-12;
  o.body_velocity_tolerance = 1e-10;
  return o;
}

double speed_after(double delay, double damping) {
  double v = 0.0;
  const MotionResult result =
      simulate(robot_at_a_wall(delay, damping), fine(0.6), [&](const MotionSample& s) {
        v = s.bodies[0].velocity.y();
        return false;
      });
  EXPECT_TRUE(result.report.usable()) << result.report.message;
  return v;
}

/// The delayed equation by steps of a whole share of the delay, with the parabola through what the force was
/// at their ends and middles: nothing of the code under test.
double speed_by_steps(double delay, double damping) {
  const int per_delay = 400;
  const double h = delay / per_delay;
  std::vector<double> force;  // at half steps
  const auto law = [&](double d, double v) {
    return d > 0.0 ? std::max(0.0, stiffness * d + damping * v) : 0.0;
  };
  const auto past = [&](std::size_t half) {
    return half >= 2u * per_delay ? force[half - 2u * per_delay] : 0.0;
  };
  double d = -0.005, v = speed;
  force.push_back(law(d, v));
  const auto steps = static_cast<std::size_t>(0.6 / h);
  for (std::size_t n = 0; n < steps; ++n) {
    const double a0 = -past(2 * n) / mass, a1 = -past(2 * n + 1) / mass, a2 = -past(2 * n + 2) / mass;
    const double middle_v = v + h * (5.0 * a0 + 8.0 * a1 - a2) / 24.0;
    const double middle_d = d + 0.5 * h * v + h * h * (7.0 * a0 + 6.0 * a1 - a2) / 96.0;
    force.push_back(law(middle_d, middle_v));
    d += h * v + h * h * (a0 + 2.0 * a1) / 6.0;
    v += h * (a0 + 4.0 * a1 + a2) / 6.0;
    force.push_back(law(d, v));
  }
  return v;
}

// A body that plays a free one late leaves faster than it came: growth at omega^2 tau/2 over half a swing
// makes exp(pi omega tau/2).
TEST(Robot, BouncesOffFasterByItsDelay) {
  const double omega = std::sqrt(stiffness / mass);
  for (const double delay : {0.001, 0.002, 0.004}) {
    const double expected = std::exp(0.5 * std::numbers::pi * omega * delay);
    EXPECT_NEAR(-speed_after(delay, 0.0) / speed, expected, 0.02 * expected) << delay;
  }
}

TEST(Robot, MovesAsTheDelayedEquation) {
  for (const double delay : {0.002, 0.01, 0.03}) {
    for (const double damping : {0.0, 60.0}) {
      const double expected = speed_by_steps(delay, damping);
      EXPECT_NEAR(speed_after(delay, damping), expected, 2e-5 * std::abs(expected))
          << delay << " " << damping;
    }
  }
}

TEST(Robot, GoesOnFromACheckpointWithTheSameBits) {
  MotionOptions options;
  options.duration = 0.6;
  options.output_interval = 0.01;
  options.checkpoint_interval = 0.03;
  EXPECT_GT(test::expect_same_bits_from_checkpoints(robot_at_a_wall(0.02), options).size(), 15u);
}

}  // namespace
}  // namespace snare::coupling
