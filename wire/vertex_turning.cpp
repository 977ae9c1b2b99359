#include "wire/vertex_turning.hpp"

#include <cmath>

namespace snare::wire {

using Eigen::Vector2d;
using Eigen::Vector3d;

// f = atan(r)/r of u = r^2 = tan^2(phi/2) = |kb|^2/4:   2 u f' = 1/(1 + u) - f,   2 u f'' = -1/(1 + u)^2 - 3 f';
// by c, u = (1 - c)/(1 + c):   u' = -2/chi^2,   u'' = 4/chi^3.
VertexTurning::VertexTurning(const BendingCell& cell) : cell_(cell) {
  const Turn& turn = cell.turn;
  const double u = 0.25 * turn.binormal.squaredNorm();
  double first = 0.0;
  double second = 0.0;
  constexpr double series = 1e-2;  // six powers leave 1e-12 of f''
  if (u < series) {
    share_ = 1.0 - u * (1.0 / 3 - u * (1.0 / 5 - u * (1.0 / 7 - u * (1.0 / 9 - u * (1.0 / 11 - u / 13)))));
    first = -1.0 / 3 + u * (2.0 / 5 - u * (3.0 / 7 - u * (4.0 / 9 - u * (5.0 / 11 - u * 6 / 13))));
    second = 2.0 / 5 - u * (6.0 / 7 - u * (12.0 / 9 - u * (20.0 / 11 - u * (30.0 / 13 - u * 42 / 15))));
  } else {
    const double r = std::sqrt(u);
    share_ = std::atan(r) / r;
    first = (1.0 / (1.0 + u) - share_) / (2.0 * u);
    second = (-1.0 / ((1.0 + u) * (1.0 + u)) - 3.0 * first) / (2.0 * u);
  }
  const double by_cosine = -2.0 / (turn.chi * turn.chi);
  share_first_ = first * by_cosine;
  share_second_ = second * by_cosine * by_cosine - 2.0 * first * by_cosine / turn.chi;
  curvatures_ = curvatures(turn, cell.before, cell.after);
}

// d(f kappa) = f dkappa + kappa f' dc
PairGradient VertexTurning::gradient(const Vector2d& weights) const {
  PairGradient g;
  curvature(share_ * weights).add_gradient(cell_.inverse, g);
  add_cosine_gradient(cell_.turn, cell_.inverse, weights.dot(curvatures_) * share_first_, g);
  return g;
}

// d2(f kappa) = f d2kappa + kappa (f' d2c + f'' dc dc^T) + f' (dc dkappa^T + dkappa dc^T); the last with p = f' dc and
// q = dkappa as 1/2 (p + q)(p + q)^T - 1/2 (q - p)(q - p)^T.
PairHessian VertexTurning::hessian(const Vector2d& weights) const {
  PairHessian h;
  const WeightedCurvature kappa = curvature(weights);
  curvature(share_ * weights).add_hessian(cell_.inverse, h);
  add_cosine_hessian(cell_.turn, cell_.inverse, kappa.value() * share_first_, kappa.value() * share_second_, h);
  for (const double sign : {1.0, -1.0}) {
    PairGradient g;
    kappa.add_gradient(cell_.inverse, g);
    add_cosine_gradient(cell_.turn, cell_.inverse, sign * share_first_, g);
    add_square(g, 0.5 * sign, h);
  }
  return h;
}

// dc = -1/2 chi kb.omega (W.29)
Vector3d VertexTurning::by_rotation(const Vector2d& weights) const {
  const WeightedCurvature kappa = curvature(weights);
  return share_ * kappa.by_rotation() - 0.5 * kappa.value() * share_first_ * cell_.turn.chi * cell_.turn.binormal;
}

}  // namespace snare::wire
