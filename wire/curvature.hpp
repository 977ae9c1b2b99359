#pragma once

#include "numerics/lanes.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>

namespace snare::wire {

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
[[nodiscard]] TurnOf<S> turn_between(const Vector3<S>& before, const Vector3<S>& after);
[[nodiscard]] inline Turn make_turn(const Eigen::Vector3d& before, const Eigen::Vector3d& after) {
  return turn_between<double>(before, after);
}

/// First derivatives of a scalar of a vertex by the edge vectors a (before), b (after) [m] and their twist angles [rad]: each in the unit of the
/// scalar over that.
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
struct PairHessian {
  Eigen::Matrix3d aa = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d ab = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d bb = Eigen::Matrix3d::Zero();
  Eigen::Vector3d a_theta_a = Eigen::Vector3d::Zero();
  Eigen::Vector3d a_theta_b = Eigen::Vector3d::Zero();
  Eigen::Vector3d b_theta_a = Eigen::Vector3d::Zero();
  Eigen::Vector3d b_theta_b = Eigen::Vector3d::Zero();
  double theta_aa = 0.0;
  double theta_ab = 0.0;
  double theta_bb = 0.0;

  /// By one edge and its angle, in the same units.
  [[nodiscard]] Eigen::Matrix4d of_before() const {
    return (Eigen::Matrix4d() << aa, a_theta_a, a_theta_a.transpose(), theta_aa).finished();
  }
  [[nodiscard]] Eigen::Matrix4d of_after() const {
    return (Eigen::Matrix4d() << bb, b_theta_b, b_theta_b.transpose(), theta_bb).finished();
  }
};

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
void add_cosine_hessian(const Turn& turn, const InverseLengths& inverse, double first, double second, PairHessian& out);

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
[[nodiscard]] Pair<S> curvature_pair(const TurnOf<S>& turn, const DirectorsOf<S>& before, const DirectorsOf<S>& after);
[[nodiscard]] inline Eigen::Vector2d curvatures(const Turn& turn, const Directors& before, const Directors& after) {
  const Pair<double> kappa = curvature_pair(turn, before, after);
  return {kappa[0], kappa[1]};
}

/// Their rates [1/s] by those of the edges over their lengths, a'/|a| and b'/|b|, and of the angles [1/s].
template <class S>
[[nodiscard]] Pair<S> curvature_rates(const TurnOf<S>& turn, const DirectorsOf<S>& before, const DirectorsOf<S>& after,
                                      const Vector3<S>& a, const Vector3<S>& b, const S& theta_a, const S& theta_b);

/// One linear combination kappa_w = g_1 kappa_1 + g_2 kappa_2 = 1/2 (w before + w after).kb with
/// w = g_1 m2 - g_2 m1, dw/dtheta = -v, v = g_1 m1 + g_2 m2.                                 theory.md (W.25)
///
/// Derivatives at frames carried along by parallel transport in time; Bergou et al. 2010, appendix; Jawed,
/// Novelia and O'Reilly 2018, sec. 7.2, there for kappa_1 and kappa_2 one by one. The weights are constants.
template <class S>
class WeightedCurvatureOf {
 public:
  /// g_1, g_2: of any unit.
  WeightedCurvatureOf(const TurnOf<S>& turn, const DirectorsOf<S>& before, const DirectorsOf<S>& after, const S& g_1,
                      const S& g_2);

  /// kappa_w [-].
  [[nodiscard]] S value() const noexcept { return value_; }
  void add_gradient(const InverseLengthsOf<S>& inverse, PairGradientOf<S>& out) const;
  void add_hessian(const InverseLengths& inverse, PairHessian& out) const;
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
void WeightedCurvatureOf<double>::add_hessian(const InverseLengths& inverse, PairHessian& out) const;
template <>
Eigen::Vector3d WeightedCurvatureOf<double>::by_rotation() const;

/// Adds factor * g g^T.
void add_square(const PairGradient& g, double factor, PairHessian& out);

// Here, for the compiler to put in where wires in motion spend their time.

template <class S>
[[gnu::always_inline]] inline TurnOf<S> turn_between(const Vector3<S>& before, const Vector3<S>& after) {
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
[[gnu::always_inline]] inline void add_cosine_gradient(const TurnOf<S>& turn, const InverseLengthsOf<S>& inverse,
                                                       const S& first, PairGradientOf<S>& out) {
  out.a += (first * inverse.a) * (turn.after - turn.cosine * turn.before);
  out.b += (first * inverse.b) * (turn.before - turn.cosine * turn.after);
}

// (W.24)  kappa_1 = 1/2 kb.(m2_- + m2_+),   kappa_2 = -1/2 kb.(m1_- + m1_+)
template <class S>
[[gnu::always_inline]] inline Pair<S> curvature_pair(const TurnOf<S>& turn, const DirectorsOf<S>& before,
                                                     const DirectorsOf<S>& after) {
  return {0.5 * turn.binormal.dot(before.second + after.second), -0.5 * turn.binormal.dot(before.first + after.first)};
}

// (W.24) with t' = (I - t t^T) a'/|a| and likewise u', c' = t'.u + t.u', and directors that turn by theta' about t, u:
//   kb' = [2 (t' x u + t x u') - c' kb]/chi,
//   kappa_1' = 1/2 [kb'.(m2_- + m2_+) - theta_-' kb.m1_- - theta_+' kb.m1_+],
//   kappa_2' = -1/2 [kb'.(m1_- + m1_+) + theta_-' kb.m2_- + theta_+' kb.m2_+].
template <class S>
[[gnu::always_inline]] inline Pair<S> curvature_rates(const TurnOf<S>& turn, const DirectorsOf<S>& before,
                                                      const DirectorsOf<S>& after, const Vector3<S>& a,
                                                      const Vector3<S>& b, const S& theta_a, const S& theta_b) {
  const Vector3<S>& t = turn.before;
  const Vector3<S>& u = turn.after;
  const Vector3<S>& kb = turn.binormal;
  const Vector3<S> t_rate = a - t.dot(a) * t;
  const Vector3<S> u_rate = b - u.dot(b) * u;
  const S inverse = 1.0 / turn.chi;
  const Vector3<S> kb_rate =
      inverse * (2.0 * (t_rate.cross(u) + t.cross(u_rate)) - (t_rate.dot(u) + t.dot(u_rate)) * kb);
  return {0.5 * (kb_rate.dot(before.second + after.second) - kb.dot(theta_a * before.first + theta_b * after.first)),
          -0.5 * (kb_rate.dot(before.first + after.first) + kb.dot(theta_a * before.second + theta_b * after.second))};
}

// (W.25)  kappa = 1/2 kb.s with s = w_- + w_+. The carried directors change along t and u, where kb is zero,
// so that only kb changes:
//   |a| dkappa/da = A = u x s/chi - kappa mean,   |b| dkappa/db = B = -t x s/chi - kappa mean.
template <class S>
[[gnu::always_inline]] inline WeightedCurvatureOf<S>::WeightedCurvatureOf(const TurnOf<S>& turn,
                                                                          const DirectorsOf<S>& before,
                                                                          const DirectorsOf<S>& after, const S& g_1,
                                                                          const S& g_2)
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

}  // namespace snare::wire
