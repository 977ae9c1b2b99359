#include "wire/curvature.hpp"

#include <Eigen/Geometry>

namespace snare::wire {

using Eigen::Vector3d;

template <>
Vector3d WeightedCurvatureOf<double>::by_rotation() const {
  // u and w_+ turn by omega: dkb = 2 t x (omega x u)/chi - kb t.(omega x u)/chi, dw_+ = omega x w_+.
  const Vector3d half_sum = 0.5 * (w_a_ + w_b_);
  return 0.5 * w_b_.cross(turn_.binormal) +
         (2.0 / turn_.chi) * turn_.after.cross(half_sum.cross(turn_.before)) + 0.5 * value_ * turn_.binormal;
}

// d2(f^2/2) = df df^T + f d2f: the first term, times `factor`.
void add_square(const PairGradient& g, double factor, PairHessian& out) {
  const Vector3d a = factor * g.a;
  const Vector3d b = factor * g.b;
  out.aa += a * g.a.transpose();
  out.ab += a * g.b.transpose();
  out.bb += b * g.b.transpose();
  out.a_theta_a += g.theta_a * a;
  out.a_theta_b += g.theta_b * a;
  out.b_theta_a += g.theta_a * b;
  out.b_theta_b += g.theta_b * b;
  out.theta_aa += factor * g.theta_a * g.theta_a;
  out.theta_ab += factor * g.theta_a * g.theta_b;
  out.theta_bb += factor * g.theta_b * g.theta_b;
}

}  // namespace snare::wire
