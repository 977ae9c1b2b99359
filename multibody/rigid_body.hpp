#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace snare::multibody {

/// Constants of a rigid body, in its own frame B at its centre of mass.
struct RigidBodyProperties {
  double mass = 1.0;  ///< [kg], > 0
  Eigen::Matrix3d inertia =
      Eigen::Matrix3d::Identity();  ///< about the centre of mass [kg m^2], positive definite
};

/// Where a body is and how it moves, in the world frame W.
struct RigidBodyState {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();               ///< p_WB of the centre of mass [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< R_WB; unit
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();               ///< of the centre of mass [m/s]
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();                   ///< angular velocity in B [rad/s]
};

/// The first Piola form of the quaternion's rate: q' = 1/2 q (0, w) as a matrix on w, (4 x 3) [-]; q in the
/// order w, x, y, z.
///                                                                                            theory.md (M.5)
[[nodiscard]] Eigen::Matrix<double, 4, 3> quaternion_rates(const Eigen::Vector4d& q);

/// The rotation matrix of a quaternion that need not be of unit length, R(q) = rotation of q/|q|.
[[nodiscard]] Eigen::Matrix3d rotation(const Eigen::Vector4d& q);

/// Derivative of R(q) a by q for a fixed a, of unit or nearly unit q; in the unit of a.
[[nodiscard]] Eigen::Matrix<double, 3, 4> rotated_by_quaternion(const Eigen::Vector4d& q,
                                                                const Eigen::Vector3d& a);

/// Kinetic energy [J], and angular momentum about the world's origin [kg m^2/s].
[[nodiscard]] double kinetic_energy(const RigidBodyProperties& body, const RigidBodyState& state);
[[nodiscard]] Eigen::Vector3d angular_momentum(const RigidBodyProperties& body, const RigidBodyState& state);

}  // namespace snare::multibody
