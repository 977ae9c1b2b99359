#pragma once

#include "numerics/lanes.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>

namespace snare::wire {

using numerics::Matrix3;
using numerics::Vector3;

// What wires in motion work out again and again holds for a number type S: double, or four places at once.

/// How the tangent turns at a vertex, from the unit tangent t of the edge before it to u of the edge after.
///                                                           theory.md (W.22); Bergou et al. 2008, sec. 4.2.1
///   c = t.u,  chi = 1 + c,  kb = 2 t x u/chi,  mean = (t + u)/chi
/// kb is the integrated curvature binormal, of length 2 tan(phi/2) for the turning angle phi in [0, pi) [-].
template <class S>
struct TurnOf {
  Vector3<S> before;    ///< t
  Vector3<S> after;     ///< u
  Vector3<S> binormal;  ///< kb
  Vector3<S> mean;
  S cosine = 1.0;  ///< c
  S chi = 2.0;
};
using Turn = TurnOf<double>;

/// How the unit tangents before and after turn into each other. Not for tangents that are opposite: chi = 0.
template <class S>
[[nodiscard]] TurnOf<S> make_turn(const Vector3<S>& before, const Vector3<S>& after);

/// First derivatives of a scalar of a vertex by the edge vectors a (before), b (after) [m] and their twist
/// angles [rad]: each in the unit of the scalar over that.
template <class S>
struct PairGradientOf {
  Vector3<S> a = Vector3<S>::Zero();
  Vector3<S> b = Vector3<S>::Zero();
  S theta_a = 0.0;
  S theta_b = 0.0;

  /// By one edge and its angle, in the same units.
  [[nodiscard]] Eigen::Vector4d of_before() const { return {a.x(), a.y(), a.z(), theta_a}; }
  [[nodiscard]] Eigen::Vector4d of_after() const { return {b.x(), b.y(), b.z(), theta_b}; }
};
using PairGradient = PairGradientOf<double>;

/// Second derivatives of a scalar of a vertex, in their units likewise; `ab` has rows of a and columns of b.
template <class S>
struct PairHessianOf {
  Matrix3<S> aa = Matrix3<S>::Zero();
  Matrix3<S> ab = Matrix3<S>::Zero();
  Matrix3<S> bb = Matrix3<S>::Zero();
  Vector3<S> a_theta_a = Vector3<S>::Zero();
  Vector3<S> a_theta_b = Vector3<S>::Zero();
  Vector3<S> b_theta_a = Vector3<S>::Zero();
  Vector3<S> b_theta_b = Vector3<S>::Zero();
  S theta_aa = 0.0;
  S theta_ab = 0.0;
  S theta_bb = 0.0;

  /// By one edge and its angle, in the same units.
  [[nodiscard]] Eigen::Matrix4d of_before() const {
    return (Eigen::Matrix4d() << aa, a_theta_a, a_theta_a.transpose(), theta_aa).finished();
  }
  [[nodiscard]] Eigen::Matrix4d of_after() const {
    return (Eigen::Matrix4d() << bb, b_theta_b, b_theta_b.transpose(), theta_bb).finished();
  }
};
using PairHessian = PairHessianOf<double>;

/// H r by the rates of the edges and of their angles, and `factor` H added to a sum.
template <class S>
[[nodiscard]] PairGradientOf<S> product(const PairHessianOf<S>& h, const Vector3<S>& a, const Vector3<S>& b,
                                        const S& theta_a, const S& theta_b);
template <class S>
void add_scaled(const PairHessianOf<S>& h, const S& factor, PairHessianOf<S>& sum);

/// Reciprocal lengths of the two edges beside a vertex [1/m]; 0 for a mount's direction, which makes every
/// derivative by it zero.
template <class S>
struct InverseLengthsOf {
  S a = 0.0;
  S b = 0.0;
};
using InverseLengths = InverseLengthsOf<double>;

/// Adds first * gradient of c; first: of any unit.                                        theory.md (W.23)
///   dc/da = (u - c t)/|a|,  dc/db = (t - c u)/|b|
template <class S>
void add_cosine_gradient(const TurnOf<S>& turn, const InverseLengthsOf<S>& inverse, const S& first,
                         PairGradientOf<S>& out);

/// Adds first * hessian of c + second * (gradient of c)(gradient of c)^T: the Hessian of a function of c with
/// those derivatives.                                                                       theory.md (W.23)
template <class S>
void add_cosine_hessian(const TurnOf<S>& turn, const InverseLengthsOf<S>& inverse, const S& first,
                        const S& second, PairHessianOf<S>& out);

/// Material directors of an edge.
template <class S>
struct DirectorsOf {
  Vector3<S> first;   ///< m1
  Vector3<S> second;  ///< m2 = tangent x m1
};
using Directors = DirectorsOf<double>;

/// Two numbers, of the two directors.
template <class S>
using Pair = std::array<S, 2>;

/// Integrated curvatures in the mean material directors [-].   theory.md (W.24); Bergou et al. 2010, sec. 4.1
///   kappa_1 = 1/2 (m2 before + m2 after).kb,  kappa_2 = -1/2 (m1 before + m1 after).kb
/// kappa_1 > 0 bends the rod towards its director m1, kappa_2 > 0 towards m2.
template <class S>
[[nodiscard]] Pair<S> curvature_pair(const TurnOf<S>& turn, const DirectorsOf<S>& before,
                                     const DirectorsOf<S>& after);
[[nodiscard]] inline Eigen::Vector2d curvatures(const Turn& turn, const Directors& before,
                                                const Directors& after) {
  const Pair<double> kappa = curvature_pair(turn, before, after);
  return {kappa[0], kappa[1]};
}

/// Their rates [1/s] by those of the edges over their lengths, a'/|a| and b'/|b|, and of the angles [1/s].
template <class S>
[[nodiscard]] Pair<S> curvature_rates(const TurnOf<S>& turn, const DirectorsOf<S>& before,
                                      const DirectorsOf<S>& after, const Vector3<S>& a, const Vector3<S>& b,
                                      const S& theta_a, const S& theta_b);

/// One linear combination kappa_w = g_1 kappa_1 + g_2 kappa_2 = 1/2 (w before + w after).kb with
/// w = g_1 m2 - g_2 m1, dw/dtheta = -v, v = g_1 m1 + g_2 m2.                                 theory.md (W.25)
///
/// Derivatives at frames carried along by parallel transport in time; Bergou et al. 2010, appendix; Jawed,
/// Novelia and O'Reilly 2018, sec. 7.2, there for kappa_1 and kappa_2 one by one. The weights are constants.
template <class S>
class WeightedCurvatureOf {
 public:
  /// g_1, g_2: of any unit.
  WeightedCurvatureOf(const TurnOf<S>& turn, const DirectorsOf<S>& before, const DirectorsOf<S>& after,
                      const S& g_1, const S& g_2);

  /// kappa_w [-].
  [[nodiscard]] S value() const noexcept { return value_; }
  void add_gradient(const InverseLengthsOf<S>& inverse, PairGradientOf<S>& out) const;
  void add_hessian(const InverseLengthsOf<S>& inverse, PairHessianOf<S>& out) const;
  /// Derivative of kappa_w by a rigid rotation of the edge after the vertex with its frame [-].
  [[nodiscard]] Eigen::Vector3d by_rotation() const;

 private:
  const TurnOf<S>& turn_;
  Vector3<S> w_a_, w_b_;  // w of the two edges
  Vector3<S> v_a_, v_b_;  // v of the two edges
  Vector3<S> slope_a_;    // |a| d kappa_w/da
  Vector3<S> slope_b_;    // |b| d kappa_w/db
  Vector3<S> turned_a_;   // u x (w_a + w_b)/chi
  Vector3<S> turned_b_;   // t x (w_a + w_b)/chi
  S value_;
};
using WeightedCurvature = WeightedCurvatureOf<double>;
template <>
Eigen::Vector3d WeightedCurvatureOf<double>::by_rotation() const;

/// Adds factor * g g^T.
void add_square(const PairGradient& g, double factor, PairHessian& out);

// Here, for the compiler to put in where wires in motion spend their time.

template <class S>
[[gnu::always_inline]] inline TurnOf<S> make_turn(const Vector3<S>& before, const Vector3<S>& after) {
  TurnOf<S> turn;
  turn.before = before;
  turn.after = after;
  turn.cosine = before.dot(after);
  turn.chi = 1.0 + turn.cosine;
  const S inverse = 1.0 / turn.chi;
  turn.binormal = (2.0 * inverse) * before.cross(after);
  turn.mean = inverse * (before + after);
  return turn;
}

// (W.23)  f(c):   df/da = f' dc/da,   dc/da = (u - c t)/|a|,   dc/db = (t - c u)/|b|;   first = f'.
template <class S>
[[gnu::always_inline]] inline void add_cosine_gradient(const TurnOf<S>& turn,
                                                       const InverseLengthsOf<S>& inverse, const S& first,
                                                       PairGradientOf<S>& out) {
  out.a += (first * inverse.a) * (turn.after - turn.cosine * turn.before);
  out.b += (first * inverse.b) * (turn.before - turn.cosine * turn.after);
}

// (W.24)  kappa_1 = 1/2 kb.(m2_- + m2_+),   kappa_2 = -1/2 kb.(m1_- + m1_+)
template <class S>
[[gnu::always_inline]] inline Pair<S> curvature_pair(const TurnOf<S>& turn, const DirectorsOf<S>& before,
                                                     const DirectorsOf<S>& after) {
  return {0.5 * turn.binormal.dot(before.second + after.second),
          -0.5 * turn.binormal.dot(before.first + after.first)};
}

// (W.24) with t' = (I - t t^T) a'/|a| and likewise u', c' = t'.u + t.u', and directors that turn by theta'
// about t, u:
//   kb' = [2 (t' x u + t x u') - c' kb]/chi,
//   kappa_1' = 1/2 [kb'.(m2_- + m2_+) - theta_-' kb.m1_- - theta_+' kb.m1_+],
//   kappa_2' = -1/2 [kb'.(m1_- + m1_+) + theta_-' kb.m2_- + theta_+' kb.m2_+].
template <class S>
[[gnu::always_inline]] inline Pair<S> curvature_rates(const TurnOf<S>& turn, const DirectorsOf<S>& before,
                                                      const DirectorsOf<S>& after, const Vector3<S>& a,
                                                      const Vector3<S>& b, const S& theta_a,
                                                      const S& theta_b) {
  const Vector3<S>& t = turn.before;
  const Vector3<S>& u = turn.after;
  const Vector3<S>& kb = turn.binormal;
  const Vector3<S> t_rate = a - t.dot(a) * t;
  const Vector3<S> u_rate = b - u.dot(b) * u;
  const S inverse = 1.0 / turn.chi;
  const Vector3<S> kb_rate =
      inverse * (2.0 * (t_rate.cross(u) + t.cross(u_rate)) - (t_rate.dot(u) + t.dot(u_rate)) * kb);
  return {0.5 * (kb_rate.dot(before.second + after.second) -
                 kb.dot(theta_a * before.first + theta_b * after.first)),
          -0.5 * (kb_rate.dot(before.first + after.first) +
                  kb.dot(theta_a * before.second + theta_b * after.second))};
}

// (W.25)  kappa = 1/2 kb.s with s = w_- + w_+. The carried directors change along t and u, where kb is zero,
// so that only kb changes:
//   |a| dkappa/da = A = u x s/chi - kappa mean,   |b| dkappa/db = B = -t x s/chi - kappa mean.
template <class S>
[[gnu::always_inline]] inline WeightedCurvatureOf<S>::WeightedCurvatureOf(const TurnOf<S>& turn,
                                                                          const DirectorsOf<S>& before,
                                                                          const DirectorsOf<S>& after,
                                                                          const S& g_1, const S& g_2)
    : turn_(turn),
      w_a_(g_1 * before.second - g_2 * before.first),
      w_b_(g_1 * after.second - g_2 * after.first),
      v_a_(g_1 * before.first + g_2 * before.second),
      v_b_(g_1 * after.first + g_2 * after.second) {
  const Vector3<S> sum = w_a_ + w_b_;
  const S inverse_chi = 1.0 / turn.chi;
  value_ = 0.5 * turn.binormal.dot(sum);
  turned_a_ = inverse_chi * turn.after.cross(sum);
  turned_b_ = inverse_chi * turn.before.cross(sum);
  slope_a_ = turned_a_ - value_ * turn.mean;
  slope_b_ = -1.0 * turned_b_ - value_ * turn.mean;
}

// By the angles dw/dtheta = -v:   dkappa/dtheta = -1/2 kb.v.
template <class S>
[[gnu::always_inline]] inline void WeightedCurvatureOf<S>::add_gradient(const InverseLengthsOf<S>& inverse,
                                                                        PairGradientOf<S>& out) const {
  out.a += inverse.a * slope_a_;
  out.b += inverse.b * slope_b_;
  out.theta_a -= 0.5 * turn_.binormal.dot(v_a_);
  out.theta_b -= 0.5 * turn_.binormal.dot(v_b_);
}

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
template <class S>
[[gnu::always_inline]] inline void add_cosine_hessian(const TurnOf<S>& turn,
                                                      const InverseLengthsOf<S>& inverse, const S& first,
                                                      const S& second, PairHessianOf<S>& out) {
  // Every block is written as a sum of columns times (t, p)^T or (u, r)^T and a multiple of I.
  const S c = turn.cosine;
  const Vector3<S>& t = turn.before;
  const Vector3<S>& u = turn.after;
  const Vector3<S> p = u - c * t;
  const Vector3<S> r = t - c * u;
  const S faa = inverse.a * inverse.a;
  const S fbb = inverse.b * inverse.b;
  const S fab = inverse.a * inverse.b;
  const Vector3<S> aa_t = faa * first * (c * t - p);
  const Vector3<S> aa_p = faa * (second * p - first * t);
  const Vector3<S> bb_u = fbb * first * (c * u - r);
  const Vector3<S> bb_r = fbb * (second * r - first * u);
  const Vector3<S> ab_t = -fab * first * t;
  const Vector3<S> ab_u = fab * first * (c * t - u);
  const Vector3<S> ab_r = fab * second * p;
  const S ia = -faa * first * c;
  const S ib = -fbb * first * c;
  const S iab = fab * first;
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
// where of kb w^T the symmetric part is taken. By an edge and an angle (v of the angle's edge), and by
// angles:
//   |a| d2kappa/da dtheta = 1/2 (kb.v) mean - u x v/chi,   |b| d2kappa/db dtheta = 1/2 (kb.v) mean + t x
//     v/chi,
//   d2kappa/dtheta^2 = -1/2 kb.w,   d2kappa/dtheta_- dtheta_+ = 0.
// In the code A = turned_a - kappa mean and B = -turned_b - kappa mean are put in.
template <class S>
[[gnu::always_inline]] inline void WeightedCurvatureOf<S>::add_hessian(const InverseLengthsOf<S>& inverse,
                                                                       PairHessianOf<S>& out) const {
  const Vector3<S>& t = turn_.before;
  const Vector3<S>& u = turn_.after;
  const Vector3<S>& kb = turn_.binormal;
  const Vector3<S>& mean = turn_.mean;
  const S inverse_chi = 1.0 / turn_.chi;
  const S share = value_ * inverse_chi;  // kappa/chi
  const S faa = inverse.a * inverse.a;
  const S fbb = inverse.b * inverse.b;
  const S fab = inverse.a * inverse.b;
  // The frames of one edge are carried with it; they add 1/4 (kb w^T + w kb^T), the symmetric part of their
  // second variation: the skew part belongs to the holonomy of the transport and is no second derivative.
  // Every block is a sum of columns times mean^T, t^T or u^T, kb^T and w^T.
  const Vector3<S> aa_mean = value_ * mean - turned_a_;
  const Vector3<S> bb_mean = value_ * mean + turned_b_;
  const Vector3<S> ab_mean = 2.0 * value_ * mean - turned_a_;
  const Vector3<S> quarter = 0.25 * kb;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      out.aa(i, j) += faa * (aa_mean[i] * mean[j] + mean[i] * aa_mean[j] + share * t[i] * t[j] +
                             quarter[i] * w_a_[j] + w_a_[i] * quarter[j]);
      out.bb(i, j) += fbb * (bb_mean[i] * mean[j] + mean[i] * bb_mean[j] + share * u[i] * u[j] +
                             quarter[i] * w_b_[j] + w_b_[i] * quarter[j]);
      out.ab(i, j) += fab * (ab_mean[i] * mean[j] + mean[i] * turned_b_[j] - share * t[i] * u[j]);
    }
    out.aa(j, j) -= faa * share;
    out.bb(j, j) -= fbb * share;
    out.ab(j, j) -= fab * share;
  }
  const Vector3<S> s = (fab * inverse_chi) * (w_a_ + w_b_);  // less [s]_x/chi
  out.ab(0, 1) += s[2];
  out.ab(0, 2) -= s[1];
  out.ab(1, 0) -= s[2];
  out.ab(1, 2) += s[0];
  out.ab(2, 0) += s[1];
  out.ab(2, 1) -= s[0];

  // d/da and d/db of d kappa_w/dtheta = -1/2 kb.v
  const S along_a = 0.5 * kb.dot(v_a_);
  const S along_b = 0.5 * kb.dot(v_b_);
  out.a_theta_a += inverse.a * (along_a * mean - inverse_chi * u.cross(v_a_));
  out.a_theta_b += inverse.a * (along_b * mean - inverse_chi * u.cross(v_b_));
  out.b_theta_a += inverse.b * (along_a * mean + inverse_chi * t.cross(v_a_));
  out.b_theta_b += inverse.b * (along_b * mean + inverse_chi * t.cross(v_b_));
  out.theta_aa -= 0.5 * kb.dot(w_a_);
  out.theta_bb -= 0.5 * kb.dot(w_b_);
}

template <class S>
[[gnu::always_inline]] inline PairGradientOf<S> product(const PairHessianOf<S>& h, const Vector3<S>& a,
                                                        const Vector3<S>& b, const S& theta_a,
                                                        const S& theta_b) {
  using numerics::times;
  using numerics::transposed_times;
  PairGradientOf<S> g;
  g.a = times(h.aa, a) + times(h.ab, b) + theta_a * h.a_theta_a + theta_b * h.a_theta_b;
  g.b = transposed_times(h.ab, a) + times(h.bb, b) + theta_a * h.b_theta_a + theta_b * h.b_theta_b;
  g.theta_a = h.a_theta_a.dot(a) + h.b_theta_a.dot(b) + h.theta_aa * theta_a + h.theta_ab * theta_b;
  g.theta_b = h.a_theta_b.dot(a) + h.b_theta_b.dot(b) + h.theta_ab * theta_a + h.theta_bb * theta_b;
  return g;
}

template <class S>
[[gnu::always_inline]] inline void add_scaled(const PairHessianOf<S>& h, const S& factor,
                                              PairHessianOf<S>& sum) {
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      sum.aa(i, j) += factor * h.aa(i, j);
      sum.ab(i, j) += factor * h.ab(i, j);
      sum.bb(i, j) += factor * h.bb(i, j);
    }
  }
  sum.a_theta_a += factor * h.a_theta_a;
  sum.a_theta_b += factor * h.a_theta_b;
  sum.b_theta_a += factor * h.b_theta_a;
  sum.b_theta_b += factor * h.b_theta_b;
  sum.theta_aa += factor * h.theta_aa;
  sum.theta_ab += factor * h.theta_ab;
  sum.theta_bb += factor * h.theta_bb;
}

}  // namespace snare::wire
