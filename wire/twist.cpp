#include "wire/twist.hpp"

namespace snare::wire {

using Eigen::Vector3d;

// (W.26)  d2E = M d2tau + k dtau dtau^T, M: `moment`, k: `stiffness`. From dkb (see curvature.cpp) and
// d(1/|a|):
//   |a|^2 d2m/da2 = -1/2 kb (t + mean)^T - [u]_x/chi,   |b|^2 d2m/db2 = -1/2 kb (u + mean)^T + [t]_x/chi,
//   |a||b| d2m/da db = [t]_x/chi - 1/2 kb mean^T.
// Of the first two the symmetric part is taken, -1/4 (kb x^T + x kb^T) with x = t + mean or u + mean: the
// skew part belongs to the holonomy of the transport and is no second derivative.
void add_twist_hessian(const Turn& turn, const InverseLengths& inverse, double moment, double stiffness,
                       PairHessian& out) {
  const Vector3d& t = turn.before;
  const Vector3d& u = turn.after;
  const Vector3d& kb = turn.binormal;
  const double faa = inverse.a * inverse.a;
  const double fbb = inverse.b * inverse.b;
  const double fab = inverse.a * inverse.b;
  // k/4 kb kb^T - M/4 (kb x^T + x kb^T) = y kb^T + kb z^T with y = k/4 kb - M/4 x, z = -M/4 x.
  const Vector3d za = (-0.25 * moment * faa) * (t + turn.mean);
  const Vector3d ya = (0.25 * stiffness * faa) * kb + za;
  const Vector3d zb = (-0.25 * moment * fbb) * (u + turn.mean);
  const Vector3d yb = (0.25 * stiffness * fbb) * kb + zb;
  const Vector3d zab = fab * (0.25 * stiffness * kb - 0.5 * moment * turn.mean);
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      out.aa(i, j) += ya[i] * kb[j] + kb[i] * za[j];
      out.bb(i, j) += yb[i] * kb[j] + kb[i] * zb[j];
      out.ab(i, j) += kb[i] * zab[j];
    }
  }
  const Vector3d s = (moment * fab / turn.chi) * t;  // M [t]_x/chi = [s]_x
  out.ab(0, 1) -= s.z();
  out.ab(0, 2) += s.y();
  out.ab(1, 0) += s.z();
  out.ab(1, 2) -= s.x();
  out.ab(2, 0) -= s.y();
  out.ab(2, 1) += s.x();

  // k dtau/d(edge) dtau/dtheta, dtau/dtheta_- = -1, dtau/dtheta_+ = 1.
  const Vector3d by_a = (0.5 * stiffness * inverse.a) * kb;
  const Vector3d by_b = (0.5 * stiffness * inverse.b) * kb;
  out.a_theta_a -= by_a;
  out.a_theta_b += by_a;
  out.b_theta_a -= by_b;
  out.b_theta_b += by_b;
  out.theta_aa += stiffness;
  out.theta_ab -= stiffness;
  out.theta_bb += stiffness;
}

}  // namespace snare::wire
