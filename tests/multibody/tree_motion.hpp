#pragma once

#include "multibody/tree.hpp"

#include <Eigen/Geometry>

#include <cassert>
#include <cmath>

namespace snare::test {

/// q' = N(q) v.                                                                               theory.md (A.3)
inline Eigen::VectorXd coordinate_rate(const multibody::Tree& tree, const Eigen::VectorXd& q,
                                       const Eigen::VectorXd& v) {
  assert(q.size() == tree.coordinates() && v.size() == tree.velocities());
  Eigen::VectorXd rate(tree.coordinates());
  for (const multibody::TreeBody& body : tree.bodies()) {
    if (body.joint == multibody::JointKind::free) {
      rate.segment<7>(body.q_index) = multibody::free_coordinate_rate(body, q, v);
    } else {
      rate[body.q_index] = v[body.v_index];
    }
  }
  return rate;
}

/// The coordinates after the constant velocity v for a time; exact for each joint by itself. Quaternions come
/// out unit.
inline Eigen::VectorXd moved(const multibody::Tree& tree, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                             double time) {
  Eigen::VectorXd next = q;
  for (const multibody::TreeBody& body : tree.bodies()) {
    const int i = body.q_index, k = body.v_index;
    if (body.joint != multibody::JointKind::free) {
      next[i] += time * v[k];
      continue;
    }
    // Exponential of the twist: R = exp[theta], p = V(theta) time v with V = 1 + (1 - cos)/t^2 [theta] + (t -
    // sin)/t^3 [theta]^2.
    const Eigen::Vector3d theta = time * v.segment<3>(k), shift = time * v.segment<3>(k + 3);
    const double angle = theta.norm();
    const double s2 = std::sin(0.5 * angle);
    const double first = angle > 1e-4 ? 2.0 * s2 * s2 / (angle * angle) : 0.5 - angle * angle / 24.0;
    const double second = angle > 1e-2 ? (angle - std::sin(angle)) / (angle * angle * angle)
                                       : 1.0 / 6.0 - angle * angle / 120.0;
    const Eigen::Vector3d turned = theta.cross(shift);
    next.segment<3>(i) +=
        multibody::joint_pose(body, q).R * (shift + first * turned + second * theta.cross(turned));
    const double half = angle > 1e-8 ? s2 / angle : 0.5;
    const Eigen::Quaterniond step(std::cos(0.5 * angle), half * theta.x(), half * theta.y(),
                                  half * theta.z());
    const Eigen::Quaterniond now(q[i + 3], q[i + 4], q[i + 5], q[i + 6]);
    const Eigen::Quaterniond then = (now * step).normalized();
    next.segment<4>(i + 3) << then.w(), then.x(), then.y(), then.z();
  }
  return next;
}

/// Divides the quaternions by their norms.
inline void normalise(const multibody::Tree& tree, Eigen::VectorXd& q) {
  for (const multibody::TreeBody& body : tree.bodies()) {
    if (body.joint == multibody::JointKind::free) q.segment<4>(body.q_index + 3).normalize();
  }
}

}  // namespace snare::test
