#include "wire/motion/vertex_turning.hpp"

#include <cmath>

namespace snare::wire {

using Eigen::Vector2d;
using Eigen::Vector3d;

VertexTurning::VertexTurning(const BendingCell& cell)
    : cell_(cell),
      share_(turning_share(cell.turn)),
      curvatures_(curvatures(cell.turn, cell.before, cell.after)) {}

// d(f kappa) = f dkappa + kappa f' dc
PairGradient VertexTurning::gradient(const Vector2d& weights) const {
  PairGradient g;
  curvature(share_.value * weights).add_gradient(cell_.inverse, g);
  add_cosine_gradient(cell_.turn, cell_.inverse, weights.dot(curvatures_) * share_.first, g);
  return g;
}

// d2(f kappa) = f d2kappa + kappa (f' d2c + f'' dc dc^T) + f' (dc dkappa^T + dkappa dc^T); the last with p =
// f' dc and q = dkappa as 1/2 (p + q)(p + q)^T - 1/2 (q - p)(q - p)^T.
PairHessian VertexTurning::hessian(const Vector2d& weights) const {
  PairHessian h;
  const WeightedCurvature kappa = curvature(weights);
  curvature(share_.value * weights).add_hessian(cell_.inverse, h);
  add_cosine_hessian(cell_.turn, cell_.inverse, kappa.value() * share_.first, kappa.value() * share_.second,
                     h);
  for (const double sign : {1.0, -1.0}) {
    PairGradient g;
    kappa.add_gradient(cell_.inverse, g);
    add_cosine_gradient(cell_.turn, cell_.inverse, sign * share_.first, g);
    add_square(g, 0.5 * sign, h);
  }
  return h;
}

// dc = -1/2 chi kb.omega (W.29)
Vector3d VertexTurning::by_rotation(const Vector2d& weights) const {
  const WeightedCurvature kappa = curvature(weights);
  return share_.value * kappa.by_rotation() -
         0.5 * kappa.value() * share_.first * cell_.turn.chi * cell_.turn.binormal;
}

}  // namespace snare::wire
