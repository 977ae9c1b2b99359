#include "multibody/dynamics.hpp"
#include "tests/multibody/plain_arm.hpp"
#include "tests/support/derivatives.hpp"
#include "validation/planar_arm.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace snare {

namespace {

using multibody::Drive;
using test::Base;

}  // namespace

TEST(ElasticArm, JacobianOfTheDaeMatchesDifferences) {
  const auto by_forces = multibody::BaseEquations::newton_euler,
             by_momentum = multibody::BaseEquations::momentum;
  for (const auto& [base, equations] :
       {std::pair(Base::on_the_world, by_forces), std::pair(Base::floating, by_forces),
        std::pair(Base::floating, by_momentum)}) {
    multibody::ElasticArm arm = test::chain_arm(4, base, 30.0);
    if (equations == by_forces) arm.tree.gravity = {0.3, -1.0, 2.0};
    arm.joints[0].spring = multibody::DeflectionLaw({{0.0, 5.0, 2.0}, {0.1, 30.0, 3.0}});
    arm.joints[1].spring = multibody::DeflectionLaw(
        {{0.0, 5.0, 2.0}}, multibody::StiffnessReading::continuous, multibody::DampingRate::motor);
    arm.joints[2].friction = {1.0, 2.0, 0.5, 0.3};
    // Within the ramp of a wide jump, on both rates.
    const auto reading = multibody::StiffnessReading::literal;
    arm.joints[2].spring = multibody::DeflectionLaw({{0.0, 5.0, 2.0}, {2.0, 30.0, 6.0}}, reading,
                                                    multibody::DampingRate::deflection, 1.999);
    arm.joints[1].spring = multibody::DeflectionLaw({{0.0, 5.0, 2.0}, {2.0, 30.0, 6.0}}, reading,
                                                    multibody::DampingRate::motor, 1.999);
    const int tip = arm.tree.add_fixed(arm.tree.find_frame("link3"), "tip",
                                       {Eigen::Matrix3d::Identity(), {1.0, 0.2, 0.1}});
    std::vector<Drive> drives{Drive::holding(0.2, 8.0, 3.0), Drive::limp(), Drive::limp(), Drive::locked()};
    std::vector<multibody::TimedLoad> loads{
        {tip, {{0.5, -0.3, 0.7}, {2.0, 1.0, -1.5}}, 0.0, 10.0, multibody::TimedLoad::Shape::half_sine}};
    multibody::ElasticArmPart part(arm, drives, loads, {}, equations);
    numerics::DaeSystem system({&part});
    std::mt19937 random(5);
    Eigen::VectorXd y = test::random_values(random, system.size(), 1.0),
                    rate = test::random_values(random, system.size(), 1.0);
    if (base == Base::floating) y.segment<4>(3) *= 1.3;
    const multibody::TreeBody& second = arm.tree.body(arm.joints[1].body);
    const multibody::TreeBody& third = arm.tree.body(arm.joints[2].body);
    multibody::ArmState state = part.state(y);
    state.motor[1] = state.q[second.q_index] - 1.7;
    state.motor[2] = state.q[third.q_index] + 1.6;
    part.write_state(state, y);
    part.settle(2.0, y);
    const double c = 3.7;
    const Eigen::MatrixXd analytic = numerics::dense(system.jacobian({2.0, y, rate}, c));
    const auto residual = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
      Eigen::VectorXd rows = Eigen::VectorXd::Zero(system.size());
      const Eigen::VectorXd moved_rate = rate + c * (x - y);
      system.residual({2.0, x, moved_rate}, rows);
      return rows;
    };
    const auto error = test::compare_jacobian(residual, y, analytic, 0.1);
    EXPECT_LT(error.relative, 1e-9) << error.worst;  // as in derivatives.hpp, entries up to some hundred

    // Consistent rates leave no residual.
    if (base == Base::floating) y.segment<4>(3).normalize();
    part.write_state(part.state(y), y);
    part.write_rate(2.0, y, rate);
    Eigen::VectorXd rows = Eigen::VectorXd::Zero(system.size());
    system.residual({2.0, y, rate}, rows);
    EXPECT_LT(rows.lpNorm<Eigen::Infinity>(), 1e-11);
  }
}

TEST(ElasticArm, FrequenciesOfAChainAreThoseOfTheMassMatrix) {
  // With all motors locked the squares are the eigenvalues of H^-1 K; sum and product are its trace and
  // determinant.
  const auto arm = test::chain_arm(5, Base::on_the_world, 400.0);
  Eigen::VectorXd q(5);
  q << 0.3, -0.8, 1.1, 0.4, -0.5;
  multibody::DynamicsWorkspace workspace(arm.tree);
  const Eigen::MatrixXd inverse = multibody::mass_matrix(arm.tree, q, workspace).inverse();
  double sum = 0.0, product = 1.0;
  for (const auto& mode : multibody::natural_modes(arm, q, std::vector<Drive>(5, Drive::locked()))) {
    const double square = std::pow(2.0 * EIGEN_PI * mode.frequency, 2);
    sum += square;
    product *= square;
  }
  EXPECT_NEAR(sum / (400.0 * inverse.trace()), 1.0, 1e-12);
  EXPECT_NEAR(product / (std::pow(400.0, 5) * inverse.determinant()), 1.0, 1e-10);
}

TEST(ElasticArm, UndampedEnergyStaysOverAHundredSeconds) {
  auto run =
      validation::at_rest(test::chain_arm(3, Base::on_the_world, 400.0), Drive::locked(), 100.0, 1e-11);
  run.initial.q << 0.3, -0.2, 0.25;
  run.sample = 0.5;
  const auto history = multibody::simulate(run);
  ASSERT_TRUE(history.report.usable()) << history.report.message;
  EXPECT_LT(history.energy_error, 1e-8);
  RecordProperty("energy_error", std::to_string(history.energy_error));
  RecordProperty("steps", static_cast<int>(history.statistics.steps));
}

TEST(ElasticArm, MomentumOfAFloatingArmStays) {
  auto run = validation::at_rest(test::chain_arm(3, Base::floating, 400.0), Drive::limp(), 10.0, 1e-12);
  run.initial.q.tail<3>() << 0.3, -0.2, 0.25;  // springs wound up
  run.initial.v << 0.1, -0.05, 0.2, 0.03, 0.02, -0.04, 0.5, -0.4, 0.3;
  run.sample = 0.1;
  const auto history = multibody::simulate(run);
  ASSERT_TRUE(history.report.usable()) << history.report.message;
  const auto first = history.samples.front().momentum.vector();
  double drift = 0.0;
  for (const auto& sample : history.samples) {
    const auto change = (sample.momentum.vector() - first).eval();
    drift = std::max({drift, change.head<3>().norm() / first.head<3>().norm(),
                      change.tail<3>().norm() / first.tail<3>().norm()});
  }
  EXPECT_LT(drift / 10.0, 1e-12);
  EXPECT_LT(history.energy_error, 1e-8);
  RecordProperty("drift_per_second", std::to_string(drift / 10.0));
}

TEST(ElasticArm, StiffSpringsGiveTheRigidArm) {
  // (H + B) q'' + c = tau by Runge and Kutta beside the elastic arm with ever stiffer gears: the difference
  // goes as 1/K.
  const double end = 2.0;
  const Eigen::Vector3d torque(8.0, -4.0, 3.0);
  const auto rigid = test::chain_arm(3, Base::on_the_world, 0.0);
  multibody::DynamicsWorkspace workspace(rigid.tree);
  const auto acceleration = [&](const Eigen::VectorXd& q, const Eigen::VectorXd& v) -> Eigen::VectorXd {
    Eigen::MatrixXd H = multibody::mass_matrix(rigid.tree, q, workspace);
    H.diagonal().array() += 2.0;
    const Eigen::VectorXd bias =
        multibody::inverse_dynamics(rigid.tree, q, v, Eigen::VectorXd::Zero(3), {}, workspace);
    return H.ldlt().solve(torque - bias);
  };
  Eigen::VectorXd q = Eigen::VectorXd::Zero(3), v = q;
  const double h = end / 1000;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::VectorXd a1 = acceleration(q, v), v2 = v + 0.5 * h * a1;
    const Eigen::VectorXd a2 = acceleration(q + 0.5 * h * v, v2), v3 = v + 0.5 * h * a2;
    const Eigen::VectorXd a3 = acceleration(q + 0.5 * h * v2, v3), v4 = v + h * a3;
    const Eigen::VectorXd a4 = acceleration(q + h * v3, v4);
    q += h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
    v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
  }
  std::vector<double> differences;
  for (const double stiffness : {1e4, 1e5, 1e6}) {
    auto arm = test::chain_arm(3, Base::on_the_world, stiffness);
    auto run = validation::at_rest(arm, Drive::limp(), end, 1e-9);
    for (int k = 0; k < 3;
         ++k) {  // a servo at its limit is a constant torque; a critical damper lets the gear settle
      const auto i = static_cast<std::size_t>(k);
      run.arm.joints[i].spring =
          multibody::DeflectionLaw::linear(stiffness, 2.0 * std::sqrt(2.0 * stiffness));
      run.drives[i] = Drive::holding(torque[k] > 0.0 ? 1e6 : -1e6, 1.0, 0.0, std::abs(torque[k]));
    }
    const auto history = multibody::simulate(run);
    ASSERT_TRUE(history.report.usable()) << history.report.message;
    differences.push_back((history.samples.back().state.q - q).norm());
  }
  EXPECT_LT(differences[2], 1e-4);
  EXPECT_NEAR(differences[0] / differences[1], 10.0,
              1.5);  // first order in 1/K, next order a tenth at the softest
  EXPECT_NEAR(differences[1] / differences[2], 10.0, 0.5);
}

}  // namespace snare
