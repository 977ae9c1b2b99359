#pragma once

#include "multibody/tree.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace snare::multibody {

/// Inertia of a body as felt with everything it carries hanging loose: [I H; H^T M], Featherstone 2008, sec.
/// 7.1.
struct ArticulatedInertia {
  Eigen::Matrix3d I, H, M;
};

/// Storage of the algorithms below, made once; they allocate nothing. Each returns a reference to its result
/// in here, good until the same algorithm runs again.
struct DynamicsWorkspace {
  explicit DynamicsWorkspace(const Tree& tree);

  std::vector<Pose> X_PB;                 ///< of each body in its parent
  std::vector<Twist> V_B, A_B;            ///< velocity, acceleration less gravity, in the body's frame
  std::vector<Wrench> F_B;                ///< force through the joint
  std::vector<SpatialInertia> composite;  ///< of the body with all that it carries
  std::vector<ArticulatedInertia> articulated;
  std::vector<Twist> bias;               ///< acceleration from the joint's velocity
  std::vector<Wrench> U;                 ///< articulated inertia times the axis
  std::vector<double> D, u;              ///< inertia [kg m^2 or kg] and force [N m or N] left at the joint
  Eigen::VectorXd torque, acceleration;  ///< (nv)
  Eigen::MatrixXd mass_matrix;           ///< (nv x nv)
};

/// Wrenches on the bodies, each in its body's frame; empty for none, else one a body.
using BodyWrenches = std::span<const Wrench>;

/// Inverse dynamics by Newton and Euler's recursion (RNEA):                                   theory.md (A.5)
///   tau = H(q) v' + c(q, v) - sum J_i^T F_i            [N m, N], in the field tree.gravity.
/// q: (nq), v and acceleration: (nv). Featherstone 2008, table 5.1.
const Eigen::VectorXd& inverse_dynamics(const Tree& tree, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                        const Eigen::VectorXd& acceleration, BodyWrenches wrenches,
                                        DynamicsWorkspace& workspace);

/// Mass matrix H(q) by composite bodies (CRBA), symmetric, both triangles.    theory.md (A.6), Featherstone
/// 2008, table 6.2. (nv x nv) [kg m^2, kg m, kg]; q: (nq) [rad, m, -].
const Eigen::MatrixXd& mass_matrix(const Tree& tree, const Eigen::VectorXd& q, DynamicsWorkspace& workspace);

/// Forward dynamics by articulated bodies (ABA): v' of the given torques.     theory.md (A.7), Featherstone
/// 2008, table 7.1 A joint that carries no inertia at all has no acceleration: the result is then not finite.
/// torque: (nv) [N m, N]; result: (nv) [rad/s^2, m/s^2].
const Eigen::VectorXd& forward_dynamics(const Tree& tree, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                        const Eigen::VectorXd& torque, BodyWrenches wrenches,
                                        DynamicsWorkspace& workspace);

}  // namespace snare::multibody
