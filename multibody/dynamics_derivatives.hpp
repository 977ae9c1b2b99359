#pragma once

#include "multibody/dynamics.hpp"
#include "multibody/kinematics.hpp"

#include <Eigen/Core>

#include <vector>

namespace snare::multibody {

/// Derivatives of the inverse dynamics, and storage for them that is made once.
struct InverseDynamicsDerivatives {
  explicit InverseDynamicsDerivatives(const Tree& tree);

  /// d tau / d(motion of the coordinates), (nv x nv): along velocities: joints turn and shift in their
  /// own frames
  Eigen::MatrixXd position;
  Eigen::MatrixXd velocity;  ///< d tau / d v, (nv x nv)
  Eigen::MatrixXd mass;      ///< d tau / d v' = H(q), (nv x nv)

  Kinematics kinematics;
  std::vector<Twist> V_W, A_W;            ///< of the bodies, in the world
  std::vector<SpatialInertia> inertia_W;  ///< of the bodies with what they carry, in the world
  std::vector<Matrix6> quadratic_W;       ///< 2 B: of the velocities' part, likewise
  std::vector<Wrench> wrench_W;           ///< through the joints
};

/// Derivatives of `inverse_dynamics` with wrenches that move with their bodies.               theory.md (A.8)
/// Agrees with Singh, Wensing and Echeandia 2022 for joints of one axis; the free joint is derived in
/// theory.md.
/// q: (nq), v and acceleration: (nv), results in SI units.
const InverseDynamicsDerivatives& differentiate_inverse_dynamics(const Tree& tree, const Eigen::VectorXd& q,
                                                                 const Eigen::VectorXd& v,
                                                                 const Eigen::VectorXd& acceleration,
                                                                 BodyWrenches wrenches,
                                                                 InverseDynamicsDerivatives& derivatives);

/// Derivatives of the momentum about the world's origin, in its axes (angular over linear), (6 x nv).
///                                                                                            theory.md (A.8)
struct MomentumDerivatives {
  /// Along velocities: joints turn and shift in their own frames.
  Eigen::Matrix<double, 6, Eigen::Dynamic> position;
  Eigen::Matrix<double, 6, Eigen::Dynamic> velocity;
};
/// From what `differentiate_inverse_dynamics` left in its storage.
[[nodiscard]] MomentumDerivatives differentiate_momentum(const Tree& tree,
                                                         const InverseDynamicsDerivatives& derivatives);

/// Motion of the coordinates as the velocities count it, for a change of the coordinates: (nv x nq), the left
/// inverse of
/// N(q) in q' = N(q) v. The derivative with respect to q itself is `position` times this.
/// Entries [-], of a free joint's turn by its quaternion [rad].
[[nodiscard]] Eigen::MatrixXd coordinate_motion(const Tree& tree, const Eigen::VectorXd& q);
/// The block of one body on a free joint, rows turn [rad] and shift [m], columns place and quaternion.
[[nodiscard]] Eigen::Matrix<double, 6, 7> free_coordinate_motion(const TreeBody& body,
                                                                 const Eigen::VectorXd& q);

/// Derivatives of `free_coordinate_rate`, rows p' [m/s] and quat' [1/s].
struct FreeRateDerivatives {
  Eigen::Matrix<double, 7, 7> by_coordinates;
  Eigen::Matrix<double, 7, 6> by_velocities;
};
[[nodiscard]] FreeRateDerivatives differentiate_free_coordinate_rate(const TreeBody& body,
                                                                     const Eigen::VectorXd& q,
                                                                     const Eigen::VectorXd& v);

}  // namespace snare::multibody
