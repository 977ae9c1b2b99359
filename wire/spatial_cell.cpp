#include "wire/spatial_cell.hpp"

#include "wire/turning_share.hpp"
#include "wire/twist.hpp"

#include <Eigen/Geometry>

#include <array>
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

namespace {

// (W.6)  A mount's spring is linear in the angles phi_j = f kappa_j of (W.31), not in kappa_j. Of the parts
// a_j of the stiffnesses that are of the angle,
//   dE = 1/4 (a_1 + a_2)(phi^2 - |kb|^2) - sum_j a_j n_j l (f - 1) kappa_j
// with phi^2 = f^2 |kb|^2, u = |kb|^2/4 and derivatives ' by c:
//   d(phi^2)/dc = -2 f (1 + u),   d2(phi^2)/dc2 = -2 (f' (1 + u) - 2 f/chi^2)
// The part of a section that is not round stays that of kappa_j.
void turn_by_angle(const Directors& before, const Directors& after, double l, double flexibility,
                   const CellTerms& terms, SpatialCell& cell) {
  const SpatialRodProperties& p = terms.properties;
  const auto of_angle = [&](double stiffness) {
    return of_the_angle(in_series(l, stiffness, flexibility), l, stiffness);
  };
  const std::array<SeriesStiffness<double>, 2> a{of_angle(p.bending_stiffness),
                                                 of_angle(p.second_bending_stiffness)};
  const TurningShare<double> f = turning_share(cell.turn);
  const double square = cell.turn.binormal.squaredNorm(), one_and_u = 1.0 + 0.25 * square;
  const double inverse_chi = 1.0 / cell.turn.chi;
  const double slope = -8.0 * inverse_chi * inverse_chi;
  const double more = (f.value * f.value - 1.0) * square;
  const double more_by_cosine = -2.0 * f.value * one_and_u - slope;
  const double more_twice =
      -2.0 * (f.first * one_and_u - 2.0 * f.value * inverse_chi * inverse_chi) + 2.0 * slope * inverse_chi;
  const double mean = 0.25 * (a[0].k + a[1].k), mean_first = 0.25 * (a[0].first + a[1].first);
  cell.energy += mean * more;
  cell.by_cosine += mean * more_by_cosine;
  cell.by_cosine_twice += mean * more_twice;
  cell.by_length += mean_first * more;
  cell.by_length_twice += 0.25 * (a[0].second + a[1].second) * more;
  cell.cosine_by_length += mean_first * more_by_cosine;
  if (!terms.directed) return;
  const Pair<double> kappa = curvature_pair(cell.turn, before, after);
  for (std::size_t j = 0; j < 2; ++j) {
    const double n = p.natural_curvature[static_cast<Eigen::Index>(j)], less = f.value - 1.0;
    const double by_length = a[j].k + l * a[j].first;  // of a l
    cell.energy -= a[j].k * n * l * less * kappa[j];
    cell.by_kappa[j] -= a[j].k * n * l * less;
    cell.by_cosine -= a[j].k * n * l * f.first * kappa[j];
    cell.by_cosine_twice -= a[j].k * n * l * f.second * kappa[j];
    cell.cosine_by_kappa[j] = -a[j].k * n * l * f.first;
    cell.kappa_by_length[j] -= n * by_length * less;
    cell.cosine_by_length -= n * by_length * f.first * kappa[j];
    cell.by_length -= n * by_length * less * kappa[j];
    cell.by_length_twice -= n * (2.0 * a[j].first + l * a[j].second) * less * kappa[j];
  }
}

}  // namespace

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
    const double flexibility = 1.0 / end->rotational_stiffness;
    add_bending(before.directors, after.directors, length, flexibility, terms, cell);
    if (flexibility != 0.0)
      turn_by_angle(before.directors, after.directors, length, flexibility, terms, cell);
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

namespace {

/// Adds sum_j d2E/dc dkappa_j (dc dkappa_j^T + dkappa_j dc^T): with p = w dc and q = sum_j d2E/dc dkappa_j
/// dkappa_j/w it is 1/2 (p + q)(p + q)^T - 1/2 (p - q)(p - q)^T, whatever w is.
void add_cross(const SpatialCell& cell, const SpatialEdge& before, const SpatialEdge& after, PairHessian& h) {
  const Pair<double>& x = cell.cosine_by_kappa;
  const double w = std::sqrt(std::hypot(x[0], x[1]));
  if (w == 0.0) return;
  for (const double sign : {1.0, -1.0}) {
    PairGradient g;
    add_cosine_gradient(cell.turn, cell.inverse, w, g);
    WeightedCurvature(cell.turn, before.directors, after.directors, sign * x[0] / w, sign * x[1] / w)
        .add_gradient(cell.inverse, g);
    add_square(g, 0.5 * sign, h);
  }
}

}  // namespace

// d2E = dE/dc d2c + d2E/dc2 dc^2 + dE/dtau d2tau + d2E/dtau2 dtau^2
//     + sum_j dE/dkappa_j d2kappa_j + a (dkappa_1^2 - dkappa_2^2),   a = (k_1 - k_2)/2
//     + sum_j d2E/dc dkappa_j (dc dkappa_j^T + dkappa_j dc^T).
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
    add_cross(cell, before, after, h);
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
