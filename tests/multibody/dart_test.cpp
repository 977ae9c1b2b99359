#include "tests/multibody/dart_reference.hpp"

#include "multibody/arm/arm_run.hpp"
#include "multibody/dynamics.hpp"
#include "multibody/kinematics.hpp"

#include <gtest/gtest.h>

// Against DART, which shares no code with ours. Both solve problems of order one (condition of the mass
// matrix up to some 1e4) in double precision: 1e-10 is above what rounding leaves, and below any error of a
// formula.

namespace snare {

namespace {

using test::Base;

/// Sum of mass times place of the bodies that move, from DART's poses. What hangs on the world is no part of
/// our tree.
Eigen::Vector3d moment_of_mass(const test::PlainTree& plain, test::DartTree& dart) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < plain.bodies.size(); ++i) {
    if (dart.body(i).getNumDependentGenCoords() > 0) sum += plain.bodies[i].mass * dart.body(i).getCOM();
  }
  return sum;
}

Eigen::Vector3d linear_momentum(const test::PlainTree& plain, test::DartTree& dart) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < plain.bodies.size(); ++i)
    sum += plain.bodies[i].mass * dart.body(i).getCOMLinearVelocity();
  return sum;
}

void compare_random_trees(Base base, unsigned seed) {
  std::mt19937 random(seed);
  for (int trial = 0; trial < 500; ++trial) {
    SCOPED_TRACE(trial);
    const test::PlainTree plain = test::random_tree(random, base);
    const multibody::Tree tree = test::make_tree(plain);
    const multibody::TreeState state = test::random_state(random, tree);
    const Eigen::VectorXd torque = test::random_values(random, tree.velocities(), 10.0);
    test::DartTree dart(plain);
    dart.set(tree, state);

    // A wrench on a random body, given in the axes of the world at the body's origin.
    const auto loaded = std::uniform_int_distribution<std::size_t>(0, plain.bodies.size() - 1)(random);
    const int frame = static_cast<int>(loaded) + 1;
    const multibody::Wrench load{test::random_vector(random, 5.0), test::random_vector(random, 5.0)};
    multibody::Kinematics kinematics(tree);
    multibody::place(tree, state.q, kinematics);
    multibody::set_moving(tree, state.v, kinematics);
    const multibody::BodyWrench on_body = multibody::world_wrench_on_frame(tree, kinematics, frame, load);
    std::vector<multibody::Wrench> wrenches(static_cast<std::size_t>(tree.size()));
    if (on_body.body >= 0) wrenches[static_cast<std::size_t>(on_body.body)] = on_body.F_B;
    dart.body(loaded).setExtForce(load.force, Eigen::Vector3d::Zero(), false, true);
    dart.body(loaded).setExtTorque(load.moment, false);

    multibody::DynamicsWorkspace workspace(tree);
    EXPECT_LT(test::relative_difference(multibody::mass_matrix(tree, state.q, workspace),
                                        dart.skeleton().getMassMatrix()),
              1e-10);
    const Eigen::VectorXd bias = multibody::inverse_dynamics(
        tree, state.q, state.v, Eigen::VectorXd::Zero(tree.velocities()), wrenches, workspace);
    EXPECT_LT(test::relative_difference(
                  bias, dart.skeleton().getCoriolisAndGravityForces() - dart.skeleton().getExternalForces()),
              1e-10);
    const Eigen::VectorXd acceleration =
        multibody::forward_dynamics(tree, state.q, state.v, torque, wrenches, workspace);
    EXPECT_LT(test::relative_difference(acceleration, dart.forward_dynamics(torque)), 1e-10);
    const Eigen::VectorXd inverse =
        multibody::inverse_dynamics(tree, state.q, state.v, acceleration, wrenches, workspace);
    EXPECT_LT(test::relative_difference(inverse, torque), 1e-10);

    const multibody::Pose pose = multibody::frame_pose(tree, kinematics, frame);
    const Eigen::Isometry3d dart_pose = dart.body(loaded).getWorldTransform();
    EXPECT_LT(test::relative_difference(pose.R, dart_pose.linear()), 1e-10);
    EXPECT_LT(test::relative_difference(pose.p, dart_pose.translation()), 1e-10);
    const multibody::Matrix6X jacobian = multibody::frame_jacobian(tree, kinematics, frame);
    EXPECT_LT(test::relative_difference(jacobian, dart.skeleton().getWorldJacobian(&dart.body(loaded))),
              1e-10);
    EXPECT_LT(test::relative_difference(multibody::frame_jacobian_rate(tree, kinematics, frame),
                                        dart.skeleton().getJacobianClassicDeriv(&dart.body(loaded))),
              1e-10);
    EXPECT_LT(test::relative_difference(jacobian * state.v,
                                        dart.body(loaded).getSpatialVelocity(dart::dynamics::Frame::World(),
                                                                             dart::dynamics::Frame::World())),
              1e-10);

    EXPECT_LT(
        std::abs(multibody::kinetic_energy(tree, kinematics) / dart.skeleton().computeKineticEnergy() - 1.0),
        1e-10);
    EXPECT_LT(std::abs(multibody::potential_energy(tree, kinematics) +
                       moment_of_mass(plain, dart).dot(plain.gravity)),
              1e-9);
    const multibody::Wrench momentum = multibody::momentum(tree, kinematics);
    EXPECT_LT(test::relative_difference(momentum.force, linear_momentum(plain, dart)), 1e-10);
  }
}

}  // namespace

TEST(Dart, AgreesOnTrajectories) {
  // The same motion twice: DART's accelerations stepped by Runge and Kutta, and our equations integrated by
  // IDA.
  for (const Base base : {Base::on_the_world, Base::floating}) {
    std::mt19937 random(31);
    test::PlainTree plain = test::random_tree(random, base);
    while (plain.bodies.size() < 5) plain = test::random_tree(random, base);
    plain.gravity = {0.0, 0.0, -1.0};
    multibody::ArmScenario run;
    run.arm.tree = test::make_tree(plain);
    const multibody::Tree& tree = run.arm.tree;
    multibody::TreeState state = test::random_state(random, tree);
    state.v *= 0.3;
    run.initial = {state.q, state.v, Eigen::VectorXd(0), Eigen::VectorXd(0)};
    run.end = 1.0;
    run.ida.relative_tolerance = 1e-11;
    run.tolerances = {1e-11, 1e-11};
    const multibody::ArmHistory history = multibody::simulate(run);
    ASSERT_TRUE(history.report.usable()) << history.report.message;

    test::DartTree dart(plain);
    const auto acceleration = [&](const Eigen::VectorXd& q, const Eigen::VectorXd& v) -> Eigen::VectorXd {
      dart.set(tree, {q, v});
      return dart.forward_dynamics(Eigen::VectorXd::Zero(tree.velocities()));
    };
    const auto rate = [&](const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
      return test::coordinate_rate(tree, q, v);
    };
    const int steps = 1000;
    const double h = run.end / steps;
    for (int i = 0; i < steps; ++i) {
      const Eigen::VectorXd q1 = rate(state.q, state.v), a1 = acceleration(state.q, state.v);
      const Eigen::VectorXd v2 = state.v + 0.5 * h * a1, s2 = state.q + 0.5 * h * q1, q2 = rate(s2, v2),
                            a2 = acceleration(s2, v2);
      const Eigen::VectorXd v3 = state.v + 0.5 * h * a2, s3 = state.q + 0.5 * h * q2, q3 = rate(s3, v3),
                            a3 = acceleration(s3, v3);
      const Eigen::VectorXd v4 = state.v + h * a3, s4 = state.q + h * q3, q4 = rate(s4, v4),
                            a4 = acceleration(s4, v4);
      state.q += h / 6.0 * (q1 + 2.0 * q2 + 2.0 * q3 + q4);
      state.v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    }
    // Runge and Kutta: h^4 times derivatives of some hundreds; IDA: some hundred steps at 1e-11.
    const multibody::ArmState& end = history.samples.back().state;
    EXPECT_LT(test::relative_difference(end.q, state.q), 1e-8);
    EXPECT_LT(test::relative_difference(end.v, state.v), 1e-8);
  }
}

TEST(Dart, AgreesOnTreesOnTheWorld) {
  compare_random_trees(Base::on_the_world, 1);
}
TEST(Dart, AgreesOnFloatingTrees) {
  compare_random_trees(Base::floating, 2);
}

}  // namespace snare
