#include "multibody/arm/elastic_arm.hpp"

#include "base/index.hpp"
#include "multibody/dynamics.hpp"

#include <Eigen/Eigenvalues>

#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>

namespace snare::multibody {

namespace {

using base::at;

}  // namespace

ArmState resting(const ElasticArm& arm, const Eigen::VectorXd& q) {
  ArmState state;
  state.q = q;
  state.v = Eigen::VectorXd::Zero(arm.tree.velocities());
  state.motor.resize(arm.motors());
  state.motor_rate = Eigen::VectorXd::Zero(arm.motors());
  for (int k = 0; k < arm.motors(); ++k) state.motor[k] = q[arm.tree.body(arm.joints[at(k)].body).q_index];
  return state;
}

double deflection(const ElasticArm& arm, const ArmState& state, int joint) {
  return state.q[arm.tree.body(arm.joints[at(joint)].body).q_index] - state.motor[joint];
}

double total_energy(const ElasticArm& arm, const ArmState& state) {
  Kinematics kinematics(arm.tree);
  place(arm.tree, state.q, kinematics);
  set_moving(arm.tree, state.v, kinematics);
  double energy = kinetic_energy(arm.tree, kinematics) + potential_energy(arm.tree, kinematics);
  for (int k = 0; k < arm.motors(); ++k) {
    const ElasticJoint& joint = arm.joints[at(k)];
    const double d = deflection(arm, state, k);
    energy += 0.5 * joint.motor_inertia * state.motor_rate[k] * state.motor_rate[k];
    energy += joint.spring.energy(joint.spring.branch_of(d), d);
  }
  return energy;
}

std::vector<ArmMode> natural_modes(const ElasticArm& arm, const Eigen::VectorXd& q,
                                   const std::vector<Drive>& drives, const Eigen::VectorXd& deflections) {
  assert(static_cast<int>(drives.size()) == arm.motors());
  const int n = arm.tree.velocities(), m = arm.motors();
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n + m, n + m), K = M;
  DynamicsWorkspace workspace(arm.tree);
  M.topLeftCorner(n, n) = mass_matrix(arm.tree, q, workspace);
  std::vector<int> taking_part(at(n));
  std::iota(taking_part.begin(), taking_part.end(), 0);
  for (int k = 0; k < m; ++k) {
    const ElasticJoint& joint = arm.joints[at(k)];
    const int i = arm.tree.body(joint.body).v_index;
    const double d = deflections.size() == 0 ? 0.0 : deflections[k];
    const double stiffness = joint.spring.stiffness(joint.spring.branch_of(d));
    K(i, i) += stiffness;
    K(n + k, n + k) +=
        stiffness + (drives[at(k)].mode == DriveMode::servo ? drives[at(k)].proportional : 0.0);
    K(i, n + k) -= stiffness;
    K(n + k, i) -= stiffness;
    M(n + k, n + k) = joint.motor_inertia;
    if (!drives[at(k)].rules()) taking_part.push_back(n + k);
  }
  const Eigen::MatrixXd M_part = M(taking_part, taking_part), K_part = K(taking_part, taking_part);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(K_part, M_part);
  // Rounding leaves some 1e-16 of the largest eigenvalue in place of a zero.
  const double none = 1e-12 * std::max(solver.eigenvalues().maxCoeff(), 0.0);
  std::vector<ArmMode> modes;
  for (Eigen::Index k = 0; k < solver.eigenvalues().size(); ++k) {
    const double square = solver.eigenvalues()[k];
    ArmMode mode;
    mode.frequency = square > none ? std::sqrt(square) / (2.0 * std::numbers::pi) : 0.0;
    mode.shape = Eigen::VectorXd::Zero(n + m);
    mode.shape(taking_part) = solver.eigenvectors().col(k);
    modes.push_back(mode);
  }
  return modes;
}

}  // namespace snare::multibody
