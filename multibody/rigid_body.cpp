#include "multibody/rigid_body.hpp"

#include "multibody/spatial.hpp"

namespace snare::multibody {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector4d;

Eigen::Matrix<double, 4, 3> quaternion_rates(const Vector4d& q) {
  Eigen::Matrix<double, 4, 3> m;
  m << -q[1], -q[2], -q[3], q[0], -q[3], q[2], q[3], q[0], -q[1], -q[2], q[1], q[0];
  return 0.5 * m;
}

Matrix3d rotation(const Vector4d& q) {
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

Eigen::Matrix<double, 3, 4> rotated_by_quaternion(const Vector4d& q, const Vector3d& a) {
  // A change dq of a unit quaternion is the rotation vector 4 Q^T dq in B, Q = quaternion_rates(q); Q^T Q =
  // 1/4.
  const Matrix3d r = rotation(q);
  return -4.0 * r * cross_matrix(a) * quaternion_rates(q).transpose();
}

double kinetic_energy(const RigidBodyProperties& body, const RigidBodyState& state) {
  return 0.5 * body.mass * state.velocity.squaredNorm() + 0.5 * state.spin.dot(body.inertia * state.spin);
}

Vector3d angular_momentum(const RigidBodyProperties& body, const RigidBodyState& state) {
  const Vector3d linear = body.mass * state.velocity;
  return state.position.cross(linear) + state.orientation * Vector3d(body.inertia * state.spin);
}

}  // namespace snare::multibody
