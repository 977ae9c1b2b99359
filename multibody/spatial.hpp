#pragma once

#include "numerics/cross_matrix.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace snare::multibody {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

using numerics::cross_matrix;

/// Spatial motion: angular velocity and the velocity of the body's point that is at the origin.
///                                                                                            theory.md (A.1)
/// Velocities [rad/s, m/s], accelerations [rad/s^2, m/s^2] or joint axes [rad, m per unit of the coordinate].
/// A spatial acceleration is the rate of the spatial velocity: its linear part is p'' - w x p', Featherstone
/// 2008, sec. 2.11.
struct Twist {
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();

  Twist& operator+=(const Twist& o) {
    angular += o.angular;
    linear += o.linear;
    return *this;
  }
  /// Angular over linear part, (6), in the units of the parts.
  [[nodiscard]] Vector6 vector() const { return (Vector6() << angular, linear).finished(); }
};

/// Spatial force: moment about the origin [N m] and force [N]; also momentum [N m s, N s].
struct Wrench {
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  Eigen::Vector3d force = Eigen::Vector3d::Zero();

  Wrench& operator+=(const Wrench& o) {
    moment += o.moment;
    force += o.force;
    return *this;
  }
  Wrench& operator-=(const Wrench& o) {
    moment -= o.moment;
    force -= o.force;
    return *this;
  }
  /// Moment over force, (6) [N m, N].
  [[nodiscard]] Vector6 vector() const { return (Vector6() << moment, force).finished(); }
};

[[nodiscard]] inline Twist operator+(Twist a, const Twist& b) {
  return a += b;
}
[[nodiscard]] inline Twist operator*(double s, const Twist& a) {
  return {s * a.angular, s * a.linear};
}
[[nodiscard]] inline Wrench operator+(Wrench a, const Wrench& b) {
  return a += b;
}
[[nodiscard]] inline Wrench operator-(Wrench a, const Wrench& b) {
  return a -= b;
}

/// Power of a wrench in a motion [W].
[[nodiscard]] inline double dot(const Twist& v, const Wrench& f) {
  return v.angular.dot(f.moment) + v.linear.dot(f.force);
}
/// v x m: rate of a motion m that is carried along with v.
[[nodiscard]] inline Twist cross(const Twist& v, const Twist& m) {
  return {v.angular.cross(m.angular), v.angular.cross(m.linear) + v.linear.cross(m.angular)};
}
/// v x* f: rate of a wrench f that is carried along with v.
[[nodiscard]] inline Wrench cross(const Twist& v, const Wrench& f) {
  return {v.angular.cross(f.moment) + v.linear.cross(f.force), v.angular.cross(f.force)};
}

/// Pose of frame B in frame A, X_AB: a point's coordinates go p_A = R p_B + p.
struct Pose {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();  ///< R_AB, a rotation
  Eigen::Vector3d p = Eigen::Vector3d::Zero();      ///< p_AB, origin of B in A [m]

  /// The same motion seen from B: components in B, about B's origin.
  [[nodiscard]] Twist to_inner(const Twist& v_A) const {
    return {R.transpose() * v_A.angular, R.transpose() * (v_A.linear + v_A.angular.cross(p))};
  }
  [[nodiscard]] Twist to_outer(const Twist& v_B) const {
    const Eigen::Vector3d w = R * v_B.angular;
    return {w, R * v_B.linear + p.cross(w)};
  }
  [[nodiscard]] Wrench to_outer(const Wrench& f_B) const {
    const Eigen::Vector3d f = R * f_B.force;
    return {R * f_B.moment + p.cross(f), f};
  }
  [[nodiscard]] Pose inverse() const { return {R.transpose(), -(R.transpose() * p)}; }
};

/// X_AC = X_AB X_BC.
[[nodiscard]] inline Pose operator*(const Pose& X_AB, const Pose& X_BC) {
  return {X_AB.R * X_BC.R, X_AB.R * X_BC.p + X_AB.p};
}

/// Mass, first moment and moments of inertia of a rigid body about the origin of a frame.     theory.md (A.2)
struct SpatialInertia {
  double mass = 0.0;                                       ///< [kg]
  Eigen::Vector3d first_moment = Eigen::Vector3d::Zero();  ///< mass times centre of mass [kg m]
  Eigen::Matrix3d rotational = Eigen::Matrix3d::Zero();    ///< about the origin, symmetric [kg m^2]

  /// From the centre of mass in the frame [m] and the inertia about it, in the frame's axes [kg m^2].
  [[nodiscard]] static SpatialInertia about_centre(double mass, const Eigen::Vector3d& centre,
                                                   const Eigen::Matrix3d& inertia);
  /// Momentum of the motion v, or the wrench that gives the acceleration v at rest.
  [[nodiscard]] Wrench operator*(const Twist& v) const {
    return {rotational * v.angular + first_moment.cross(v.linear),
            mass * v.linear - first_moment.cross(v.angular)};
  }
  /// The same body seen from A, this being seen from B.
  [[nodiscard]] SpatialInertia to_outer(const Pose& X_AB) const;
  /// As a matrix on a motion, angular over linear, (6 x 6) [kg m^2, kg m, kg].
  [[nodiscard]] Matrix6 matrix() const;
  /// Centre of mass in the frame [m]; the origin for a massless body.
  [[nodiscard]] Eigen::Vector3d centre() const;
  /// Moments of inertia about the centre of mass, in the frame's axes [kg m^2].
  [[nodiscard]] Eigen::Matrix3d about_own_centre() const;

  SpatialInertia& operator+=(const SpatialInertia& o) {
    mass += o.mass;
    first_moment += o.first_moment;
    rotational += o.rotational;
    return *this;
  }
};

}  // namespace snare::multibody
