#include "coupling/dynamics/joints/bushing_part.hpp"

#include "coupling/dynamics/run/simulate.hpp"
#include "multibody/arm/arm_part.hpp"
#include "tests/support/dae_jacobian.hpp"
#include "tests/support/motion_bodies.hpp"
#include "tests/support/same_bits.hpp"

#include <gmock/gmock.h>
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

MotionBushing bushing_between(MotionCarrier first, MotionCarrier second) {
  MotionBushing b;
  b.first = first;
  b.second = second;
  b.translational_stiffness = {2000.0, 3000.0, 5000.0};
  b.rotational_stiffness = {40.0, 50.0, 70.0};
  return b;
}

TEST(Bushing, JacobianMatchesDifferences) {
  const multibody::ElasticArm model = test::one_joint("link", Vector3d(1.0, 2.0, 0.5));
  multibody::ElasticArmPart arm(model, {multibody::Drive::limp()}, {});
  const MotionOptions options;
  BodyPart a(block("a", 3.0, {0.3, 0.4, 0.5}), Vector3d::Zero(), options);
  BodyPart b(block("b", 2.0, {0.2, 0.3, 0.4}), Vector3d::Zero(), options);
  MotionBushing law = bushing_between(body_of(0), body_of(1));
  law.translational_damping = {20.0, 30.0, 40.0};
  law.rotational_damping = {2.0, 3.0, 4.0};
  const multibody::Pose X_AF{Eigen::AngleAxisd(0.4, Vector3d(1.0, 2.0, -1.0).normalized()).toRotationMatrix(),
                             {0.5, 0.1, -0.2}};
  BushingPart of_bodies(law, {a, X_AF}, {b, {}}), of_arm(law, {arm, 0, X_AF}, {b, X_AF});
  BushingPart of_world(law, MovingFrame(X_AF), {a, {}});
  numerics::DaeSystem system({&arm, &a, &b, &of_bodies, &of_arm, &of_world});
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  VectorXd y(system.size()), rate(system.size());
  for (double& v : y) v = unit(random);
  for (double& v : rate) v = unit(random);
  for (const BodyPart* body : {&a, &b}) y.segment<4>(body->quaternion()).normalize();
  const Eigen::MatrixXd directions = test::along_unit_quaternions(y, {a.quaternion(), b.quaternion()});
  arm.settle(0.0, y);
  const test::DerivativeError error = test::compare_dae_jacobian(system, y, rate, directions, 1e-3);
  EXPECT_LT(error.relative, 1e-8) << error.worst;
}

/// Times at which a number of the samples passes zero upwards, straight between two.
std::vector<double> upward_zeros(const Motion& motion, const MotionOptions& options,
                                 const std::function<double(const MotionSample&)>& number) {
  std::vector<double> zeros;
  std::optional<std::pair<double, double>> before;
  const MotionResult result = simulate(motion, options, [&](const MotionSample& s) {
    const std::pair<double, double> now{s.time, number(s)};
    if (before && before->second < 0.0 && now.second >= 0.0)
      zeros.push_back(before->first -
                      before->second * (now.first - before->first) / (now.second - before->second));
    before = now;
    return false;
  });
  EXPECT_TRUE(result.report.usable()) << result.report.message;
  return zeros;
}

// On a clamped fixture a body swings about the axis of the bushing at sqrt(K/I); two free ones towards each
// other at sqrt(k (1/m + 1/m')).
TEST(Bushing, FrequenciesAreThoseOfTheClosedForm) {
  Motion clamped;
  clamped.bodies = {block("visitor", 3.0, {0.3, 0.4, 0.5})};
  clamped.bushings = {bushing_between({}, body_of(0))};
  clamped.bodies[0].start.spin = {1e-3, 0.0, 0.0};
  const std::vector<double> turns = upward_zeros(
      clamped, fine(5.0, 1e-3), [](const MotionSample& s) { return s.bodies[0].orientation.x(); });
  ASSERT_GT(turns.size(), 5u);
  const double period = (turns.back() - turns.front()) / static_cast<double>(turns.size() - 1);
  EXPECT_NEAR(period, 2.0 * std::numbers::pi * std::sqrt(0.3 / 40.0), 1e-5 * period);

  Motion free;
  free.bodies = {block("one", 3.0, {0.3, 0.4, 0.5}), block("other", 5.0, {0.4, 0.4, 0.5})};
  free.bushings = {bushing_between(body_of(0), body_of(1))};
  free.bodies[0].start.velocity = {0.0, 0.01, 0.0};
  const std::vector<double> sways =
      upward_zeros(free, fine(2.0, 1e-3), [](const MotionSample& s) { return s.bushings[0].shift.y(); });
  ASSERT_GT(sways.size(), 5u);
  const double sway = (sways.back() - sways.front()) / static_cast<double>(sways.size() - 1);
  EXPECT_NEAR(sway, 2.0 * std::numbers::pi / std::sqrt(3000.0 * (1.0 / 3.0 + 1.0 / 5.0)), 1e-5 * sway);
}

// Turns of more than a radian about changing axes: the moment is that of the energy, and what one feels the
// other does.
TEST(Bushing, KeepsEnergyAndMomentumInLargeTurns) {
  Motion motion;
  motion.bodies = {block("one", 3.0, {0.3, 0.4, 0.5}), block("other", 5.0, {0.6, 0.5, 0.7})};
  motion.bodies[1].start.position = {0.3, 0.0, 0.1};
  motion.bushings = {bushing_between(body_of(0), body_of(1))};
  motion.bodies[0].start.spin = {12.0, -8.0, 5.0};
  motion.bodies[0].start.velocity = {0.5, 0.2, -0.3};
  double largest_turn = 0.0, start = 0.0;
  const MotionResult result = simulate(motion, fine(2.0, 1e-3), [&](const MotionSample& s) {
    if (s.time == 0.0) start = s.energy.kinetic;
    largest_turn = std::max(largest_turn, s.bushings[0].turn.norm());
    return false;
  });
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  EXPECT_GT(largest_turn, 1.0);
  EXPECT_LT(std::abs(result.energy.integrator), 1e-6 * start);
  EXPECT_LT(result.momentum_error.norm(), 1e-8);
  EXPECT_LT(result.angular_momentum_error.norm(), 1e-7);
}

// Damping ratio zeta = c/(2 sqrt(k m)): the swing falls by exp(-2 pi zeta/sqrt(1 - zeta^2)) a period; what is
// lost is counted, also against a world that gives forces.
TEST(Bushing, DampsAsTheClosedForm) {
  Motion motion;
  motion.bodies = {block("visitor", 3.0, {0.3, 0.4, 0.5})};
  motion.bushings = {bushing_between(body_of(0), {})};
  motion.bushings[0].translational_damping = {8.0, 8.0, 8.0};
  motion.bodies[0].start.velocity = {0.1, 0.0, 0.0};
  const double omega = std::sqrt(2000.0 / 3.0), zeta = 8.0 / (2.0 * std::sqrt(2000.0 * 3.0));
  double worst = 0.0;
  const MotionResult result = simulate(motion, fine(1.0, 1e-3), [&](const MotionSample& s) {
    const double w = omega * std::sqrt(1.0 - zeta * zeta);
    worst = std::max(worst, std::abs(s.bodies[0].position.x() -
                                     0.1 / w * std::exp(-zeta * omega * s.time) * std::sin(w * s.time)));
    return false;
  });
  ASSERT_TRUE(result.report.usable()) << result.report.message;
  EXPECT_LT(worst, 1e-8);
  EXPECT_LT(std::abs(result.energy.integrator), 1e-8);
  EXPECT_GT(result.energy.dissipated, 0.01);
  EXPECT_LT(result.momentum_error.norm(), 1e-7);
}

TEST(Bushing, GoesOnFromACheckpointWithTheSameBits) {
  Motion motion;
  motion.bodies = {block("one", 3.0, {0.3, 0.4, 0.5}), block("other", 5.0, {0.6, 0.5, 0.7})};
  motion.bushings = {bushing_between(body_of(0), body_of(1))};
  motion.bodies[0].start.spin = {2.0, -1.0, 0.5};
  MotionOptions options;
  options.duration = 0.2;
  options.checkpoint_interval = 0.06;
  EXPECT_EQ(test::expect_same_bits_from_checkpoints(motion, options).size(), 3u);
}

}  // namespace
}  // namespace snare::coupling
