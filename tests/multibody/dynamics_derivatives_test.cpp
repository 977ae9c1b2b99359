#include "multibody/dynamics_derivatives.hpp"
#include "tests/multibody/random_tree.hpp"
#include "tests/support/derivatives.hpp"

#include <gtest/gtest.h>

namespace snare {

namespace {

void compare(test::Base base, unsigned seed) {
  std::mt19937 random(seed);
  for (int trial = 0; trial < 40; ++trial) {
    SCOPED_TRACE(trial);
    const multibody::Tree tree = test::make_tree(test::random_tree(random, base));
    const multibody::TreeState state = test::random_state(random, tree);
    const int n = tree.velocities();
    const Eigen::VectorXd acceleration = test::random_values(random, n, 2.0);
    std::vector<multibody::Wrench> wrenches(static_cast<std::size_t>(tree.size()));
    for (auto& w : wrenches) w = {test::random_vector(random, 2.0), test::random_vector(random, 2.0)};
    multibody::DynamicsWorkspace workspace(tree);
    multibody::InverseDynamicsDerivatives derivatives(tree);
    multibody::differentiate_inverse_dynamics(tree, state.q, state.v, acceleration, wrenches, derivatives);

    // Differences are good to some 1e-11 of the largest entry (derivatives.hpp) where the torques are of
    // order one; they reach a hundred here.
    const auto by_motion = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
      return multibody::inverse_dynamics(tree, test::moved(tree, state.q, x, 1.0), state.v, acceleration,
                                         wrenches, workspace);
    };
    EXPECT_LT(test::compare_jacobian(by_motion, Eigen::VectorXd::Zero(n), derivatives.position).relative,
              1e-9);
    const auto by_velocity = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
      return multibody::inverse_dynamics(tree, state.q, x, acceleration, wrenches, workspace);
    };
    if (derivatives.velocity.cwiseAbs().maxCoeff() > 1e-12) {
      EXPECT_LT(test::compare_jacobian(by_velocity, state.v, derivatives.velocity).relative, 1e-9);
    } else {  // a lone joint, or slides only: no velocity product at all
      EXPECT_LT((by_velocity(state.v) - by_velocity(2.0 * state.v)).norm(), 1e-12);
    }
    EXPECT_LT(test::relative_difference(derivatives.mass, multibody::mass_matrix(tree, state.q, workspace)),
              1e-12);

    // With respect to the coordinates themselves, quaternions off the unit sphere included.
    Eigen::VectorXd q = state.q;
    for (const auto& body : tree.bodies()) {
      if (body.joint == multibody::JointKind::free) q.segment<4>(body.q_index + 3) *= 1.1;
    }
    const auto by_coordinates = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
      return multibody::inverse_dynamics(tree, x, state.v, acceleration, wrenches, workspace);
    };
    EXPECT_LT(test::compare_jacobian(by_coordinates, q,
                                     derivatives.position * multibody::coordinate_motion(tree, q))
                  .relative,
              1e-9);
    EXPECT_LT(test::relative_difference(
                  multibody::coordinate_motion(tree, state.q) * test::coordinate_rate(tree, state.q, state.v),
                  state.v),
              1e-14);
  }
}

}  // namespace

TEST(DynamicsDerivatives, MatchDifferencesOnTheWorld) {
  compare(test::Base::on_the_world, 21);
}
TEST(DynamicsDerivatives, MatchDifferencesOnFloatingTrees) {
  compare(test::Base::floating, 22);
}

}  // namespace snare
