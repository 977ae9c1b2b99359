#include "wire/spatial_cell.hpp"

#include "wire/twist.hpp"

#include <Eigen/Geometry>

#include <cmath>

namespace snare::wire {

using Eigen::Vector3d;

namespace {

Directors directors_of(const Frame& frame, const Vector3d& tangent, double theta) {
  const Vector3d first = turned_director({tangent, frame.director}, theta);
  return {first, tangent.cross(first)};
}

}  // namespace

SpatialEdge edge_at(int e, const MaterialMesh& mesh, const SpatialState& state, const CellTerms& terms) {
  const double* near = state.q.data() + SpatialState::block * e;
  const double* far = near + SpatialState::block;
  SpatialEdge edge;
  const Vector3d d(far[0] - near[0], far[1] - near[1], far[2] - near[2]);
  edge.length = std::sqrt(d.squaredNorm());
  edge.inverse_length = 1.0 / edge.length;
  edge.tangent = edge.inverse_length * d;
  edge.rest = mesh.rest_length(e, state.controls);
  edge.theta = near[SpatialState::angle];
  if (terms.directed) {
    edge.directors = directors_of(state.frames[base::at(e)], edge.tangent, edge.theta);
  }
  return edge;
}

SpatialEdge mount_edge(const SpatialEnd& end, const std::optional<Frame>& frame, const CellTerms& terms) {
  SpatialEdge edge;
  if (!end.orients()) return edge;
  assert(frame && "the state was made for other mounts");
  edge.tangent = frame->tangent;
  edge.theta = end.twist_angle;
  if (terms.directed) edge.directors = directors_of(*frame, edge.tangent, edge.theta);
  return edge;
}

SpatialCell cell_at(int i, int n, const SpatialEdge& before, const SpatialEdge& after,
                    const SpatialState& state, const CellTerms& terms) {
  const SpatialRodProperties& p = terms.properties;
  SpatialCell cell;
  const SpatialEnd* end = i == 0 ? &p.left : (i == n ? &p.right : nullptr);
  if (end != nullptr && !end->orients()) return cell;
  // l = (h_{i-1} + h_i)/2; at a mount half of the one rest length there is.
  const double length =
      end == nullptr ? 0.5 * (before.rest + after.rest) : 0.5 * (i == 0 ? after.rest : before.rest);
  cell.turn = make_turn<double>(before.tangent, after.tangent);
  cell.inverse = {before.inverse_length, after.inverse_length};
  const double tau = after.theta - before.theta + state.reference_twist[base::at(i)];  // (W.26)
  add_twisting(tau, length, end == nullptr ? 0.0 : 1.0 / end->twisting_stiffness, terms, cell);
  if (!terms.bends) return cell;
  if (end == nullptr) {
    add_bending(before.directors, after.directors, length, 0.0, terms, cell);
  } else if (end->kind == SpatialEnd::Kind::clamp) {
    add_bending(before.directors, after.directors, length, 1.0 / end->rotational_stiffness, terms, cell);
  }
  return cell;
}

namespace {

/// by_c dc + sum_j by_kappa_j dkappa_j + by_tau dtau.
PairGradient weighted_gradient(const SpatialCell& cell, const SpatialEdge& before, const SpatialEdge& after,
                               double by_c, const Pair<double>& by_kappa, double by_tau) {
  PairGradient g;
  if (cell.bends) add_cosine_gradient(cell.turn, cell.inverse, by_c, g);
  if (cell.directed)
    WeightedCurvature(cell.turn, before.directors, after.directors, by_kappa[0], by_kappa[1])
        .add_gradient(cell.inverse, g);
  if (cell.twists) add_twist_gradient(cell.turn, cell.inverse, by_tau, g);
  return g;
}

}  // namespace

// dE = dE/dc dc + sum_j dE/dkappa_j dkappa_j + dE/dtau dtau.
PairGradient gradient_of(const SpatialCell& cell, const SpatialEdge& before, const SpatialEdge& after) {
  return weighted_gradient(cell, before, after, cell.by_cosine, cell.by_kappa, cell.torque);
}

// The same with d2E/dc dl, d2E/dkappa_j dl, d2E/dtau dl as factors.
PairGradient gradient_by_length(const SpatialCell& cell, const SpatialEdge& before,
                                const SpatialEdge& after) {
  return weighted_gradient(cell, before, after, cell.cosine_by_length, cell.kappa_by_length,
                           cell.torque_by_length);
}

// d2E = dE/dc d2c + d2E/dc2 dc^2 + dE/dtau d2tau + d2E/dtau2 dtau^2
//     + sum_j dE/dkappa_j d2kappa_j + a (dkappa_1^2 - dkappa_2^2),   a = (k_1 - k_2)/2.
PairHessian hessian_of(const SpatialCell& cell, const SpatialEdge& before, const SpatialEdge& after) {
  PairHessian h;
  if (cell.bends) add_cosine_hessian(cell.turn, cell.inverse, cell.by_cosine, cell.by_cosine_twice, h);
  if (cell.twists) add_twist_hessian(cell.turn, cell.inverse, cell.torque, cell.twist_stiffness, h);
  if (cell.directed) {
    WeightedCurvature(cell.turn, before.directors, after.directors, cell.by_kappa[0], cell.by_kappa[1])
        .add_hessian(cell.inverse, h);
    PairGradient g1;
    PairGradient g2;
    WeightedCurvature(cell.turn, before.directors, after.directors, 1.0, 0.0).add_gradient(cell.inverse, g1);
    WeightedCurvature(cell.turn, before.directors, after.directors, 0.0, 1.0).add_gradient(cell.inverse, g2);
    add_square(g1, cell.anisotropy, h);
    add_square(g2, -cell.anisotropy, h);
  }
  return h;
}

// By a rotation omega of the edge after: du = omega x u, so that
//   dc = t.(omega x u) = -omega.(t x u) = -chi/2 omega.kb,   dtau = omega.(t + u)/chi.
Vector3d moment_of(const SpatialCell& cell, const SpatialEdge& before, const SpatialEdge& after) {
  Vector3d moment = Vector3d::Zero();
  if (cell.bends) moment -= 0.5 * cell.by_cosine * cell.turn.chi * cell.turn.binormal;
  if (cell.directed) {
    moment +=
        WeightedCurvature(cell.turn, before.directors, after.directors, cell.by_kappa[0], cell.by_kappa[1])
            .by_rotation();
  }
  if (cell.twists) moment += cell.torque * cell.turn.mean;
  return moment;
}

}  // namespace snare::wire
