#pragma once

#include "numerics/dae.hpp"
#include "wire/motion/bending_cell.hpp"
#include "wire/motion/rod_model.hpp"
#include "wire/motion/rod_slots.hpp"

#include <Eigen/Core>

#include <array>
#include <vector>

/// Kelvin-Voigt damping of a rod.                                                             theory.md (M.4)
///
///   D = sum_vertices 1/2 tau_b EI_j/l kappa_j'^2 + sum_edges 1/2 tau_a EA h e'^2,   rows of x and theta get
///     dD/d(rate)
///
/// kappa_j: integrated curvatures (W.24), e = |x_{i+1} - x_i|/h - 1, ' is d/dt.
namespace snare::wire {

/// tau_b EI_j/l of a cell, j = 1, 2 [N m s].
[[nodiscard]] std::array<double, 2> viscous_stiffness(const RodModel& model, const BendingCell& cell);

/// The Jacobian of vertex i's viscous moments tau_b EI_j/l kappa_j'. c: of DaePart::jacobian [1/s].
void add_bending_damping_jacobian(const RodModel& model, const BendingCell& cell, int i, double c,
                                  const RodSlots& slots, std::vector<double>& values);

}  // namespace snare::wire
