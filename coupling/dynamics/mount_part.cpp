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

// Of a stabilising multiplier: its round-off grows as one over the step, and what it does to others is tested there.
constexpr double no_tolerance = 1e6;

/// Sum of columns of J times changes.
Vector3d linear_change(const Matrix6X& J, const std::vector<int>& unknowns, const VectorXd& values) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 0; k < unknowns.size(); ++k)
    sum += J.col(static_cast<Eigen::Index>(k)).tail<3>() * values[unknowns[k]];
  return sum;
}

}  // namespace

MountPart::MountPart(std::string name, MovingFrame mount, wire::RodPart& rod, bool right,
                     const MotionOptions& options)
    : name_(std::move(name)), mount_(std::move(mount)), rod_(rod), right_(right), options_(options) {
  rod_.carry(right, [this](const VectorView& y) {
    const MovingFrame::State s = mount_.state(y);
    return wire::MountMotion{{s.X_WF.R.col(0), s.X_WF.R.col(1)}, s.angular};
  });
}

void MountPart::declare(numerics::DaeLayout& layout) {
  const std::vector<std::string> axes{"x", "y", "z"};
  first_ = layout.add({name_ + " force", axes, 3, DaeKind::algebraic, options_.force_tolerance, 0});
  layout.add({name_ + " stabiliser", axes, 3, DaeKind::algebraic, no_tolerance, 0});
}

std::vector<int> MountPart::places() const {
  const int i = vertex(), j = right_ ? i - 1 : 1;
  std::vector<int> list;
  for (int k = 0; k < 3; ++k) list.push_back(rod_.position_of(i) + k);
  for (int k = 0; k < 3; ++k) list.push_back(rod_.position_of(j) + k);
  list.push_back(rod_.end_angle(right_));
  return list;
}

std::vector<int> MountPart::balances() const {
  const int i = vertex(), j = right_ ? i - 1 : 1;
  std::vector<int> list;
  for (int k = 0; k < 3; ++k) list.push_back(rod_.velocity_of(i) + k);
  for (int k = 0; k < 3; ++k) list.push_back(rod_.velocity_of(j) + k);
  list.push_back(rod_.end_angle(right_));
  return list;
}

void MountPart::sparsity(std::vector<std::pair<int, int>>& entries) const {
  const std::vector<int> q = mount_.coordinates(), v = mount_.velocities(), x = places(), rows = balances();
  const int end = rod_.position_of(vertex()), speed = rod_.velocity_of(vertex());
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 2; ++k) entries.emplace_back(first_ + 3 * k + i, first_ + 3 * k + i);
    entries.emplace_back(end + i, first_ + 3 + i);
    entries.emplace_back(speed + i, first_ + i);
    entries.emplace_back(first_ + i, end + i);
    entries.emplace_back(first_ + 3 + i, speed + i);
    for (const int column : q) {
      entries.emplace_back(first_ + i, column);
      entries.emplace_back(first_ + 3 + i, column);
    }
    for (const int column : v) entries.emplace_back(first_ + 3 + i, column);
  }
  for (const int row : rows) {
    for (const int column : q) entries.emplace_back(row, column);
    for (const int column : v) entries.emplace_back(row, column);
  }
  if (!mount_.moves_freely()) return;
  for (const int row : v) {
    for (const int column : q) entries.emplace_back(row, column);
    for (const int column : v) entries.emplace_back(row, column);
    for (const int column : x) entries.emplace_back(row, column);
    for (std::size_t k = 0; k < 6; ++k) entries.emplace_back(row, rows[k]);
    for (int i = 0; i < 3; ++i) entries.emplace_back(row, first_ + i);
  }
}

void MountPart::residual(const DaePoint& at, Eigen::Ref<VectorXd> rows) {
  const int i = vertex();
  const Vector3d force = at.y.segment<3>(first_);
  const MovingFrame::State s = mount_.state(at.y);
  rows.segment<3>(rod_.velocity_of(i)) -= force;
  rows.segment<3>(rod_.position_of(i)) -= at.y.segment<3>(first_ + 3);
  rows.segment<3>(first_) += at.y.segment<3>(rod_.position_of(i)) - s.X_WF.p;
  rows.segment<3>(first_ + 3) += at.y.segment<3>(rod_.velocity_of(i)) - s.linear;
  if (mount_.moves_freely())
    mount_.push(mount_.jacobian(at.y), {rod_.mount_moment(at, right_), -force}, rows);
}

void MountPart::jacobian(const DaePoint& at, double c, std::vector<double>& values) {
  const auto add = [&](int row, int column, double value) {
    const int slot = pattern_->slot(row, column);
    if (slot >= 0) values[static_cast<std::size_t>(slot)] += value;
  };
  const std::vector<int> q = mount_.coordinates(), v = mount_.velocities(), x = places(), rows = balances();
  const MovingFrame::Derivatives d = mount_.differentiate(at.y);
  const wire::RodPart::MountCell cell = rod_.mount_cell(at, right_);
  const int end = rod_.position_of(vertex()), speed = rod_.velocity_of(vertex());
  for (int i = 0; i < 3; ++i) {
    add(speed + i, first_ + i, -1.0);
    add(end + i, first_ + 3 + i, -1.0);
    add(first_ + i, end + i, 1.0);
    add(first_ + 3 + i, speed + i, 1.0);
  }
  Matrix6X wrench_by_q = Matrix6X::Zero(6, d.place.cols()),
           wrench_by_v = Matrix6X::Zero(6, d.jacobian.cols());
  for (std::size_t k = 0; k < q.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    const Vector3d turn = d.place.col(column).head<3>(), spin = d.motion.col(column).head<3>();
    for (int i = 0; i < 3; ++i) {
      add(first_ + i, q[k], -d.place(3 + i, column));
      add(first_ + 3 + i, q[k], -d.motion(3 + i, column));
    }
    const Eigen::Matrix<double, 7, 1> on_rod = cell.rows_by_turn * turn + cell.rows_by_spin * spin;
    for (std::size_t r = 0; r < rows.size(); ++r) add(rows[r], q[k], on_rod[static_cast<Eigen::Index>(r)]);
    wrench_by_q.col(column).head<3>() = cell.moment_by_turn * turn + cell.moment_by_spin * spin;
  }
  for (std::size_t k = 0; k < v.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    const Vector3d spin = d.jacobian.col(column).head<3>();
    for (int i = 0; i < 3; ++i) add(first_ + 3 + i, v[k], -d.jacobian(3 + i, column));
    const Eigen::Matrix<double, 7, 1> on_rod = cell.rows_by_spin * spin;
    for (std::size_t r = 0; r < rows.size(); ++r) add(rows[r], v[k], on_rod[static_cast<Eigen::Index>(r)]);
    wrench_by_v.col(column).head<3>() = cell.moment_by_spin * spin;
  }
  if (!mount_.moves_freely()) return;
  // Rows of the carrier: -J^T (M, -f).
  const Wrench wrench{cell.moment, -at.y.segment<3>(first_)};
  const Eigen::MatrixXd by_q = d.force(wrench) + d.jacobian.transpose() * wrench_by_q;
  const Eigen::MatrixXd by_v = d.jacobian.transpose() * wrench_by_v;
  const Eigen::MatrixXd by_place = d.jacobian.topRows<3>().transpose() * cell.moment_by;
  const Eigen::MatrixXd by_rate = d.jacobian.topRows<3>().transpose() * cell.moment_by_rate;
  for (std::size_t r = 0; r < v.size(); ++r) {
    const auto row = static_cast<Eigen::Index>(r);
    for (std::size_t k = 0; k < q.size(); ++k) add(v[r], q[k], -by_q(row, static_cast<Eigen::Index>(k)));
    for (std::size_t k = 0; k < v.size(); ++k) add(v[r], v[k], -by_v(row, static_cast<Eigen::Index>(k)));
    for (std::size_t k = 0; k < 7; ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      // The rates of the vertices are the unknowns v, that of the angle is its y'.
      add(v[r], x[k], -by_place(row, column) - (k == 6 ? c * by_rate(row, column) : 0.0));
      if (k < 6) add(v[r], rows[k], -by_rate(row, column));
    }
    for (int i = 0; i < 3; ++i) add(v[r], first_ + i, d.jacobian(3 + i, row));
  }
}

VectorXd MountPart::velocity_error(const VectorView& y, const VectorXd& dv) const {
  Vector3d result = dv.segment<3>(rod_.velocity_of(vertex()));
  if (mount_.moves_freely()) result -= linear_change(mount_.jacobian(y), mount_.velocities(), dv);
  return result;
}

VectorXd MountPart::acceleration_bias(const VectorView& y, const VectorXd& rate) const {
  return -linear_change(mount_.differentiate(y).motion, mount_.coordinates(), rate);
}

void MountPart::apply_impulse(const VectorView& y, const VectorXd& multipliers, VectorXd& dv) const {
  dv.segment<3>(rod_.velocity_of(vertex())) += multipliers / rod_.mass_of(vertex());
  if (mount_.moves_freely()) mount_.apply_impulse(y, mount_.jacobian(y), {Vector3d::Zero(), -multipliers}, dv);
}

Wrench MountPart::wrench(const VectorView& y) const {
  return {Vector3d::Zero(), y.segment<3>(first_)};
}

double MountPart::gap(const VectorView& y) const {
  return (y.segment<3>(rod_.position_of(vertex())) - mount_.state(y).X_WF.p).norm();
}

}  // namespace snare::coupling
