// Gradient and Hessian of a spatial rod, gathered from its cells and edges.

#include "wire/spatial_cell.hpp"
#include "wire/spatial_rod.hpp"

#include <cmath>

namespace snare::wire {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr int block = SpatialRod::block;
constexpr int angle = SpatialRod::angle;
constexpr int next = SpatialRod::block;  // the next vertex beside one's own

/// Everything that belongs to one edge alone, collected from its two vertices and its stretching.
struct EdgeBlock {
  Vector3d force = Vector3d::Zero();      // dE/de
  Matrix3d stiffness = Matrix3d::Zero();  // d2E/de2
  Vector3d coupling = Vector3d::Zero();   // d2E/de dtheta
  double torsion = 0.0;                   // d2E/dtheta2
  double by_rest = 0.0;                   // through the cells' lengths
};

// Below, a column of the band matrix begins at its diagonal: column(j)[i - j] is the entry (i, j), i >= j.

/// Adds an edge's block to its two vertices and its angle: e = x_{e+1} - x_e, so that by (x_e, theta_e,
/// x_{e+1})
///   g = (-f, m, f),   H = [K -c -K; -c^T s c^T; -K c K]   with K, c, s: stiffness, coupling, torsion.
void scatter_edge(int e, const EdgeBlock& edge, RodAssembly& out) {
  const int first = block * e;
  double* g = out.gradient.data() + first;
  for (int r = 0; r < 3; ++r) {
    g[r] -= edge.force[r];
    g[next + r] += edge.force[r];
  }
  for (int s = 0; s < 3; ++s) {
    double* near = out.hessian.column(first + s);        // x_e
    double* far = out.hessian.column(first + next + s);  // x_{e+1}
    for (int r = s; r < 3; ++r) {
      near[r - s] += edge.stiffness(r, s);
      far[r - s] += edge.stiffness(r, s);
    }
    for (int r = 0; r < 3; ++r) near[next + r - s] -= edge.stiffness(r, s);
    near[angle - s] -= edge.coupling[s];
  }
  double* turn = out.hessian.column(first + angle);  // theta_e
  turn[0] += edge.torsion;
  for (int r = 0; r < 3; ++r) turn[next - angle + r] += edge.coupling[r];
}

/// Adds what couples the edges before (a) and after (b) vertex i: a = x_i - x_{i-1}, b = x_{i+1} - x_i, so
/// that
///   d/dx_{i-1} = -d/da,   d/dx_i = d/da - d/db,   d/dx_{i+1} = d/db.
void scatter_pair(int i, const PairHessian& h, RodAssembly& out) {
  constexpr int next_angle = next + angle, second = 2 * next;  // theta_i and x_{i+1} beside x_{i-1}
  const int first = block * (i - 1);
  for (int s = 0; s < 3; ++s) {
    double* left = out.hessian.column(first + s);           // x_{i-1}
    double* middle = out.hessian.column(first + next + s);  // x_i
    for (int r = 0; r < 3; ++r) {
      left[next + r - s] += h.ab(s, r);
      left[second + r - s] -= h.ab(s, r);
      middle[next + r - s] += h.ab(s, r);
    }
    for (int r = s; r < 3; ++r) middle[r - s] -= h.ab(r, s) + h.ab(s, r);
    left[next_angle - s] -= h.a_theta_b[s];
    middle[angle - s] += h.a_theta_b[s];
  }
  double* turn = out.hessian.column(first + angle);  // theta_{i-1}
  for (int r = 0; r < 3; ++r) {
    turn[next - angle + r] -= h.b_theta_a[r];
    turn[second - angle + r] += h.b_theta_a[r];
  }
  turn[next_angle - angle] += h.theta_ab;
}

void reset(RodAssembly& out, int unknowns, const std::array<bool, 3>& wanted) {
  out.energy = 0.0;
  out.gradient.setZero(unknowns);
  if (out.hessian.order() != unknowns || out.hessian.half_bandwidth() != SpatialRod::half_bandwidth) {
    out.hessian = numerics::SymmetricBandMatrix(unknowns, SpatialRod::half_bandwidth);
  } else {
    out.hessian.set_zero();
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (wanted[k]) out.control_columns[k].setZero(unknowns);
  }
  out.control_gradient.setZero();
  out.control_hessian.setZero();
}

/// dl/dS_k of vertex i's cell, l = (h_{i-1} + h_i)/2; false: the cell feels no control.
bool feels_controls(const MaterialMesh& mesh, int i, int n, std::array<double, 3>& share) {
  bool any = false;
  for (int k = 0; k < 3; ++k) {
    const double before = i > 0 ? mesh.rest_length_derivative(i - 1, k) : 0.0;
    const double after = i < n ? mesh.rest_length_derivative(i, k) : 0.0;
    share[base::at(k)] = 0.5 * (before + after);
    any = any || share[base::at(k)] != 0.0;
  }
  return any;
}

}  // namespace

void SpatialRod::assemble(const SpatialState& state, const std::array<bool, 3>& wanted,
                          RodAssembly& out) const {
  reset(out, unknowns(), wanted);
  const int n = mesh_.edges();
  const CellTerms terms(properties_, strains_);
  const double ea = terms.axial_stiffness;
  const Vector3d& weight = properties_.weight;
  EdgeBlock pending;  // of the edge before the vertex at hand

  // Stretching and weight of edge e, whose cells are complete; then its block goes to its vertices.
  const auto finish_edge = [&](int e, const SpatialEdge& edge, EdgeBlock& edge_block) {
    // E = 1/2 EA (l/h - 1)^2 h: dE/de = T t with T = EA (l/h - 1) (W.3).
    const double stretch = edge.length / edge.rest;
    const double tension = ea * (stretch - 1.0);
    const double axial = ea / edge.rest;
    const double lateral = tension * edge.inverse_length;
    edge_block.force += tension * edge.tangent;
    // d2E/de2 = EA/h t t^T + T (I - t t^T)/l
    const Vector3d along = (axial - lateral) * edge.tangent;
    edge_block.stiffness += along * edge.tangent.transpose();
    edge_block.stiffness.diagonal().array() += lateral;
    scatter_edge(e, edge_block, out);
    // Weight: -w.(x_e + x_{e+1})/2 h, half of it on either vertex (W.8).
    const double work = 0.5 * weight.dot(vertex(state, e) + vertex(state, e + 1));
    out.energy += 0.5 * ea * (stretch - 1.0) * (stretch - 1.0) * edge.rest - edge.rest * work;
    const Vector3d half_weight = (0.5 * edge.rest) * weight;
    out.gradient.segment<3>(block * e) -= half_weight;
    out.gradient.segment<3>(block * (e + 1)) -= half_weight;

    // By the rest length h, through the edge, dE/dh = -EA ((l/h)^2 - 1)/2 and d2E/dh de = -EA l/h^2 t, and
    // through its two cells; h is linear in the controls (W.30).
    const double by_rest = edge_block.by_rest - 0.5 * ea * (stretch * stretch - 1.0) - work;
    for (int k = 0; k < 3; ++k) {
      const double share = mesh_.rest_length_derivative(e, k);
      if (share == 0.0) continue;
      out.control_gradient[k] += share * by_rest;
      for (int m = 0; m < 3; ++m) {
        out.control_hessian(k, m) += share * mesh_.rest_length_derivative(e, m) * axial * stretch * stretch;
      }
      if (!wanted[base::at(k)]) continue;
      Eigen::VectorXd& column = out.control_columns[base::at(k)];
      const Vector3d pull = (-share * axial * stretch) * edge.tangent;
      column.segment<3>(block * e) -= pull + (0.5 * share) * weight;
      column.segment<3>(block * (e + 1)) += pull - (0.5 * share) * weight;
    }
  };

  // d2E/dS_k dS_m of a cell's length, and d gradient/dS_k.
  const auto add_cell_controls = [&](int i, const SpatialCell& cell, const SpatialEdge& before,
                                     const SpatialEdge& after) {
    std::array<double, 3> share{};
    if (!feels_controls(mesh_, i, n, share)) return;
    for (int k = 0; k < 3; ++k) {
      for (int m = 0; m < 3; ++m) {
        out.control_hessian(k, m) += share[base::at(k)] * share[base::at(m)] * cell.by_length_twice;
      }
    }
    if (!wanted[0] && !wanted[1] && !wanted[2]) return;
    const PairGradient slope = gradient_by_length(cell, before, after);
    for (std::size_t k = 0; k < 3; ++k) {
      if (!wanted[k] || share[k] == 0.0) continue;
      Eigen::VectorXd& column = out.control_columns[k];
      const int row = block * i;
      if (i > 0) {
        const int before_row = block * (i - 1);
        column.segment<3>(before_row) -= share[k] * slope.a;
        column.segment<3>(row) += share[k] * slope.a;
        column[before_row + angle] += share[k] * slope.theta_a;
      }
      if (i < n) {
        column.segment<3>(row) -= share[k] * slope.b;
        column.segment<3>(row + next) += share[k] * slope.b;
        column[row + angle] += share[k] * slope.theta_b;
      }
    }
  };

  const auto add_cell = [&](int i, const SpatialCell& cell, const SpatialEdge& before,
                            const SpatialEdge& after) {
    EdgeBlock following;
    if (cell.bends || cell.twists) {
      out.energy += cell.energy;
      const PairGradient g = gradient_of(cell, before, after);
      const PairHessian h = hessian_of(cell, before, after);
      pending.force += g.a;
      pending.stiffness += h.aa;
      pending.coupling += h.a_theta_a;
      pending.torsion += h.theta_aa;
      pending.by_rest += 0.5 * cell.by_length;
      following.force = g.b;
      following.stiffness = h.bb;
      following.coupling = h.b_theta_b;
      following.torsion = h.theta_bb;
      following.by_rest = 0.5 * cell.by_length;
      if (i > 0) out.gradient[block * (i - 1) + angle] += g.theta_a;
      if (i < n) out.gradient[block * i + angle] += g.theta_b;
      if (i > 0 && i < n) scatter_pair(i, h, out);
      add_cell_controls(i, cell, before, after);
    }
    if (i > 0) finish_edge(i - 1, before, pending);
    pending = following;
  };
  visit_cells(mesh_, state, terms, add_cell);

  // Mounts that give along x: 1/2 k (x - X)^2 (W.6).
  for (const End which : ends) {
    const SpatialEnd& end = properties_.end(which);
    if (!end.gives()) continue;
    const int row = row_of(which);
    out.energy += end.spring_energy(state.q[row]);
    out.gradient[row] += end.translational_stiffness * (state.q[row] - end.position.x());
    out.hessian.add(row, row, end.translational_stiffness);
  }
}

void SpatialRod::hold_mounts(RodAssembly& assembly) const {
  const auto hold = [&assembly](int row) {
    assembly.gradient[row] = 0.0;
    assembly.hessian.hold(row);
    for (Eigen::VectorXd& column : assembly.control_columns) {
      if (column.size() > row) column[row] = 0.0;
    }
  };
  const auto mount = [&](const SpatialEnd& end, int row) {
    if (end.kind == SpatialEnd::Kind::free) return;
    if (std::isinf(end.translational_stiffness)) hold(row);
    hold(row + 1);
    hold(row + 2);
  };
  mount(properties_.left, row_of(End::left));
  mount(properties_.right, row_of(End::right));
  hold(row_of(End::right) + angle);  // of no edge
}

}  // namespace snare::wire
