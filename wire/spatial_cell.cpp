#include "wire/spatial_cell.hpp"

#include "wire/twist.hpp"

#include <Eigen/Geometry>

#include <cmath>

namespace snare::wire {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Stiffness of a cell of length l with a mount's flexibility f in series:                    theory.md (W.6)
///   1/k = l/B + f,   dk/dl = -k^2/B,   d2k/dl2 = -2 k (dk/dl)/B
struct SeriesStiffness {
  double k = 0.0;
  double first = 0.0;   // dk/dl
  double second = 0.0;  // d2k/dl2
};

SeriesStiffness in_series(double cell_length, double stiffness, double flexibility) {
  SeriesStiffness s;
  s.k = 1.0 / (cell_length / stiffness + flexibility);
  s.first = -s.k * s.k / stiffness;
  s.second = -2.0 * s.k * s.first / stiffness;
  return s;
}

/// Bending of a cell.                                                                        theory.md (W.27)
///   E = 1/4 (k_1 + k_2)|kb|^2 + 1/4 (k_1 - k_2)(kappa_1^2 - kappa_2^2) + sum_j k_j n_j l (n_j l/2 - kappa_j)
/// n_j: natural curvatures. ' below is d/dl.
void bend(const SpatialEdge& before, const SpatialEdge& after, double l, double flexibility, const CellTerms& terms,
          SpatialCell& cell) {
  const SpatialRodProperties& p = terms.properties;
  cell.bends = true;
  const SeriesStiffness k1 = in_series(l, p.bending_stiffness, flexibility);
  const SeriesStiffness k2 = terms.directed ? in_series(l, p.second_bending_stiffness, flexibility) : k1;

  // Round part, 1/4 (k_1 + k_2)|kb|^2 with |kb|^2 = 4 (1 - c)/(1 + c), taken from kb to keep its digits:
  //   d|kb|^2/dc = -8/chi^2,   d2|kb|^2/dc2 = 16/chi^3 = -2 (d|kb|^2/dc)/chi.
  const double square = cell.turn.binormal.squaredNorm();
  const double inverse_chi = 1.0 / cell.turn.chi;
  const double slope = -8.0 * inverse_chi * inverse_chi;
  const double mean = 0.25 * (k1.k + k2.k);
  const double mean_first = 0.25 * (k1.first + k2.first);
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
  const Vector2d kappa = curvatures(cell.turn, before.directors, after.directors);
  const Vector2d& natural = p.natural_curvature;
  const double difference = kappa[0] * kappa[0] - kappa[1] * kappa[1];
  cell.anisotropy = 0.5 * (k1.k - k2.k);
  const double anisotropy_first = 0.5 * (k1.first - k2.first);
  cell.energy += 0.5 * cell.anisotropy * difference;
  cell.by_kappa = cell.anisotropy * Vector2d(kappa[0], -kappa[1]);
  cell.by_length += 0.5 * anisotropy_first * difference;
  cell.by_length_twice += 0.25 * (k1.second - k2.second) * difference;
  cell.kappa_by_length = anisotropy_first * Vector2d(kappa[0], -kappa[1]);

  // Natural curvature, N = k n l (n l/2 - kappa):
  //   dN/dkappa = -k n l,   d2N/dkappa dl = -n (k' l + k),
  //   dN/dl = 1/2 n^2 l (k' l + 2 k) - n kappa (k' l + k),
  //   d2N/dl2 = 1/2 n^2 (k'' l^2 + 4 k' l + 2 k) - n kappa (k'' l + 2 k').
  const auto add_natural = [&](int j, const SeriesStiffness& k) {
    const double n = natural[j];
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

/// Twisting of a cell, E = 1/2 k s^2 with s = tau - n l, n the natural twist.                theory.md (W.27)
///   dE/dtau = k s,   d2E/dtau2 = k,   d2E/dtau dl = k' s - k n,
///   dE/dl = 1/2 k' s^2 - k n s,   d2E/dl2 = 1/2 k'' s^2 - 2 k' n s + k n^2
void twist(double tau, double l, double flexibility, const SpatialRodProperties& p, SpatialCell& cell) {
  cell.twists = true;
  const SeriesStiffness k = in_series(l, p.torsional_stiffness, flexibility);
  const double natural = p.natural_twist;
  const double strain = tau - natural * l;
  cell.energy += 0.5 * k.k * strain * strain;
  cell.torque = k.k * strain;
  cell.twist_stiffness = k.k;
  cell.torque_by_length = k.first * strain - k.k * natural;
  cell.by_length += 0.5 * k.first * strain * strain - k.k * natural * strain;
  cell.by_length_twice += 0.5 * k.second * strain * strain - 2.0 * k.first * natural * strain + k.k * natural * natural;
}

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

SpatialCell cell_at(int i, int n, const SpatialEdge& before, const SpatialEdge& after, const SpatialState& state,
                    const CellTerms& terms) {
  const SpatialRodProperties& p = terms.properties;
  SpatialCell cell;
  const SpatialEnd* end = i == 0 ? &p.left : (i == n ? &p.right : nullptr);
  if (end != nullptr && !end->orients()) return cell;
  // l = (h_{i-1} + h_i)/2; at a mount half of the one rest length there is.
  const double length = end == nullptr ? 0.5 * (before.rest + after.rest) : 0.5 * (i == 0 ? after.rest : before.rest);
  cell.turn = make_turn(before.tangent, after.tangent);
  cell.inverse = {before.inverse_length, after.inverse_length};
  const double tau = after.theta - before.theta + state.reference_twist[base::at(i)];  // (W.26)
  twist(tau, length, end == nullptr ? 0.0 : 1.0 / end->twisting_stiffness, p, cell);
  if (!terms.bends) return cell;
  if (end == nullptr) {
    bend(before, after, length, 0.0, terms, cell);
  } else if (end->kind == SpatialEnd::Kind::clamp) {
    bend(before, after, length, 1.0 / end->rotational_stiffness, terms, cell);
  }
  return cell;
}

namespace {

/// by_c dc + sum_j by_kappa_j dkappa_j + by_tau dtau.
PairGradient weighted_gradient(const SpatialCell& cell, const SpatialEdge& before, const SpatialEdge& after,
                               double by_c, const Vector2d& by_kappa, double by_tau) {
  PairGradient g;
  if (cell.bends) add_cosine_gradient(cell.turn, cell.inverse, by_c, g);
  if (cell.directed)
    WeightedCurvature(cell.turn, before.directors, after.directors, by_kappa).add_gradient(cell.inverse, g);
  if (cell.twists) add_twist_gradient(cell.turn, cell.inverse, by_tau, g);
  return g;
}

}  // namespace

// dE = dE/dc dc + sum_j dE/dkappa_j dkappa_j + dE/dtau dtau.
PairGradient gradient_of(const SpatialCell& cell, const SpatialEdge& before, const SpatialEdge& after) {
  return weighted_gradient(cell, before, after, cell.by_cosine, cell.by_kappa, cell.torque);
}

// The same with d2E/dc dl, d2E/dkappa_j dl, d2E/dtau dl as factors.
PairGradient gradient_by_length(const SpatialCell& cell, const SpatialEdge& before, const SpatialEdge& after) {
  return weighted_gradient(cell, before, after, cell.cosine_by_length, cell.kappa_by_length, cell.torque_by_length);
}

// d2E = dE/dc d2c + d2E/dc2 dc^2 + dE/dtau d2tau + d2E/dtau2 dtau^2
//     + sum_j dE/dkappa_j d2kappa_j + a (dkappa_1^2 - dkappa_2^2),   a = (k_1 - k_2)/2.
PairHessian hessian_of(const SpatialCell& cell, const SpatialEdge& before, const SpatialEdge& after) {
  PairHessian h;
  if (cell.bends) add_cosine_hessian(cell.turn, cell.inverse, cell.by_cosine, cell.by_cosine_twice, h);
  if (cell.twists) add_twist_hessian(cell.turn, cell.inverse, cell.torque, cell.twist_stiffness, h);
  if (cell.directed) {
    WeightedCurvature(cell.turn, before.directors, after.directors, cell.by_kappa).add_hessian(cell.inverse, h);
    PairGradient g1;
    PairGradient g2;
    WeightedCurvature(cell.turn, before.directors, after.directors, {1.0, 0.0}).add_gradient(cell.inverse, g1);
    WeightedCurvature(cell.turn, before.directors, after.directors, {0.0, 1.0}).add_gradient(cell.inverse, g2);
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
    moment += WeightedCurvature(cell.turn, before.directors, after.directors, cell.by_kappa).by_rotation();
  }
  if (cell.twists) moment += cell.torque * cell.turn.mean;
  return moment;
}

}  // namespace snare::wire
