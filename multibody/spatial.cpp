#include "multibody/spatial.hpp"

namespace snare::multibody {

SpatialInertia SpatialInertia::about_centre(double mass, const Eigen::Vector3d& centre,
                                            const Eigen::Matrix3d& inertia) {
  // Parallel axes: I_O = I_C - m [c]x [c]x.
  const Eigen::Matrix3d c = cross_matrix(centre);
  return {mass, mass * centre, inertia - mass * c * c};
}

SpatialInertia SpatialInertia::to_outer(const Pose& X_AB) const {
  // With h' = R h and the shift p: I_A = R I R^T - [p]x [h']x - [h']x [p]x - m [p]x [p]x.
  const Eigen::Vector3d h = X_AB.R * first_moment;
  const Eigen::Vector3d& p = X_AB.p;
  const Eigen::Vector3d g = h + mass * p;  // first moment about the origin of A
  // -[a]x [b]x = (a.b) 1 - b a^T, once for (p, g) and once for (h', p).
  Eigen::Matrix3d rotational_A = X_AB.R * rotational * X_AB.R.transpose();
  rotational_A -= g * p.transpose() + p * h.transpose();
  rotational_A.diagonal().array() += p.dot(g) + p.dot(h);
  return {mass, g, rotational_A};
}

Matrix6 SpatialInertia::matrix() const {
  const Eigen::Matrix3d h = cross_matrix(first_moment);
  Matrix6 m;
  m << rotational, h, h.transpose(), mass * Eigen::Matrix3d::Identity();
  return m;
}

Eigen::Vector3d SpatialInertia::centre() const {
  return mass > 0.0 ? Eigen::Vector3d(first_moment / mass) : Eigen::Vector3d::Zero();
}

Eigen::Matrix3d SpatialInertia::about_own_centre() const {
  const Eigen::Matrix3d c = cross_matrix(centre());
  return rotational + mass * c * c;
}

}  // namespace snare::multibody
