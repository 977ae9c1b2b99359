#pragma once

#include "numerics/dae.hpp"
#include "wire/motion/bending_cell.hpp"
#include "wire/motion/rod_losses.hpp"
#include "wire/motion/rod_model.hpp"
#include "wire/motion/rod_slots.hpp"

#include <Eigen/Core>

#include <vector>

namespace snare::wire {

/// What the strands of a vertex answer, by z and the rate of curvature kappa'/l.             theory.md (M.14)
///   e = z + tau kappa'/l,   m = e for |e| <= kappa_s, else kappa_s e/|e|,   z' = (m - z)/tau,   moment k_x m
struct StrandResponse {
  Eigen::Vector2d moment;    ///< k_x m [N m]
  Eigen::Vector2d rate;      ///< z' [1/(m s)]
  Eigen::Matrix2d by_reach;  ///< S = dm/de: I, or kappa_s/|e| (I - e e^T/|e|^2) while they slip

  /// held: z [1/m]; curvature_rate: kappa'/l [1/(m s)].
  StrandResponse(const RodStrands& s, const Eigen::Vector2d& held, const Eigen::Vector2d& curvature_rate);
};

/// What the strands of vertex i answer to rates of its curvatures kappa_j [1/s], as a moment [N m]; what they
/// hold and lose is added. length: of its cell [m].                                          theory.md (M.14)
[[nodiscard]] Eigen::Vector2d strand_moment(const RodModel& model, int i, double length,
                                            const Eigen::Vector2d& rates, const numerics::DaePoint& at,
                                            RodLosses& losses);

/// The Jacobian of vertex i's rows of z and of its cell's balances by z, places and rates. A vertex that does
/// not bend has z' = 0. c: of DaePart::jacobian [1/s].
void add_resting_strands_jacobian(const RodModel& model, int i, double c, const RodSlots& slots,
                                  std::vector<double>& values);
void add_strands_jacobian(const RodModel& model, const BendingCell& cell, int i, const numerics::DaePoint& at,
                          double c, const RodSlots& slots, std::vector<double>& values);

}  // namespace snare::wire
