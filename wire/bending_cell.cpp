#include "wire/bending_cell.hpp"

#include "numerics/cross_matrix.hpp"

#include <Eigen/Geometry>

namespace snare::wire {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Rows = CellRows;

// d/dx_{i-1} = -d/da,   d/dx_i = d/da - d/db,   d/dx_{i+1} = d/db.
CellVector to_cell(const PairGradient& g) {
  CellVector v;
  v << -g.a, g.theta_a, g.a - g.b, g.theta_b, g.b;
  return v;
}

CellMatrix to_cell(const PairHessian& h) {
  CellMatrix m = CellMatrix::Zero();
  const Matrix3d ba = h.ab.transpose();
  m.block<3, 3>(Rows::before, Rows::before) = h.aa;
  m.block<3, 3>(Rows::before, Rows::middle) = -h.aa + h.ab;
  m.block<3, 3>(Rows::before, Rows::after) = -h.ab;
  m.block<3, 3>(Rows::middle, Rows::before) = -h.aa + ba;
  m.block<3, 3>(Rows::middle, Rows::middle) = h.aa - h.ab - ba + h.bb;
  m.block<3, 3>(Rows::middle, Rows::after) = h.ab - h.bb;
  m.block<3, 3>(Rows::after, Rows::before) = -ba;
  m.block<3, 3>(Rows::after, Rows::middle) = ba - h.bb;
  m.block<3, 3>(Rows::after, Rows::after) = h.bb;
  const auto with_angle = [&m](int angle, const Vector3d& a, const Vector3d& b) {
    m.block<3, 1>(Rows::before, angle) = -a;
    m.block<3, 1>(Rows::middle, angle) = a - b;
    m.block<3, 1>(Rows::after, angle) = b;
    m.block<1, 3>(angle, Rows::before) = -a.transpose();
    m.block<1, 3>(angle, Rows::middle) = (a - b).transpose();
    m.block<1, 3>(angle, Rows::after) = b.transpose();
  };
  with_angle(Rows::angle_before, h.a_theta_a, h.b_theta_a);
  with_angle(Rows::angle_after, h.a_theta_b, h.b_theta_b);
  m(Rows::angle_before, Rows::angle_before) = h.theta_aa;
  m(Rows::angle_before, Rows::angle_after) = m(Rows::angle_after, Rows::angle_before) = h.theta_ab;
  m(Rows::angle_after, Rows::angle_after) = h.theta_bb;
  return m;
}

bool BendingCell::exists(const RodModel& model, int i) {
  const std::optional<End> end = model.end_of(i);
  return !end || model.properties().end(*end).kind == SpatialEnd::Kind::clamp;
}

BendingCell::BendingCell(const RodModel& model, const RodInstant& instant, const numerics::DaePoint& at, int i)
    : end_(model.end_of(i)) {
  const SpatialState& state = instant.state;
  const int n = model.edges();
  // Directions and directors of the edges before and after; at an end those of the mount stand for the outer
  // edge.
  const auto add_edge = [&](int e, int angle, Directors& directors, double& inverse_length) {
    const bool mount = e < 0 || e >= n;
    const Frame frame = mount ? (e < 0 ? *state.left_mount : *state.right_mount) : state.frames[base::at(e)];
    const double theta =
        mount ? model.properties().end(*end_).twist_angle : state.q[RodModel::block * e + RodModel::angle];
    directors.first = turned_director(frame, theta);
    directors.second = frame.tangent.cross(directors.first);
    if (!mount) {
      inverse_length = 1.0 / (vertex(state, e + 1) - vertex(state, e)).norm();
      rate[angle] = at.rate[model.angle_of(e)];
    }
    return frame.tangent;
  };
  const Vector3d tangent_before = add_edge(i - 1, Rows::angle_before, before, inverse.a);
  const Vector3d tangent_after = add_edge(i, Rows::angle_after, after, inverse.b);
  turn = make_turn(tangent_before, tangent_after);

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
