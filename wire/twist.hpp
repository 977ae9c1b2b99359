#pragma once

#include "wire/curvature.hpp"

namespace snare::wire {

/// Integrated twist of a vertex [rad].                         theory.md (W.26); Bergou et al. 2010, sec. 4.1
///   tau = theta_b - theta_a + m,  m: reference twist
///   dm/da = kb/(2 |a|),  dm/db = kb/(2 |b|),  dtau/dtheta = (-1, 1)
/// Adds moment * gradient of tau.
template <class S>
void add_twist_gradient(const TurnOf<S>& turn, const InverseLengthsOf<S>& inverse, const S& moment,
                        PairGradientOf<S>& out);

/// Adds moment [N m] * hessian of tau + stiffness [N m] * (gradient of tau)(gradient of tau)^T:
///   |a|^2 d2m/da2 = -1/4 (kb (t + mean)^T + (t + mean) kb^T),
///   |a||b| d2m/da db = 1/2 (2 [t]_x/chi - kb mean^T).
template <class S>
void add_twist_hessian(const TurnOf<S>& turn, const InverseLengthsOf<S>& inverse, const S& moment,
                       const S& stiffness, PairHessianOf<S>& out);

// Here, for the compiler to put in where wires in motion spend their time.

// (W.26)  tau = theta_+ - theta_- + m:   dm/da = kb/(2 |a|),   dm/db = kb/(2 |b|).
// An energy of tau with torque M = dE/dtau (`moment`) has the gradient M dtau.
template <class S>
[[gnu::always_inline]] inline void add_twist_gradient(const TurnOf<S>& turn,
                                                      const InverseLengthsOf<S>& inverse, const S& moment,
                                                      PairGradientOf<S>& out) {
  out.a += (0.5 * moment * inverse.a) * turn.binormal;
  out.b += (0.5 * moment * inverse.b) * turn.binormal;
  out.theta_a -= moment;
  out.theta_b += moment;
}

// (W.26)  d2E = M d2tau + k dtau dtau^T, M: `moment`, k: `stiffness`. From dkb (see curvature.cpp) and
// d(1/|a|):
//   |a|^2 d2m/da2 = -1/2 kb (t + mean)^T - [u]_x/chi,   |b|^2 d2m/db2 = -1/2 kb (u + mean)^T + [t]_x/chi,
//   |a||b| d2m/da db = [t]_x/chi - 1/2 kb mean^T.
// Of the first two the symmetric part is taken, -1/4 (kb x^T + x kb^T) with x = t + mean or u + mean: the
// skew part belongs to the holonomy of the transport and is no second derivative.
template <class S>
[[gnu::always_inline]] inline void add_twist_hessian(const TurnOf<S>& turn,
                                                     const InverseLengthsOf<S>& inverse, const S& moment,
                                                     const S& stiffness, PairHessianOf<S>& out) {
  const Vector3<S>& t = turn.before;
  const Vector3<S>& u = turn.after;
  const Vector3<S>& kb = turn.binormal;
  const S faa = inverse.a * inverse.a;
  const S fbb = inverse.b * inverse.b;
  const S fab = inverse.a * inverse.b;
  // k/4 kb kb^T - M/4 (kb x^T + x kb^T) = y kb^T + kb z^T with y = k/4 kb - M/4 x, z = -M/4 x.
  const Vector3<S> za = (-0.25 * moment * faa) * (t + turn.mean);
  const Vector3<S> ya = (0.25 * stiffness * faa) * kb + za;
  const Vector3<S> zb = (-0.25 * moment * fbb) * (u + turn.mean);
  const Vector3<S> yb = (0.25 * stiffness * fbb) * kb + zb;
  const Vector3<S> zab = fab * (0.25 * stiffness * kb - 0.5 * moment * turn.mean);
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      out.aa(i, j) += ya[i] * kb[j] + kb[i] * za[j];
      out.bb(i, j) += yb[i] * kb[j] + kb[i] * zb[j];
      out.ab(i, j) += kb[i] * zab[j];
    }
  }
  const Vector3<S> s = (moment * fab / turn.chi) * t;  // M [t]_x/chi = [s]_x
  out.ab(0, 1) -= s[2];
  out.ab(0, 2) += s[1];
  out.ab(1, 0) += s[2];
  out.ab(1, 2) -= s[0];
  out.ab(2, 0) -= s[1];
  out.ab(2, 1) += s[0];

  // k dtau/d(edge) dtau/dtheta, dtau/dtheta_- = -1, dtau/dtheta_+ = 1.
  const Vector3<S> by_a = (0.5 * stiffness * inverse.a) * kb;
  const Vector3<S> by_b = (0.5 * stiffness * inverse.b) * kb;
  out.a_theta_a -= by_a;
  out.a_theta_b += by_a;
  out.b_theta_a -= by_b;
  out.b_theta_b += by_b;
  out.theta_aa += stiffness;
  out.theta_ab -= stiffness;
  out.theta_bb += stiffness;
}

}  // namespace snare::wire
