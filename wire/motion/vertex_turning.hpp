#pragma once

#include "wire/motion/bending_cell.hpp"
#include "wire/turning_share.hpp"

#include <Eigen/Core>

namespace snare::wire {

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

}  // namespace snare::wire
