#pragma once

#include "numerics/dae.hpp"
#include "wire/end.hpp"
#include "wire/motion/edge_beam.hpp"
#include "wire/motion/rod_model.hpp"
#include "wire/motion/rod_slots.hpp"

#include <Eigen/Core>

#include <vector>

/// Bending and stretching of the rod of higher order: the curvatures k_1, k_2 of every vertex that bends are
/// algebraic unknowns, every edge is a beam.                                         theory.md (W.31), (W.33)
///
///   E = sum_vertices [ sum_j w_j phi_j - |w|^2/(2 k_mount) ]
///       + sum_edges [ E_e(l, k_i, k_{i+1}) + h/2 sum_j EI_j n_j^2 ]
///   w_j = EI_j (k_j - n_j)
///
/// stationary in k; n_j: natural curvatures, phi_j: turning of the chords (W.31), E_e: (W.32). A vertex that
/// does not bend keeps k = n.
namespace snare::wire {

/// Adds energy and gradient by bands of vertex i, which bends, and dE/dk [N m^2].
void add_curved_vertex(const RodModel& model, const BendingCell& cell, int i, const numerics::DaePoint& at,
                       RodAssembly& out, Eigen::Matrix2Xd& by_curvature);
/// Derivatives of an end's vertex terms by the edge beside it (e, theta) and by its curvatures: rows and
/// columns 0 to 2 of e, 3 of theta, 4 and 5 of k.
struct CurvedEnd {
  Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, 6, 6> hessian = Eigen::Matrix<double, 6, 6>::Zero();
};
[[nodiscard]] CurvedEnd curved_end(const RodModel& model, const RodInstant& instant,
                                   const numerics::DaePoint& at, End end);
/// Moment of an end's bending by a rigid rotation of all that follows it [N m].              theory.md (W.29)
[[nodiscard]] Eigen::Vector3d curved_end_moment(const RodModel& model, const RodInstant& instant,
                                                const numerics::DaePoint& at, End end);

/// Bending moments w_1, w_2 of a vertex [N m], zero of one that does not bend.
[[nodiscard]] Eigen::Vector2d curved_moments(const RodModel& model, const numerics::DaePoint& at, int vertex);

/// The curvatures (2, vertices) in which E is stationary at the given places [1/m].
[[nodiscard]] Eigen::Matrix2Xd balanced_curvatures(const RodModel& model, const RodInstant& instant,
                                                   const numerics::DaePoint& at);

}  // namespace snare::wire
