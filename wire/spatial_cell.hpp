#pragma once

#include "base/index.hpp"
#include "wire/curvature.hpp"
#include "wire/mesh.hpp"
#include "wire/series_stiffness.hpp"
#include "wire/spatial_properties.hpp"
#include "wire/spatial_state.hpp"

#include <Eigen/Core>

#include <cassert>
#include <optional>

namespace snare::wire {

/// One edge of a spatial rod, or the direction of a mount instead of one.
struct SpatialEdge {
  Eigen::Vector3d tangent;      ///< unit
  double length = 1.0;          ///< [m]
  double inverse_length = 0.0;  ///< [1/m]; 0 for a mount: its derivatives vanish
  double rest = 1.0;            ///< [m]
  double theta = 0.0;           ///< of the material director m1 from the reference director [rad]
  Directors directors;          ///< only of rods that feel them
};

/// Energy of one vertex as a function of c, kappa_1, kappa_2, tau and the cell's length l.   theory.md (W.27)
template <class S>
struct SpatialCellOf {
  bool bends = false;
  bool twists = false;
  bool directed = false;  ///< feels the directors
  TurnOf<S> turn;
  InverseLengthsOf<S> inverse;
  S energy = 0.0;                     ///< E [J]
  S by_cosine = 0.0;                  ///< dE/dc
  S by_cosine_twice = 0.0;            ///< d2E/dc2
  Pair<S> by_kappa{0.0, 0.0};         ///< dE/dkappa_j [N m]
  S anisotropy = 0.0;                 ///< d2E/dkappa_1^2 = -d2E/dkappa_2^2 = (k_1 - k_2)/2
  Pair<S> cosine_by_kappa{0.0, 0.0};  ///< d2E/dc dkappa_j [N m]
  S torque = 0.0;                     ///< dE/dtau [N m]
  S twist_stiffness = 0.0;            ///< d2E/dtau2
  S by_length = 0.0;                  ///< dE/dl [N]
  S by_length_twice = 0.0;            ///< d2E/dl2
  S cosine_by_length = 0.0;           ///< d2E/dc dl
  Pair<S> kappa_by_length{0.0, 0.0};  ///< d2E/dkappa_j dl
  S torque_by_length = 0.0;           ///< d2E/dtau dl
};
using SpatialCell = SpatialCellOf<double>;

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

/// Adds bending and twisting of a cell of length l [m] with a mount's flexibility [rad/(N m)] in series; its
/// turn is set.
///                                                                                    theory.md (W.6), (W.27)
template <class S>
void add_bending(const DirectorsOf<S>& before, const DirectorsOf<S>& after, const S& l, double flexibility,
                 const CellTerms& terms, SpatialCellOf<S>& cell);
/// tau: integrated twist [rad].
template <class S>
void add_twisting(const S& tau, const S& l, double flexibility, const CellTerms& terms,
                  SpatialCellOf<S>& cell);

/// Edge e at a state, between its vertices; and a mount instead of an edge, with its direction and
/// directors if it orients.
[[nodiscard]] SpatialEdge edge_at(int e, const MaterialMesh& mesh, const SpatialState& state,
                                  const CellTerms& terms);
[[nodiscard]] SpatialEdge mount_edge(const SpatialEnd& end, const std::optional<Frame>& frame,
                                     const CellTerms& terms);

/// Vertex i of n edges. `before`, `after`: its edges; at an end the mount stands for the outer one, and half
/// a cell for the whole.                                                                     theory.md (W.28)
[[nodiscard]] SpatialCell cell_at(int i, int n, const SpatialEdge& before, const SpatialEdge& after,
                                  const SpatialState& state, const CellTerms& terms);

/// First and second derivatives of the cell's energy by its edges and their angles.
[[nodiscard]] PairGradient gradient_of(const SpatialCell& cell, const SpatialEdge& before,
                                       const SpatialEdge& after);
[[nodiscard]] PairHessian hessian_of(const SpatialCell& cell, const SpatialEdge& before,
                                     const SpatialEdge& after);
/// Derivative of the cell's gradient by its length l.
[[nodiscard]] PairGradient gradient_by_length(const SpatialCell& cell, const SpatialEdge& before,
                                              const SpatialEdge& after);
/// Derivative of the cell's energy by a rigid rotation of all that follows the vertex [N m].
///                                                                                           theory.md (W.29)
[[nodiscard]] Eigen::Vector3d moment_of(const SpatialCell& cell, const SpatialEdge& before,
                                        const SpatialEdge& after);

// Here, for the compiler to put in where wires in motion spend their time.

// (W.27)  Bending of a cell:
//   E = 1/4 (k_1 + k_2)|kb|^2 + 1/4 (k_1 - k_2)(kappa_1^2 - kappa_2^2) + sum_j k_j n_j l (n_j l/2 - kappa_j)
// n_j: natural curvatures. ' below is d/dl.
template <class S>
[[gnu::always_inline]] inline void add_bending(const DirectorsOf<S>& before, const DirectorsOf<S>& after,
                                               const S& l, double flexibility, const CellTerms& terms,
                                               SpatialCellOf<S>& cell) {
  const SpatialRodProperties& p = terms.properties;
  cell.bends = true;
  const SeriesStiffness<S> k1 = in_series(l, p.bending_stiffness, flexibility);
  const SeriesStiffness<S> k2 = terms.directed ? in_series(l, p.second_bending_stiffness, flexibility) : k1;

  // Round part, 1/4 (k_1 + k_2)|kb|^2 with |kb|^2 = 4 (1 - c)/(1 + c), taken from kb to keep its digits:
  //   d|kb|^2/dc = -8/chi^2,   d2|kb|^2/dc2 = 16/chi^3 = -2 (d|kb|^2/dc)/chi.
  const S square = cell.turn.binormal.squaredNorm();
  const S inverse_chi = 1.0 / cell.turn.chi;
  const S slope = -8.0 * inverse_chi * inverse_chi;
  const S mean = 0.25 * (k1.k + k2.k);
  const S mean_first = 0.25 * (k1.first + k2.first);
  cell.energy += mean * square;
  cell.by_cosine = mean * slope;
  cell.by_cosine_twice = -2.0 * mean * slope * inverse_chi;
  cell.by_length += mean_first * square;
  cell.by_length_twice += 0.25 * (k1.second + k2.second) * square;
  cell.cosine_by_length = mean_first * slope;
  if (!terms.directed) return;

  // Part of the directors, 1/2 a (kappa_1^2 - kappa_2^2) with a = (k_1 - k_2)/2:
  //   dE/dkappa = a (kappa_1, -kappa_2),   d2E/dkappa dl = a' (kappa_1, -kappa_2).
  cell.directed = true;
  const Pair<S> kappa = curvature_pair(cell.turn, before, after);
  const Eigen::Vector2d& natural = p.natural_curvature;
  const S difference = kappa[0] * kappa[0] - kappa[1] * kappa[1];
  cell.anisotropy = 0.5 * (k1.k - k2.k);
  const S anisotropy_first = 0.5 * (k1.first - k2.first);
  cell.energy += 0.5 * cell.anisotropy * difference;
  cell.by_kappa = {cell.anisotropy * kappa[0], -cell.anisotropy * kappa[1]};
  cell.by_length += 0.5 * anisotropy_first * difference;
  cell.by_length_twice += 0.25 * (k1.second - k2.second) * difference;
  cell.kappa_by_length = {anisotropy_first * kappa[0], -anisotropy_first * kappa[1]};

  // Natural curvature, N = k n l (n l/2 - kappa):
  //   dN/dkappa = -k n l,   d2N/dkappa dl = -n (k' l + k),
  //   dN/dl = 1/2 n^2 l (k' l + 2 k) - n kappa (k' l + k),
  //   d2N/dl2 = 1/2 n^2 (k'' l^2 + 4 k' l + 2 k) - n kappa (k'' l + 2 k').
  const auto add_natural = [&](std::size_t j, const SeriesStiffness<S>& k) __attribute__((always_inline)) {
    const double n = natural[static_cast<Eigen::Index>(j)];
    cell.energy += k.k * n * l * (0.5 * n * l - kappa[j]);
    cell.by_kappa[j] -= k.k * n * l;
    cell.kappa_by_length[j] -= n * (k.first * l + k.k);
    cell.by_length += 0.5 * n * n * l * (k.first * l + 2.0 * k.k) - n * kappa[j] * (k.first * l + k.k);
    cell.by_length_twice += 0.5 * n * n * (k.second * l * l + 4.0 * k.first * l + 2.0 * k.k) -
                            n * kappa[j] * (k.second * l + 2.0 * k.first);
  };
  add_natural(0, k1);
  add_natural(1, k2);
}

// (W.27)  Twisting of a cell, E = 1/2 k s^2 with s = tau - n l, n the natural twist:
//   dE/dtau = k s,   d2E/dtau2 = k,   d2E/dtau dl = k' s - k n,
//   dE/dl = 1/2 k' s^2 - k n s,   d2E/dl2 = 1/2 k'' s^2 - 2 k' n s + k n^2
template <class S>
[[gnu::always_inline]] inline void add_twisting(const S& tau, const S& l, double flexibility,
                                                const CellTerms& terms, SpatialCellOf<S>& cell) {
  const SpatialRodProperties& p = terms.properties;
  cell.twists = true;
  const SeriesStiffness<S> k = in_series(l, p.torsional_stiffness, flexibility);
  const double natural = p.natural_twist;
  const S strain = tau - natural * l;
  cell.energy += 0.5 * k.k * strain * strain;
  cell.torque = k.k * strain;
  cell.twist_stiffness = k.k;
  cell.torque_by_length = k.first * strain - k.k * natural;
  cell.by_length += 0.5 * k.first * strain * strain - k.k * natural * strain;
  cell.by_length_twice +=
      0.5 * k.second * strain * strain - 2.0 * k.first * natural * strain + k.k * natural * natural;
}

/// Calls visit(i, cell, before, after) at every vertex in order.
template <class Visitor>
void visit_cells(const MaterialMesh& mesh, const SpatialState& state, const CellTerms& terms,
                 const Visitor& visit) {
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
