#pragma once

#include "numerics/dae.hpp"
#include "wire/curvature.hpp"
#include "wire/motion/rod_model.hpp"

#include <Eigen/Core>

namespace snare::wire {

/// Unknowns of a vertex's cell: x_{i-1}, theta_{i-1}, x_i, theta_i, x_{i+1}; band index block (i - 1) +
/// local.
struct CellRows {
  static constexpr int before = 0;        ///< x_{i-1} (3)
  static constexpr int angle_before = 3;  ///< theta_{i-1}
  static constexpr int middle = 4;        ///< x_i (3)
  static constexpr int angle_after = 7;   ///< theta_i
  static constexpr int after = 8;         ///< x_{i+1} (3)
  static constexpr int count = 11;
  /// Band index of the first.
  [[nodiscard]] static int first_band(int vertex) { return SpatialRod::block * (vertex - 1); }
};
using CellVector = Eigen::Matrix<double, CellRows::count, 1>;
using CellMatrix = Eigen::Matrix<double, CellRows::count, CellRows::count>;

/// Derivatives by the cell's unknowns [m, rad] from those by its edges and angles.
[[nodiscard]] CellVector to_cell(const PairGradient& g);
[[nodiscard]] CellMatrix to_cell(const PairHessian& h);

/// One vertex's bending in motion: its curvatures kappa_1, kappa_2 and the rates of what they depend on.
struct BendingCell {
  Turn turn;
  InverseLengths inverse;
  Directors before, after;  ///< of length one, but for their weights at the mount of a rod of higher order
  double length = 0.0;      ///< of the cell [m]
  /// Of the cell's unknowns, relative to a mount that spins: e' - w x e of the edge beside it, theta' - w.t
  /// of its angle.                                                                           theory.md (M.17)
  CellVector rate = CellVector::Zero();
  /// Change of `rate` with the cell's places at given velocities [1/s]; zero but beside a mount that spins.
  [[nodiscard]] CellMatrix rate_by_place() const;

  /// Whether vertex i bends: not at an end without a clamp.
  [[nodiscard]] static bool exists(const RodModel& model, int i);
  BendingCell(const RodModel& model, const RodInstant& instant, const numerics::DaePoint& at, int i);

  /// kappa_j, j = 0 or 1.
  [[nodiscard]] WeightedCurvature curvature(int j) const { return curvature(Eigen::Vector2d::Unit(j)); }
  /// sum_j weights_j kappa_j, weights of any unit.
  [[nodiscard]] WeightedCurvature curvature(const Eigen::Vector2d& weights) const {
    return {turn, before, after, weights[0], weights[1]};
  }
  /// kappa_1', kappa_2' [1/s].
  [[nodiscard]] Eigen::Vector2d curvature_rates() const;
  /// First and second derivatives of kappa_j by edges and angles.
  struct Derivatives {
    PairGradient gradient;
    PairHessian hessian;
  };
  [[nodiscard]] Derivatives differentiate(int j) const;

 private:
  std::optional<End> end_;
  Eigen::Vector3d spin_ = Eigen::Vector3d::Zero();  // of a mount that moves
  Eigen::Vector3d edge_ = Eigen::Vector3d::Zero();  // beside it
};

/// Adds factor times derivatives by the edges beside vertex i and their angles to those by bands.
void add_to_bands(const RodModel& model, int i, const PairGradient& g, double factor,
                  Eigen::VectorXd& gradient);

}  // namespace snare::wire
