#include "coupling/dynamics/mount_part.hpp"

namespace snare::coupling {

using Eigen::Vector3d;
using Eigen::VectorXd;
using multibody::Matrix6X;
using multibody::Wrench;
using numerics::DaeKind;
using numerics::DaePoint;
using numerics::VectorView;

namespace {

// Unknowns of the half cell: two vertices, whose rates are unknowns themselves, an angle, and of a rod of higher order
// two curvatures.
constexpr std::size_t cell_vertices = 6;
using CellVector = Eigen::Matrix<double, wire::MountCell::count, 1>;

/// Linear part of J times changes of the unknowns.
Vector3d linear_change(const Matrix6X& J, const std::vector<int>& unknowns, const VectorXd& values) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 0; k < unknowns.size(); ++k)
    sum += J.col(static_cast<Eigen::Index>(k)).tail<3>() * values[unknowns[k]];
  return sum;
}

}  // namespace

MountPart::MountPart(std::string name, MovingFrame mount, wire::RodPart& rod, wire::End end,
                     const MotionOptions& options)
    : Constraint(std::move(name), std::move(mount), options), rod_(rod), end_(end) {
  rod_.carry(end, [this](const VectorView& y) {
    const MovingFrame::State s = carrier().state(y);
    return wire::MountMotion{{s.X_WF.R.col(0), s.X_WF.R.col(1)}, s.angular};
  });
}

void MountPart::declare(numerics::DaeLayout& layout) {
  const std::vector<std::string> axes{"x", "y", "z"};
  set_multipliers(layout.add({name() + " force", axes, 3, DaeKind::algebraic, options().force_tolerance, 0}));
  stabiliser_ = layout.add({name() + " stabiliser", axes, 3, DaeKind::algebraic, numerics::no_tolerance, 0});
}

void MountPart::append_curvatures(std::vector<int>& list) const {
  if (!rod_.model().is_curved()) return;
  for (int j = 0; j < 2; ++j) list.push_back(rod_.model().curvature_of(vertex()) + j);
}

std::vector<int> MountPart::places() const {
  const int i = vertex(), j = end_ == wire::End::left ? 1 : i - 1;
  std::vector<int> list;
  list.reserve(9);
  for (int k = 0; k < 3; ++k) list.push_back(rod_.position_of(i) + k);
  for (int k = 0; k < 3; ++k) list.push_back(rod_.position_of(j) + k);
  list.push_back(rod_.end_angle(end_));
  append_curvatures(list);
  return list;
}

std::vector<int> MountPart::balances() const {
  const int i = vertex(), j = end_ == wire::End::left ? 1 : i - 1;
  std::vector<int> list;
  list.reserve(9);
  for (int k = 0; k < 3; ++k) list.push_back(rod_.velocity_of(i) + k);
  for (int k = 0; k < 3; ++k) list.push_back(rod_.velocity_of(j) + k);
  list.push_back(rod_.end_angle(end_));
  append_curvatures(list);
  return list;
}

void MountPart::sparsity(std::vector<std::pair<int, int>>& entries) const {
  const std::vector<int> q = carrier().coordinates(), v = carrier().velocities(), x = places(), rows = balances();
  const int end = rod_.position_of(vertex()), speed = rod_.velocity_of(vertex());
  for (int i = 0; i < 3; ++i) {
    // Force and stabiliser on the end, and the rows of the constraint.
    entries.emplace_back(force() + i, force() + i);
    entries.emplace_back(stabiliser() + i, stabiliser() + i);
    entries.emplace_back(end + i, stabiliser() + i);
    entries.emplace_back(speed + i, force() + i);
    entries.emplace_back(force() + i, end + i);
    entries.emplace_back(stabiliser() + i, speed + i);
    for (const int column : q) {
      entries.emplace_back(force() + i, column);
      entries.emplace_back(stabiliser() + i, column);
    }
    for (const int column : v) entries.emplace_back(stabiliser() + i, column);
  }
  // The half cell feels the mount turn and spin.
  for (const int row : rows) {
    for (const int column : q) entries.emplace_back(row, column);
    for (const int column : v) entries.emplace_back(row, column);
  }
  // The carrier feels the wire's force and the cell's moment.
  if (!carrier().moves_freely()) return;
  for (const int row : v) {
    for (const int column : q) entries.emplace_back(row, column);
    for (const int column : v) entries.emplace_back(row, column);
    for (const int column : x) entries.emplace_back(row, column);
    for (std::size_t k = 0; k < cell_vertices; ++k) entries.emplace_back(row, rows[k]);
    for (int i = 0; i < 3; ++i) entries.emplace_back(row, force() + i);
  }
}

void MountPart::residual(const DaePoint& at, Eigen::Ref<VectorXd> rows) {
  const int i = vertex();
  const Vector3d f = at.y.segment<3>(force());
  const MovingFrame::State s = carrier().state(at.y);
  // The end: m v' + ... - f = 0, x' - v - mu = 0.
  rows.segment<3>(rod_.velocity_of(i)) -= f;
  rows.segment<3>(rod_.position_of(i)) -= at.y.segment<3>(stabiliser());
  // The constraint: x - p_WM = 0, v - v_M = 0.
  rows.segment<3>(force()) += at.y.segment<3>(rod_.position_of(i)) - s.X_WF.p;
  rows.segment<3>(stabiliser()) += at.y.segment<3>(rod_.velocity_of(i)) - s.linear;
  // The carrier: -J^T (M, -f), M the moment of the half cell on the mount.
  if (carrier().moves_freely()) carrier().push(carrier().jacobian(at.y), {rod_.mount_moment(at, end_), -f}, rows);
}

void MountPart::jacobian(const DaePoint& at, double c, std::vector<double>& values) {
  const numerics::PatternValues into(slots(), values);
  const std::vector<int> q = carrier().coordinates(), v = carrier().velocities(), x = places(), rows = balances();
  const MovingFrame::Derivatives d = carrier().differentiate(at.y);
  const wire::MountCell cell = rod_.mount_cell(at, end_);
  const int end = rod_.position_of(vertex()), speed = rod_.velocity_of(vertex());
  const auto add_to_cell = [&](int column, const CellVector& by) {
    for (std::size_t r = 0; r < rows.size(); ++r) into.add(rows[r], column, by[static_cast<Eigen::Index>(r)]);
  };
  // The end and the constraint, by their own unknowns.
  for (int i = 0; i < 3; ++i) {
    into.add(speed + i, force() + i, -1.0);
    into.add(end + i, stabiliser() + i, -1.0);
    into.add(force() + i, end + i, 1.0);
    into.add(stabiliser() + i, speed + i, 1.0);
  }
  // Constraint, half cell and the wrench (M, -f) by coordinates and velocities of the carrier, through the turn, the
  // shift and the spin of the mount.
  Matrix6X wrench_by_q = Matrix6X::Zero(6, d.place.cols()), wrench_by_v = Matrix6X::Zero(6, d.jacobian.cols());
  for (std::size_t k = 0; k < q.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    const Vector3d turn = d.place.col(column).head<3>(), spin = d.motion.col(column).head<3>();
    const Vector3d shift = d.place.col(column).tail<3>(), velocity = d.motion.col(column).tail<3>();
    for (int i = 0; i < 3; ++i) {
      into.add(force() + i, q[k], -shift[i]);
      into.add(stabiliser() + i, q[k], -velocity[i]);
    }
    add_to_cell(q[k], cell.rows_by_turn * turn + cell.rows_by_spin * spin);
    wrench_by_q.col(column).head<3>() = cell.moment_by_turn * turn + cell.moment_by_spin * spin;
  }
  for (std::size_t k = 0; k < v.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    const Vector3d spin = d.jacobian.col(column).head<3>(), velocity = d.jacobian.col(column).tail<3>();
    for (int i = 0; i < 3; ++i) into.add(stabiliser() + i, v[k], -velocity[i]);
    add_to_cell(v[k], cell.rows_by_spin * spin);
    wrench_by_v.col(column).head<3>() = cell.moment_by_spin * spin;
  }
  if (!carrier().moves_freely()) return;
  // Rows of the carrier, -J^T (M, -f): J turns with q, M changes with the mount and with the half cell.
  const Wrench wrench{cell.moment, -at.y.segment<3>(force())};
  const Eigen::MatrixXd by_q = d.force(wrench) + d.jacobian.transpose() * wrench_by_q;
  const Eigen::MatrixXd by_v = d.jacobian.transpose() * wrench_by_v;
  const Eigen::MatrixXd by_place = d.jacobian.topRows<3>().transpose() * cell.moment_by;
  const Eigen::MatrixXd by_rate = d.jacobian.topRows<3>().transpose() * cell.moment_by_rate;
  for (std::size_t r = 0; r < v.size(); ++r) {
    const auto row = static_cast<Eigen::Index>(r);
    for (std::size_t k = 0; k < q.size(); ++k) into.add(v[r], q[k], -by_q(row, static_cast<Eigen::Index>(k)));
    for (std::size_t k = 0; k < v.size(); ++k) into.add(v[r], v[k], -by_v(row, static_cast<Eigen::Index>(k)));
    for (std::size_t k = 0; k < x.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      // The rates of the vertices are the unknowns v, that of the angle is its y'.
      const bool angle = k >= cell_vertices;
      into.add(v[r], x[k], -by_place(row, column) - (angle ? c * by_rate(row, column) : 0.0));
      if (!angle) into.add(v[r], rows[k], -by_rate(row, column));
    }
    const Vector3d linear = d.jacobian.col(row).tail<3>();
    for (int i = 0; i < 3; ++i) into.add(v[r], force() + i, linear[i]);
  }
}

VectorXd MountPart::velocity_error(const VectorView& y, const VectorXd& dv) const {
  Vector3d result = dv.segment<3>(rod_.velocity_of(vertex()));
  if (carrier().moves_freely()) result -= linear_change(carrier().jacobian(y), carrier().velocities(), dv);
  return result;
}

VectorXd MountPart::acceleration_bias(const VectorView& y, const VectorXd& rate) const {
  return -linear_change(carrier().differentiate(y).motion, carrier().coordinates(), rate);
}

void MountPart::apply_impulse(const VectorView& y, const VectorXd& multipliers, VectorXd& dv) const {
  dv.segment<3>(rod_.velocity_of(vertex())) += multipliers / rod_.model().inertia_of(vertex());
  if (carrier().moves_freely()) carrier().apply_impulse(y, carrier().jacobian(y), {Vector3d::Zero(), -multipliers}, dv);
}

Wrench MountPart::wrench(const VectorView& y) const {
  return {Vector3d::Zero(), y.segment<3>(force())};
}

double MountPart::gap(const VectorView& y) const {
  return (y.segment<3>(rod_.position_of(vertex())) - carrier().state(y).X_WF.p).norm();
}

}  // namespace snare::coupling
