#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace snare::wire {

/// How the tangent turns at a vertex, from the unit tangent t of the edge before it to u of the edge after.
///                                                           theory.md (W.22); Bergou et al. 2008, sec. 4.2.1
///   c = t.u,  chi = 1 + c,  kb = 2 t x u/chi,  mean = (t + u)/chi
/// kb is the integrated curvature binormal, of length 2 tan(phi/2) for the turning angle phi in [0, pi) [-].
struct Turn {
  Eigen::Vector3d before;    ///< t
  Eigen::Vector3d after;     ///< u
  Eigen::Vector3d binormal;  ///< kb
  Eigen::Vector3d mean;
  double cosine = 1.0;  ///< c
  double chi = 2.0;
};

/// How the unit tangents before and after turn into each other. Not for tangents that are opposite: chi = 0.
[[nodiscard]] Turn make_turn(const Eigen::Vector3d& before, const Eigen::Vector3d& after);

/// First derivatives of a scalar of a vertex by the edge vectors a (before), b (after) [m] and their twist angles [rad]: each in the unit of the
/// scalar over that.
struct PairGradient {
  Eigen::Vector3d a = Eigen::Vector3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double theta_a = 0.0;
  double theta_b = 0.0;

  /// By one edge and its angle, in the same units.
  [[nodiscard]] Eigen::Vector4d of_before() const { return {a.x(), a.y(), a.z(), theta_a}; }
  [[nodiscard]] Eigen::Vector4d of_after() const { return {b.x(), b.y(), b.z(), theta_b}; }
};

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
struct InverseLengths {
  double a = 0.0;
  double b = 0.0;
};

/// Adds first * gradient of c; first: of any unit.                                        theory.md (W.23)
///   dc/da = (u - c t)/|a|,  dc/db = (t - c u)/|b|
void add_cosine_gradient(const Turn& turn, const InverseLengths& inverse, double first, PairGradient& out);

/// Adds first * hessian of c + second * (gradient of c)(gradient of c)^T: the Hessian of a function of c with
/// those derivatives.                                                                       theory.md (W.23)
void add_cosine_hessian(const Turn& turn, const InverseLengths& inverse, double first, double second, PairHessian& out);

/// Material directors of an edge.
struct Directors {
  Eigen::Vector3d first;   ///< m1
  Eigen::Vector3d second;  ///< m2 = tangent x m1
};

/// Integrated curvatures in the mean material directors [-].   theory.md (W.24); Bergou et al. 2010, sec. 4.1
///   kappa_1 = 1/2 (m2 before + m2 after).kb,  kappa_2 = -1/2 (m1 before + m1 after).kb
/// kappa_1 > 0 bends the rod towards its director m1, kappa_2 > 0 towards m2.
[[nodiscard]] Eigen::Vector2d curvatures(const Turn& turn, const Directors& before, const Directors& after);

/// One linear combination kappa_w = g_1 kappa_1 + g_2 kappa_2 = 1/2 (w before + w after).kb with
/// w = g_1 m2 - g_2 m1, dw/dtheta = -v, v = g_1 m1 + g_2 m2.                                 theory.md (W.25)
///
/// Derivatives at frames carried along by parallel transport in time; Bergou et al. 2010, appendix; Jawed,
/// Novelia and O'Reilly 2018, sec. 7.2, there for kappa_1 and kappa_2 one by one. The weights are constants.
class WeightedCurvature {
 public:
  /// weights: g_1, g_2, of any unit.
  WeightedCurvature(const Turn& turn, const Directors& before, const Directors& after, const Eigen::Vector2d& weights);

  /// kappa_w [-].
  [[nodiscard]] double value() const noexcept { return value_; }
  void add_gradient(const InverseLengths& inverse, PairGradient& out) const;
  void add_hessian(const InverseLengths& inverse, PairHessian& out) const;
  /// Derivative of kappa_w by a rigid rotation of the edge after the vertex with its frame [-].
  [[nodiscard]] Eigen::Vector3d by_rotation() const;

 private:
  const Turn& turn_;
  Eigen::Vector3d w_a_, w_b_;  // w of the two edges
  Eigen::Vector3d v_a_, v_b_;  // v of the two edges
  Eigen::Vector3d slope_a_;    // |a| d kappa_w/da
  Eigen::Vector3d slope_b_;    // |b| d kappa_w/db
  Eigen::Vector3d turned_a_;   // u x (w_a + w_b)/chi
  Eigen::Vector3d turned_b_;   // t x (w_a + w_b)/chi
  double value_;
};

/// Adds factor * g g^T.
void add_square(const PairGradient& g, double factor, PairHessian& out);

// Here, for the compiler to put in where wires in motion spend their time.

inline Turn make_turn(const Eigen::Vector3d& before, const Eigen::Vector3d& after) {
  Turn turn;
  turn.before = before;
  turn.after = after;
  turn.cosine = before.dot(after);
  turn.chi = 1.0 + turn.cosine;
  const double inverse = 1.0 / turn.chi;
  turn.binormal = (2.0 * inverse) * before.cross(after);
  turn.mean = inverse * (before + after);
  return turn;
}

// (W.23)  f(c):   df/da = f' dc/da,   dc/da = (u - c t)/|a|,   dc/db = (t - c u)/|b|;   first = f'.
inline void add_cosine_gradient(const Turn& turn, const InverseLengths& inverse, double first, PairGradient& out) {
  out.a += (first * inverse.a) * (turn.after - turn.cosine * turn.before);
  out.b += (first * inverse.b) * (turn.before - turn.cosine * turn.after);
}

// (W.24)  kappa_1 = 1/2 kb.(m2_- + m2_+),   kappa_2 = -1/2 kb.(m1_- + m1_+)
inline Eigen::Vector2d curvatures(const Turn& turn, const Directors& before, const Directors& after) {
  return {0.5 * turn.binormal.dot(before.second + after.second), -0.5 * turn.binormal.dot(before.first + after.first)};
}

// (W.25)  kappa = 1/2 kb.s with s = w_- + w_+. The carried directors change along t and u, where kb is zero,
// so that only kb changes:
//   |a| dkappa/da = A = u x s/chi - kappa mean,   |b| dkappa/db = B = -t x s/chi - kappa mean.
inline WeightedCurvature::WeightedCurvature(const Turn& turn, const Directors& before, const Directors& after,
                                            const Eigen::Vector2d& weights)
    : turn_(turn),
      w_a_(weights[0] * before.second - weights[1] * before.first),
      w_b_(weights[0] * after.second - weights[1] * after.first),
      v_a_(weights[0] * before.first + weights[1] * before.second),
      v_b_(weights[0] * after.first + weights[1] * after.second) {
  const Eigen::Vector3d sum = w_a_ + w_b_;
  const double inverse_chi = 1.0 / turn.chi;
  value_ = 0.5 * turn.binormal.dot(sum);
  turned_a_ = inverse_chi * turn.after.cross(sum);
  turned_b_ = inverse_chi * turn.before.cross(sum);
  slope_a_ = turned_a_ - value_ * turn.mean;
  slope_b_ = -turned_b_ - value_ * turn.mean;
}

// By the angles dw/dtheta = -v:   dkappa/dtheta = -1/2 kb.v.
inline void WeightedCurvature::add_gradient(const InverseLengths& inverse, PairGradient& out) const {
  out.a += inverse.a * slope_a_;
  out.b += inverse.b * slope_b_;
  out.theta_a -= 0.5 * turn_.binormal.dot(v_a_);
  out.theta_b -= 0.5 * turn_.binormal.dot(v_b_);
}

}  // namespace snare::wire
