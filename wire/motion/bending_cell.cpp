#include "wire/motion/bending_cell.hpp"

#include "numerics/cross_matrix.hpp"

#include <Eigen/Geometry>

namespace snare::wire {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Rows = CellRows;

namespace {

Directors scaled(const Directors& d, double factor) {
  return {factor * d.first, factor * d.second};
}

}  // namespace

// d/dx_{i-1} = -d/da,   d/dx_i = d/da - d/db,   d/dx_{i+1} = d/db.
CellVector to_cell(const PairGradient& g) {
  CellVector v;
  v << -g.a, g.theta_a, g.a - g.b, g.theta_b, g.b;
  return v;
}

CellMatrix to_cell(const PairHessian& h) {
  constexpr int x = Rows::before, y = Rows::middle, z = Rows::after, p = Rows::angle_before,
                q = Rows::angle_after;
  CellMatrix m;
  const auto set = [&m](int row, int column, const Matrix3d& value) {
    m.block<3, 3>(row, column) = value;
    if (row != column) m.block<3, 3>(column, row) = value.transpose();
  };
  set(x, x, h.aa);
  set(x, y, h.ab - h.aa);
  set(x, z, -h.ab);
  set(y, y, h.aa - h.ab - h.ab.transpose() + h.bb);
  set(y, z, h.ab - h.bb);
  set(z, z, h.bb);
  const auto set_angle = [&m](int angle, const Vector3d& a, const Vector3d& b) {
    m.block<3, 1>(x, angle) = -a;
    m.block<3, 1>(y, angle) = a - b;
    m.block<3, 1>(z, angle) = b;
    for (const int row : {x, y, z}) m.block<1, 3>(angle, row) = m.block<3, 1>(row, angle).transpose();
  };
  set_angle(p, h.a_theta_a, h.b_theta_a);
  set_angle(q, h.a_theta_b, h.b_theta_b);
  m(p, p) = h.theta_aa;
  m(p, q) = m(q, p) = h.theta_ab;
  m(q, q) = h.theta_bb;
  return m;
}

void add_to_bands(const RodModel& model, int i, const PairGradient& g, double factor,
                  Eigen::VectorXd& gradient) {
  constexpr int block = RodModel::block;
  if (i > 0) {
    gradient.segment<3>(block * (i - 1)) -= factor * g.a;
    gradient[block * (i - 1) + RodModel::angle] += factor * g.theta_a;
  }
  gradient.segment<3>(block * i) += factor * (g.a - g.b);
  if (i < model.edges()) {
    gradient[block * i + RodModel::angle] += factor * g.theta_b;
    gradient.segment<3>(block * (i + 1)) += factor * g.b;
  }
}

bool BendingCell::exists(const RodModel& model, int i) {
  const std::optional<End> end = model.end_of(i);
  return !end || model.properties().end(*end).kind == SpatialEnd::Kind::clamp;
}

BendingCell::BendingCell(const RodModel& model, const RodInstant& instant, const numerics::DaePoint& at,
                         int i)
    : end_(model.end_of(i)) {
  const SpatialState& state = instant.state;
  const int n = model.edges();
  // Directions and directors of the edges before and after; at an end those of the mount stand for the outer
  // edge.
  const auto add_edge = [&](int e, int angle, Directors& directors, double& inverse_length) {
    if (e < 0 || e >= n) {
      const Frame& frame = e < 0 ? *state.left_mount : *state.right_mount;
      directors.first = turned_director(frame, model.properties().end(*end_).twist_angle);
      directors.second = frame.tangent.cross(directors.first);
      return frame.tangent;
    }
    directors = instant.directors[base::at(e)];
    inverse_length = instant.inverse_lengths[base::at(e)];
    rate[angle] = at.rate[model.angle_of(e)];
    return state.frames[base::at(e)].tangent;
  };
  const Vector3d tangent_before = add_edge(i - 1, Rows::angle_before, before, inverse.a);
  const Vector3d tangent_after = add_edge(i, Rows::angle_after, after, inverse.b);
  turn = make_turn<double>(tangent_before, tangent_after);
  if (model.is_curved() && end_) {
    // What the first edge turns from its mount is integral (1 - s/h) k ds, whose centre is at h/3: of the
    // directors at 0 and at h/2 it takes 1/3 and 2/3 (W.31).
    const double mount = 2.0 / 3.0;
    const double edge = 4.0 / 3.0;
    const bool left = *end_ == End::left;
    before = scaled(before, left ? mount : edge);
    after = scaled(after, left ? edge : mount);
  }

  // Velocities of the vertices that there are.
  if (i > 0) rate.segment<3>(Rows::before) = at.y.segment<3>(model.velocity_of(i - 1));
  rate.segment<3>(Rows::middle) = at.y.segment<3>(model.velocity_of(i));
  if (i < n) rate.segment<3>(Rows::after) = at.y.segment<3>(model.velocity_of(i + 1));

  // A mount that spins with w carries the frame in which the edge e beside it bends: e' - w x e, theta' -
  // w.t.
  if (end_ && instant.spin[index_of(*end_)]) {
    spin_ = *instant.spin[index_of(*end_)];
    const int e = model.edge_at(*end_);
    edge_ = vertex(state, e + 1) - vertex(state, e);
    if (*end_ == End::left) {
      rate.segment<3>(Rows::after) -= spin_.cross(edge_);
      rate[Rows::angle_after] -= spin_.dot(tangent_after);
    } else {
      rate.segment<3>(Rows::before) += spin_.cross(edge_);
      rate[Rows::angle_before] -= spin_.dot(tangent_before);
    }
  }
  const double rest_before = i > 0 ? model.rest_length(i - 1) : 0.0;
  const double rest_after = i < n ? model.rest_length(i) : 0.0;
  length = 0.5 * (rest_before + rest_after);
}

Eigen::Vector2d BendingCell::curvature_rates() const {
  const Vector3d a = inverse.a * (rate.segment<3>(Rows::middle) - rate.segment<3>(Rows::before));
  const Vector3d b = inverse.b * (rate.segment<3>(Rows::after) - rate.segment<3>(Rows::middle));
  const Pair<double> rates =
      wire::curvature_rates(turn, before, after, a, b, rate[Rows::angle_before], rate[Rows::angle_after]);
  return {rates[0], rates[1]};
}

// d(w x e)/de = [w]_x,   d(w.t)/de = (w - (w.t) t)^T/|e|;   e = x_1 - x_0 at the left end, x_n - x_{n-1} at
// the right: the rate of x_1 has lost w x e, that of x_{n-1} has gained it.
CellMatrix BendingCell::rate_by_place() const {
  CellMatrix m = CellMatrix::Zero();
  if (spin_.isZero(0.0)) return m;
  const double size = edge_.norm();
  const Vector3d t = edge_ / size;
  const Matrix3d spinning = numerics::cross_matrix(spin_);
  const Vector3d along = (spin_ - spin_.dot(t) * t) / size;
  const bool right = *end_ == End::right;
  const int row = right ? Rows::before : Rows::after;
  const int angle = right ? Rows::angle_before : Rows::angle_after;
  const int start = right ? Rows::before : Rows::middle;  // of the edge
  const int finish = right ? Rows::middle : Rows::after;
  const double sign = right ? 1.0 : -1.0;
  m.block<3, 3>(row, start) = -sign * spinning;
  m.block<3, 3>(row, finish) = sign * spinning;
  m.block<1, 3>(angle, start) = along.transpose();
  m.block<1, 3>(angle, finish) = -along.transpose();
  return m;
}

BendingCell::Derivatives BendingCell::differentiate(int j) const {
  Derivatives d;
  const WeightedCurvature kappa = curvature(j);
  kappa.add_gradient(inverse, d.gradient);
  kappa.add_hessian(inverse, d.hessian);
  return d;
}

}  // namespace snare::wire
