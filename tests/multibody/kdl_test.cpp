#include "tests/multibody/kdl_reference.hpp"

#include "multibody/dynamics.hpp"
#include "multibody/kinematics.hpp"

#include <gtest/gtest.h>
#include <kdl/chaindynparam.hpp>
#include <kdl/chainfdsolver_recursive_newton_euler.hpp>
#include <kdl/chainjnttojacdotsolver.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <kdl/treeidsolver_recursive_newton_euler.hpp>

// Against orocos-KDL, which shares no code with ours. Problems of order one in double precision: 1e-10 is
// above what rounding leaves (the accelerations are solved with mass matrices of condition up to some 1e4),
// and below any error of a formula.

namespace snare {

TEST(Kdl, AgreesOnInverseDynamicsOfTrees) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 500; ++trial) {
    SCOPED_TRACE(trial);
    const test::PlainTree plain = test::random_tree(random, test::Base::on_the_world);
    const multibody::Tree tree = test::make_tree(plain);
    const multibody::TreeState state = test::random_state(random, tree);
    const Eigen::VectorXd acceleration = test::random_values(random, tree.velocities(), 5.0);

    // KDL takes wrenches in the segments' frames, and only where a name is given.
    const std::size_t loaded = std::uniform_int_distribution<std::size_t>(0, plain.bodies.size() - 1)(random);
    const multibody::Wrench load{test::random_vector(random, 5.0), test::random_vector(random, 5.0)};
    const multibody::BodyWrench on_body =
        multibody::wrench_on_frame(tree, static_cast<int>(loaded) + 1, load);
    std::vector<multibody::Wrench> wrenches(static_cast<std::size_t>(tree.size()));
    if (on_body.body >= 0) wrenches[static_cast<std::size_t>(on_body.body)] = on_body.F_B;
    KDL::WrenchMap kdl_wrenches;
    kdl_wrenches[test::body_name(loaded)] = KDL::Wrench(test::to_kdl(load.force), test::to_kdl(load.moment));

    // KDL numbers the joints in the order in which segments were added; so do we.
    const KDL::Tree kdl = test::kdl_tree(plain);
    ASSERT_EQ(static_cast<int>(kdl.getNrOfJoints()), tree.velocities());
    KDL::TreeIdSolver_RNE solver(kdl, test::to_kdl(plain.gravity));
    KDL::JntArray torque(kdl.getNrOfJoints());
    ASSERT_EQ(solver.CartToJnt(test::to_kdl(state.q), test::to_kdl(state.v), test::to_kdl(acceleration),
                               kdl_wrenches, torque),
              0);

    multibody::DynamicsWorkspace workspace(tree);
    const Eigen::VectorXd ours =
        multibody::inverse_dynamics(tree, state.q, state.v, acceleration, wrenches, workspace);
    EXPECT_LT(test::relative_difference(ours, torque.data), 1e-10);
    // Forward dynamics of KDL's torques give back the accelerations.
    EXPECT_LT(test::relative_difference(
                  multibody::forward_dynamics(tree, state.q, state.v, torque.data, wrenches, workspace),
                  acceleration),
              1e-10);
  }
}

TEST(Kdl, AgreesOnChains) {
  std::mt19937 random(12);
  for (int trial = 0; trial < 500; ++trial) {
    SCOPED_TRACE(trial);
    const test::PlainTree plain = test::random_tree(random, test::Base::on_the_world, false);
    const multibody::Tree tree = test::make_tree(plain);
    const multibody::TreeState state = test::random_state(random, tree);
    const Eigen::VectorXd torque = test::random_values(random, tree.velocities(), 10.0);
    const int tip = static_cast<int>(plain.bodies.size());
    KDL::Chain chain;
    for (std::size_t i = 0; i < plain.bodies.size(); ++i)
      chain.addSegment(test::kdl_segment(plain.bodies[i], i));
    const unsigned n = chain.getNrOfJoints();
    const KDL::JntArray q = test::to_kdl(state.q), v = test::to_kdl(state.v);

    multibody::DynamicsWorkspace workspace(tree);
    KDL::ChainDynParam parameters(chain, test::to_kdl(plain.gravity));
    KDL::JntSpaceInertiaMatrix inertia(static_cast<int>(n));
    parameters.JntToMass(q, inertia);
    EXPECT_LT(test::relative_difference(multibody::mass_matrix(tree, state.q, workspace), inertia.data),
              1e-10);

    KDL::JntArray coriolis(n), gravity(n);
    parameters.JntToCoriolis(q, v, coriolis);
    parameters.JntToGravity(q, gravity);
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(tree.velocities());
    EXPECT_LT(
        test::relative_difference(multibody::inverse_dynamics(tree, state.q, state.v, none, {}, workspace),
                                  coriolis.data + gravity.data),
        1e-10);

    KDL::ChainFdSolver_RNE forward(chain, test::to_kdl(plain.gravity));
    KDL::JntArray acceleration(n);
    ASSERT_EQ(
        forward.CartToJnt(q, v, test::to_kdl(torque), KDL::Wrenches(chain.getNrOfSegments()), acceleration),
        0);
    EXPECT_LT(
        test::relative_difference(multibody::forward_dynamics(tree, state.q, state.v, torque, {}, workspace),
                                  acceleration.data),
        1e-10);

    // KDL's rows are linear over angular.
    multibody::Kinematics kinematics(tree);
    multibody::place(tree, state.q, kinematics);
    multibody::set_moving(tree, state.v, kinematics);
    KDL::Jacobian jacobian(n), rate(n);
    KDL::ChainJntToJacSolver(chain).JntToJac(q, jacobian);
    KDL::ChainJntToJacDotSolver rates(chain);
    rates.setHybridRepresentation();
    rates.JntToJacDot(KDL::JntArrayVel(q, v), rate);
    const multibody::Matrix6X ours = multibody::frame_jacobian(tree, kinematics, tip);
    const multibody::Matrix6X ours_rate = multibody::frame_jacobian_rate(tree, kinematics, tip);
    EXPECT_LT(test::relative_difference(ours.topRows(3), jacobian.data.bottomRows(3)), 1e-10);
    EXPECT_LT(test::relative_difference(ours.bottomRows(3), jacobian.data.topRows(3)), 1e-10);
    EXPECT_LT(test::relative_difference(ours_rate.topRows(3), rate.data.bottomRows(3)), 1e-10);
    EXPECT_LT(test::relative_difference(ours_rate.bottomRows(3), rate.data.topRows(3)), 1e-10);
  }
}

}  // namespace snare
