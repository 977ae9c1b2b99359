#pragma once

#include "numerics/lanes.hpp"
#include "wire/curvature.hpp"

#include <type_traits>

namespace snare::wire {

/// f = (phi/2)/tan(phi/2) of the angle by which the chords turn at a vertex, as a function of its cosine c:
/// phi_j = f kappa_j.
///                                                                                           theory.md (W.31)
template <class S>
struct TurningShare {
  S value, first, second;  ///< f and its derivatives by c
};
template <class S>
[[nodiscard]] TurningShare<S> turning_share(const TurnOf<S>& turn);

// Here, for the compiler to put in where wires in motion spend their time.

namespace turning {

inline constexpr double series = 1e-2;  // six powers leave 1e-12 of f''

/// f and its derivatives by u = tan^2(phi/2): by powers, and of any angle.
template <class S>
[[nodiscard, gnu::always_inline]] inline TurningShare<S> of_small(const S& u) {
  return {
      1.0 - u * (1.0 / 3 - u * (1.0 / 5 - u * (1.0 / 7 - u * (1.0 / 9 - u * (1.0 / 11 - u * (1.0 / 13)))))),
      -1.0 / 3 + u * (2.0 / 5 - u * (3.0 / 7 - u * (4.0 / 9 - u * (5.0 / 11 - u * (6.0 / 13))))),
      2.0 / 5 - u * (6.0 / 7 - u * (12.0 / 9 - u * (20.0 / 11 - u * (30.0 / 13 - u * (42.0 / 15)))))};
}
/// u: [-].
[[nodiscard]] TurningShare<double> of_any(double u);

}  // namespace turning

// f = atan(r)/r of u = r^2 = tan^2(phi/2) = |kb|^2/4;   by c, u = (1 - c)/(1 + c):   u' = -2/chi^2,   u'' =
// 4/chi^3.
template <class S>
[[gnu::always_inline]] inline TurningShare<S> turning_share(const TurnOf<S>& turn) {
  const S u = 0.25 * turn.binormal.squaredNorm();
  TurningShare<S> f;
  if (numerics::all_below(u, turning::series))
    f = turning::of_small(u);
  else if constexpr (std::is_same_v<S, double>)
    f = turning::of_any(u);
  else
    for (int k = 0; k < S::count; ++k) {
      const TurningShare<double> one = turning::of_any(u[k]);
      f.value.v[k] = one.value;
      f.first.v[k] = one.first;
      f.second.v[k] = one.second;
    }
  const S inverse = 1.0 / turn.chi;
  const S by_cosine = -2.0 * inverse * inverse;
  return {f.value, f.first * by_cosine, (f.second * by_cosine - 2.0 * f.first * inverse) * by_cosine};
}

}  // namespace snare::wire
