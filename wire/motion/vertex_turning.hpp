#pragma once

#include "wire/motion/bending_cell.hpp"

#include <Eigen/Core>

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

/// By which angle the chords turn at a vertex, about the material directors.                 theory.md (W.31)
///   phi_j = f kappa_j,   f = (phi/2)/tan(phi/2) of the cosine c,   |kb| = 2 tan(phi/2)
/// The cell stays the caller's and outlives this.
class VertexTurning {
 public:
  explicit VertexTurning(const BendingCell& cell);

  /// phi_1, phi_2 [rad].
  [[nodiscard]] Eigen::Vector2d angles() const { return share_.value * curvatures_; }
  /// Derivative of w_1 phi_1 + w_2 phi_2 by edges and angles of twist, the weights constant and of any unit.
  [[nodiscard]] PairGradient gradient(const Eigen::Vector2d& weights) const;
  [[nodiscard]] PairHessian hessian(const Eigen::Vector2d& weights) const;
  /// The same by a rigid rotation of all that follows the vertex [rad], in the unit of the weights.
  [[nodiscard]] Eigen::Vector3d by_rotation(const Eigen::Vector2d& weights) const;

 private:
  [[nodiscard]] WeightedCurvature curvature(const Eigen::Vector2d& weights) const {
    return {cell_.turn, cell_.before, cell_.after, weights[0], weights[1]};
  }
  const BendingCell& cell_;
  TurningShare<double> share_;
  Eigen::Vector2d curvatures_;  // kappa_1, kappa_2
};

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
