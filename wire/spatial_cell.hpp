#pragma once

#include "base/index.hpp"
#include "wire/curvature.hpp"
#include "wire/mesh.hpp"
#include "wire/spatial_properties.hpp"
#include "wire/spatial_state.hpp"

#include <Eigen/Core>

#include <cassert>
#include <optional>

namespace snare::wire {

/// One edge of a spatial rod, or the direction of a mount in the place of one.
struct SpatialEdge {
  Eigen::Vector3d tangent;      ///< unit
  double length = 1.0;          ///< [m]
  double inverse_length = 0.0;  ///< [1/m]; 0 for a mount: its derivatives vanish
  double rest = 1.0;            ///< [m]
  double theta = 0.0;           ///< of the material director m1 from the reference director [rad]
  Directors directors;          ///< only of rods that feel them
};

/// Energy of one vertex as a function of c, kappa_1, kappa_2, tau and the cell's length l.   theory.md (W.27)
struct SpatialCell {
  bool bends = false;
  bool twists = false;
  bool directed = false;  ///< feels the directors
  Turn turn;
  InverseLengths inverse;
  double energy = 0.0;                                        ///< E [J]
  double by_cosine = 0.0;                                     ///< dE/dc
  double by_cosine_twice = 0.0;                               ///< d2E/dc2
  Eigen::Vector2d by_kappa = Eigen::Vector2d::Zero();         ///< dE/dkappa_j [N m]
  double anisotropy = 0.0;                                    ///< d2E/dkappa_1^2 = -d2E/dkappa_2^2 = (k_1 - k_2)/2
  double torque = 0.0;                                        ///< dE/dtau [N m]
  double twist_stiffness = 0.0;                               ///< d2E/dtau2
  double by_length = 0.0;                                     ///< dE/dl [N]
  double by_length_twice = 0.0;                               ///< d2E/dl2
  double cosine_by_length = 0.0;                              ///< d2E/dc dl
  Eigen::Vector2d kappa_by_length = Eigen::Vector2d::Zero();  ///< d2E/dkappa_j dl
  double torque_by_length = 0.0;                              ///< d2E/dtau dl
};

/// The constants of a rod, and which terms of a cell they ask for.
struct CellTerms {
  CellTerms(const SpatialRodProperties& p, Strains strains)
      : properties(p),
        bends(strains == Strains::all),
        axial_stiffness(bends ? p.axial_stiffness : 0.0),
        directed(bends && (p.bending_stiffness != p.second_bending_stiffness ||
                           p.natural_curvature != Eigen::Vector2d::Zero())) {}
  const SpatialRodProperties& properties;
  bool bends;
  double axial_stiffness;  ///< EA, 0 of a rod that only twists [N]
  bool directed;           ///< not round, or naturally curved
};

/// Edge e at a state, between its vertices; and a mount in the place of an edge, with its direction and directors if it orients.
[[nodiscard]] SpatialEdge edge_at(int e, const MaterialMesh& mesh, const SpatialState& state, const CellTerms& terms);
[[nodiscard]] SpatialEdge mount_edge(const SpatialEnd& end, const std::optional<Frame>& frame, const CellTerms& terms);

/// Vertex i of n edges. `before`, `after`: its edges; at an end the mount stands for the outer one, and half
/// a cell for the whole.                                                                     theory.md (W.28)
[[nodiscard]] SpatialCell cell_at(int i, int n, const SpatialEdge& before, const SpatialEdge& after,
                                  const SpatialState& state, const CellTerms& terms);

/// First and second derivatives of the cell's energy by its edges and their angles.
[[nodiscard]] PairGradient gradient_of(const SpatialCell& cell, const SpatialEdge& before, const SpatialEdge& after);
[[nodiscard]] PairHessian hessian_of(const SpatialCell& cell, const SpatialEdge& before, const SpatialEdge& after);
/// Derivative of the cell's gradient by its length l.
[[nodiscard]] PairGradient gradient_by_length(const SpatialCell& cell, const SpatialEdge& before,
                                              const SpatialEdge& after);
/// Derivative of the cell's energy by a rigid rotation of all that follows the vertex [N m].
///                                                                                           theory.md (W.29)
[[nodiscard]] Eigen::Vector3d moment_of(const SpatialCell& cell, const SpatialEdge& before, const SpatialEdge& after);

/// Calls visit(i, cell, before, after) at every vertex in order.
template <class Visitor>
void visit_cells(const MaterialMesh& mesh, const SpatialState& state, const CellTerms& terms, const Visitor& visit) {
  const int n = mesh.edges();
  assert(state.q.size() == SpatialState::block * (n + 1) && static_cast<int>(state.frames.size()) == n &&
         "a state is made by make_state");
  SpatialEdge before = mount_edge(terms.properties.left, state.left_mount, terms);
  for (int i = 0; i <= n; ++i) {
    const SpatialEdge after =
        i < n ? edge_at(i, mesh, state, terms) : mount_edge(terms.properties.right, state.right_mount, terms);
    visit(i, cell_at(i, n, before, after, state, terms), before, after);
    before = after;
  }
}

}  // namespace snare::wire
