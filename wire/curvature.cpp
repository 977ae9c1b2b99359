#include "wire/curvature.hpp"

#include "numerics/cross_matrix.hpp"

#include <Eigen/Geometry>

namespace snare::wire {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// x y^T + y x^T
Matrix3d symmetric_product(const Vector3d& x, const Vector3d& y) {
  const Matrix3d m = x * y.transpose();
  return m + m.transpose();
}

}  // namespace

// Everything below follows from two facts. With t = a/|a|, u = b/|b|:
//   dt = (I - t t^T) da/|a|,   du = (I - u u^T) db/|b|;
// a director w perpendicular to t that is carried along (W.20) changes by dw = -(w.dt) t, likewise one of u.
// Hence for c = t.u, chi = 1 + c, kb = 2 t x u/chi, mean = (t + u)/chi:
//   |a| dc/da = u - c t,           |b| dc/db = t - c u,
//   |a| dkb/da = -2/chi [u]_x - kb mean^T,   |b| dkb/db = 2/chi [t]_x - kb mean^T,
//   |a| dmean/da = (I - t t^T)/chi - mean (u - c t)^T/chi,   likewise by b.

// (W.23)  d2f = f' d2c + f'' dc dc^T;   first = f', second = f''. With p = u - c t, r = t - c u:
//   |a|^2 d2c/da2 = -(t p^T + p t^T) - c (I - t t^T),   |b|^2 d2c/db2 = -(u r^T + r u^T) - c (I - u u^T),
//   |a||b| d2c/da db = (I - t t^T)(I - u u^T) = I - t t^T - u u^T + c t u^T.
void add_cosine_hessian(const Turn& turn, const InverseLengths& inverse, double first, double second,
                        PairHessian& out) {
  // Every block is written as a sum of columns times (t, p)^T or (u, r)^T and a multiple of I.
  const double c = turn.cosine;
  const Vector3d& t = turn.before;
  const Vector3d& u = turn.after;
  const Vector3d p = u - c * t;
  const Vector3d r = t - c * u;
  const double faa = inverse.a * inverse.a;
  const double fbb = inverse.b * inverse.b;
  const double fab = inverse.a * inverse.b;
  const Vector3d aa_t = faa * first * (c * t - p);
  const Vector3d aa_p = faa * (second * p - first * t);
  const Vector3d bb_u = fbb * first * (c * u - r);
  const Vector3d bb_r = fbb * (second * r - first * u);
  const Vector3d ab_t = -fab * first * t;
  const Vector3d ab_u = fab * first * (c * t - u);
  const Vector3d ab_r = fab * second * p;
  const double ia = -faa * first * c;
  const double ib = -fbb * first * c;
  const double iab = fab * first;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      out.aa(i, j) += aa_t[i] * t[j] + aa_p[i] * p[j];
      out.bb(i, j) += bb_u[i] * u[j] + bb_r[i] * r[j];
      out.ab(i, j) += ab_t[i] * t[j] + ab_u[i] * u[j] + ab_r[i] * r[j];
    }
    out.aa(j, j) += ia;
    out.bb(j, j) += ib;
    out.ab(j, j) += iab;
  }
}

// (W.25)  Second derivatives. A changes with chi, kappa, mean, with s through dw_- = -(w_-.dt) t, for which
// u x t = -chi/2 kb, and A/|a| with |a|:
//   |a|^2 d2kappa/da2 = -(A mean^T + mean A^T) - kappa/chi (I - t t^T) + 1/2 kb w_-^T,
//   |b|^2 d2kappa/db2 = -(B mean^T + mean B^T) - kappa/chi (I - u u^T) + 1/2 kb w_+^T,
//   |a||b| d2kappa/da db = -A mean^T - mean B^T - kappa/chi (I + t u^T) - [s]_x/chi,
// where of kb w^T the symmetric part is taken. By an edge and an angle (v of the angle's edge), and by angles:
//   |a| d2kappa/da dtheta = 1/2 (kb.v) mean - u x v/chi,   |b| d2kappa/db dtheta = 1/2 (kb.v) mean + t x
//     v/chi,
//   d2kappa/dtheta^2 = -1/2 kb.w,   d2kappa/dtheta_- dtheta_+ = 0.
// In the code A = turned_a - kappa mean and B = -turned_b - kappa mean are put in.
template <>
void WeightedCurvatureOf<double>::add_hessian(const InverseLengths& inverse, PairHessian& out) const {
  const Vector3d& t = turn_.before;
  const Vector3d& u = turn_.after;
  const Vector3d& kb = turn_.binormal;
  const Vector3d& mean = turn_.mean;
  const double inverse_chi = 1.0 / turn_.chi;
  const double share = value_ * inverse_chi;  // kappa/chi
  // The frames of one edge are carried with it; they add 1/4 (kb w^T + w kb^T), the symmetric part of their
  // second variation: the skew part belongs to the holonomy of the transport and is no second derivative.
  const Matrix3d aa = 2.0 * value_ * mean * mean.transpose() - symmetric_product(turned_a_, mean) +
                      share * t * t.transpose() + 0.25 * symmetric_product(kb, w_a_);
  const Matrix3d bb = 2.0 * value_ * mean * mean.transpose() + symmetric_product(turned_b_, mean) +
                      share * u * u.transpose() + 0.25 * symmetric_product(kb, w_b_);
  const Matrix3d ab = 2.0 * value_ * mean * mean.transpose() - turned_a_ * mean.transpose() +
                      mean * turned_b_.transpose() - share * t * u.transpose() -
                      numerics::cross_matrix(inverse_chi * (w_a_ + w_b_));
  const Matrix3d diagonal = share * Matrix3d::Identity();
  out.aa += (inverse.a * inverse.a) * (aa - diagonal);
  out.bb += (inverse.b * inverse.b) * (bb - diagonal);
  out.ab += (inverse.a * inverse.b) * (ab - diagonal);

  // d/da and d/db of d kappa_w/dtheta = -1/2 kb.v
  const double along_a = 0.5 * kb.dot(v_a_);
  const double along_b = 0.5 * kb.dot(v_b_);
  out.a_theta_a += inverse.a * (along_a * mean - inverse_chi * u.cross(v_a_));
  out.a_theta_b += inverse.a * (along_b * mean - inverse_chi * u.cross(v_b_));
  out.b_theta_a += inverse.b * (along_a * mean + inverse_chi * t.cross(v_a_));
  out.b_theta_b += inverse.b * (along_b * mean + inverse_chi * t.cross(v_b_));
  out.theta_aa -= 0.5 * kb.dot(w_a_);
  out.theta_bb -= 0.5 * kb.dot(w_b_);
}

template <>
Vector3d WeightedCurvatureOf<double>::by_rotation() const {
  // u and w_+ turn by omega: dkb = 2 t x (omega x u)/chi - kb t.(omega x u)/chi, dw_+ = omega x w_+.
  const Vector3d half_sum = 0.5 * (w_a_ + w_b_);
  return 0.5 * w_b_.cross(turn_.binormal) + (2.0 / turn_.chi) * turn_.after.cross(half_sum.cross(turn_.before)) +
         0.5 * value_ * turn_.binormal;
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
