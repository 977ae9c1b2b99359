#include "wire/rod_damping.hpp"

namespace snare::wire {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using numerics::DaePoint;

namespace {

Vector3d edge_of(const RodInstant& instant, int e) {
  return vertex(instant.state, e + 1) - vertex(instant.state, e);
}

/// H r by the rates of a cell's edges and angles.
PairGradient times_rates(const PairHessian& h, const BendingCell& cell) {
  const Vector3d middle = cell.rate.segment<3>(CellRows::middle);
  const Vector3d a = middle - cell.rate.segment<3>(CellRows::before);
  const Vector3d b = cell.rate.segment<3>(CellRows::after) - middle;
  const double theta_a = cell.rate[CellRows::angle_before], theta_b = cell.rate[CellRows::angle_after];
  PairGradient g;
  g.a = h.aa * a + h.ab * b + theta_a * h.a_theta_a + theta_b * h.a_theta_b;
  g.b = h.ab.transpose() * a + h.bb * b + theta_a * h.b_theta_a + theta_b * h.b_theta_b;
  g.theta_a = h.a_theta_a.dot(a) + h.b_theta_a.dot(b) + h.theta_aa * theta_a + h.theta_ab * theta_b;
  g.theta_b = h.a_theta_b.dot(a) + h.b_theta_b.dot(b) + h.theta_ab * theta_a + h.theta_bb * theta_b;
  return g;
}

void add_scaled(const PairHessian& h, double factor, PairHessian& sum) {
  sum.aa += factor * h.aa;
  sum.ab += factor * h.ab;
  sum.bb += factor * h.bb;
  sum.a_theta_a += factor * h.a_theta_a;
  sum.a_theta_b += factor * h.a_theta_b;
  sum.b_theta_a += factor * h.b_theta_a;
  sum.b_theta_b += factor * h.b_theta_b;
  sum.theta_aa += factor * h.theta_aa;
  sum.theta_ab += factor * h.theta_ab;
  sum.theta_bb += factor * h.theta_bb;
}

}  // namespace

double stretch_rate(const RodModel& model, const Vector3d& tangent, const DaePoint& at, int edge) {
  const Vector3d w = at.y.segment<3>(model.velocity_of(edge + 1)) - at.y.segment<3>(model.velocity_of(edge));
  return tangent.dot(w) / model.rest_length(edge);
}

// D = 1/2 tau EA h e'^2 with e' = t.w/h, w = v_{i+1} - v_i: the force f = tau EA e' along t on x_{i+1}, against it on x_i;
// f t by the edge d and by w, with P = (I - t t^T)/|d| = dt/dd:
//   d(f t)/dd = tau EA/h [t (P w)^T + (t.w) P],   d(f t)/dw = tau EA/h t t^T
void add_axial_damping_jacobian(const RodModel& model, const RodInstant& instant, const DaePoint& at,
                                const RodSlots& slots, std::vector<double>& values) {
  for (int e = 0; e < model.edges(); ++e) {
    const Vector3d d = edge_of(instant, e);
    const double length = d.norm();
    const Vector3d t = d / length;
    const Vector3d w = at.y.segment<3>(model.velocity_of(e + 1)) - at.y.segment<3>(model.velocity_of(e));
    const double factor = model.damping().axial_time * model.properties().axial_stiffness / model.rest_length(e);
    const Matrix3d across = (Matrix3d::Identity() - t * t.transpose()) / length;
    const Matrix3d by_edge = factor * (t * (across * w).transpose() + t.dot(w) * across);
    const Matrix3d by_rate = factor * t * t.transpose();
    // Rows and columns of x_e and x_{e+1}: the same block, negative where the vertices differ.
    for (const int row_vertex : {0, 1}) {
      for (int r = 0; r < 3; ++r) {
        for (const int column_vertex : {0, 1}) {
          for (int s = 0; s < 3; ++s) {
            const double sign = row_vertex == column_vertex ? 1.0 : -1.0;
            const int row = RodModel::block * (e + row_vertex) + r;
            const int column = RodModel::block * (e + column_vertex) + s;
            slots.add_place(row, column, sign * by_edge(r, s), values);
            slots.add_rate(row, column, sign * by_rate(r, s), values);
          }
        }
      }
    }
  }
}

std::array<double, 2> viscous_stiffness(const RodModel& model, const BendingCell& cell) {
  const double time = model.damping().bending_time;
  return {time * model.properties().bending_stiffness / cell.length,
          time * model.properties().second_bending_stiffness / cell.length};
}

// D = 1/2 k kappa'^2 with k = tau EI_j/l and kappa' = g.r, g and H the gradient and the Hessian of kappa_j, r
// the rates of what it depends on. The rows k (g.r) g have the derivatives
//   by the places  k [(g.r) H + g (H r)^T],   by the rates  k g g^T,
// and where a mount spins, r also changes with the places.
void add_bending_damping_jacobian(const RodModel& model, const BendingCell& cell, int i, double c,
                                  const RodSlots& slots, std::vector<double>& values) {
  const std::array<double, 2> stiffness = viscous_stiffness(model, cell);
  PairHessian turned;  // sum k (g.r) H
  RodSlots::CellProducts products;
  for (std::size_t j = 0; j < 2; ++j) {
    const BendingCell::Derivatives kappa = cell.differentiate(static_cast<int>(j));
    products.rate[j] = to_cell(kappa.gradient);
    products.force[j] = stiffness[j] * products.rate[j];
    products.place[j] = to_cell(times_rates(kappa.hessian, cell));
    add_scaled(kappa.hessian, products.force[j].dot(cell.rate), turned);
  }
  products.m = to_cell(turned);
  if (model.end_of(i)) {
    for (std::size_t j = 0; j < 2; ++j)
      products.place[j] += (products.rate[j].transpose() * cell.rate_by_place()).transpose();
  }
  slots.add_cell(i, products, c, values);
}

}  // namespace snare::wire
