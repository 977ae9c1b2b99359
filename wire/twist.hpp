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
void add_twist_hessian(const Turn& turn, const InverseLengths& inverse, double moment, double stiffness,
                       PairHessian& out);

// Here, for the compiler to put in where wires in motion spend their time.

// (W.26)  tau = theta_+ - theta_- + m:   dm/da = kb/(2 |a|),   dm/db = kb/(2 |b|).
// An energy of tau with torque M = dE/dtau (`moment`) has the gradient M dtau.
template <class S>
[[gnu::always_inline]] inline void add_twist_gradient(const TurnOf<S>& turn, const InverseLengthsOf<S>& inverse,
                                                      const S& moment, PairGradientOf<S>& out) {
  out.a += (0.5 * moment * inverse.a) * turn.binormal;
  out.b += (0.5 * moment * inverse.b) * turn.binormal;
  out.theta_a -= moment;
  out.theta_b += moment;
}

}  // namespace snare::wire
