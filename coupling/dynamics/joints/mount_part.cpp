#include "coupling/dynamics/joints/mount_part.hpp"

#include <Eigen/Geometry>

#include <cmath>

namespace snare::coupling {

using Eigen::Vector3d;
using Eigen::VectorXd;
using multibody::Matrix6X;
using multibody::Wrench;
using numerics::DaeKind;
using numerics::DaePoint;
using numerics::VectorView;

namespace {

// Unknowns of the half cell: two vertices, whose rates are unknowns themselves, an angle, and of a rod of
// higher order two curvatures.
constexpr std::size_t cell_vertices = 6;
using CellVector = Eigen::Matrix<double, wire::MountCell::count, 1>;

/// Angular part of J times changes of the unknowns.
Vector3d angular_change(const Matrix6X& J, const std::vector<int>& unknowns, const VectorXd& values) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 0; k < unknowns.size(); ++k)
    sum += J.col(static_cast<Eigen::Index>(k)).head<3>() * values[unknowns[k]];
  return sum;
}

/// Linear part of J times changes of the unknowns.
Vector3d linear_change(const Matrix6X& J, const std::vector<int>& unknowns, const VectorXd& values) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 0; k < unknowns.size(); ++k)
    sum += J.col(static_cast<Eigen::Index>(k)).tail<3>() * values[unknowns[k]];
  return sum;
}

}  // namespace

MountPart::MountPart(const MotionMount& mount, MovingFrame frame, wire::RodPart& rod,
                     const MotionOptions& options)
    : Constraint(mount.name, std::move(frame), options), rod_(rod), end_(mount.end), give_(mount.give) {
  rod_.carry(end_, [this](const VectorView& y) {
    const MovingFrame::State s = carrier().state(y);
    return wire::MountMotion{{s.X_WF.R.col(0), s.X_WF.R.col(1)}, s.angular};
  });
}

void MountPart::declare(numerics::DaeLayout& layout) {
  const auto axes =
      give_.gives() ? std::vector<std::string>{"y", "z"} : std::vector<std::string>{"x", "y", "z"};
  const int n = constraints();
  set_multipliers(layout.add({name() + " force", axes, n, DaeKind::algebraic, options().force_tolerance, 0}));
  stabiliser_ = layout.add({name() + " stabiliser", axes, n, DaeKind::algebraic, numerics::no_tolerance, 0});
  if (give_.gives() && give_.slips())
    slip_ = layout.add(
        {name() + " slip [m]", {}, 1, DaeKind::differential, options().position_tolerance, 0, false});
}

// What the mount does at unknowns y. The axes of a rigid mount are the world's.
MountPart::Hold MountPart::hold(const VectorView& y) const {
  const MovingFrame::State s = carrier().state(y);
  Hold h;
  h.r = y.segment<3>(position()) - s.X_WF.p;
  h.w = y.segment<3>(speed()) - s.linear;
  h.omega = s.angular;
  h.along = s.X_WF.R.col(0);
  if (!give_.gives()) {
    h.axes = Axes::Identity(3, 3);
    h.force = y.segment<3>(force());
    return h;
  }
  h.axes = s.X_WF.R.rightCols<2>();
  h.w -= h.omega.cross(h.r);
  h.strain = h.along.dot(h.r) - (slip_ >= 0 ? y[slip_] : 0.0);
  h.rate = h.along.dot(h.w);
  h.spring = -give_.stiffness * h.strain - give_.damping * h.rate;
  h.force = h.axes * y.segment<2>(force()) + h.spring * h.along;
  return h;
}

void MountPart::place(VectorXd& y) const {
  const Hold h = hold(y);
  if (give_.gives()) {
    y.segment<3>(speed()) -= h.axes * (h.axes.transpose() * h.w);
  } else {
    y.segment<3>(speed()) = carrier().state(y).linear;
  }
}

// z' = (k |u - z| - F)/(k tau) beyond F, towards the strain.
MountPart::Slip MountPart::slip(double strain) const {
  constexpr double relaxation = 1e-5;  // tau [s]
  const double beyond = std::abs(strain) - give_.slip_force / give_.stiffness;
  if (!(beyond > 0.0)) return {};
  return {std::copysign(beyond, strain) / relaxation, 1.0 / relaxation};
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
  const std::vector<int> q = carrier().coordinates(), v = carrier().velocities(), x = places(),
                         rows = balances();
  // Force and stabiliser on the end, and the rows of the constraint.
  for (int i = 0; i < constraints(); ++i) {
    entries.emplace_back(force() + i, force() + i);
    entries.emplace_back(stabiliser() + i, stabiliser() + i);
    for (const int column : q) {
      entries.emplace_back(force() + i, column);
      entries.emplace_back(stabiliser() + i, column);
    }
    for (const int column : v) entries.emplace_back(stabiliser() + i, column);
  }
  if (give_.gives()) {
    append_sparsity_of_give(entries);
  } else {
    for (int i = 0; i < 3; ++i) {
      entries.emplace_back(position() + i, stabiliser() + i);
      entries.emplace_back(speed() + i, force() + i);
      entries.emplace_back(force() + i, position() + i);
      entries.emplace_back(stabiliser() + i, speed() + i);
    }
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
    for (int i = 0; i < constraints(); ++i) entries.emplace_back(row, force() + i);
    if (slip_ >= 0) entries.emplace_back(row, slip_);
  }
}

// Its axes turn with the mount, so that every component of the end meets every row.
void MountPart::append_sparsity_of_give(std::vector<std::pair<int, int>>& entries) const {
  std::vector<int> columns = carrier().coordinates();
  for (const int column : carrier().velocities()) columns.push_back(column);
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < constraints(); ++i) {
      entries.emplace_back(position() + k, stabiliser() + i);
      entries.emplace_back(speed() + k, force() + i);
      entries.emplace_back(force() + i, position() + k);
      entries.emplace_back(stabiliser() + i, position() + k);
      entries.emplace_back(stabiliser() + i, speed() + k);
    }
    for (int j = 0; j < 3; ++j) {
      entries.emplace_back(speed() + k, position() + j);
      entries.emplace_back(speed() + k, speed() + j);
    }
    for (const int column : columns) {
      entries.emplace_back(speed() + k, column);
      entries.emplace_back(position() + k, column);
    }
  }
  if (slip_ < 0) return;
  entries.emplace_back(slip_, slip_);
  for (int k = 0; k < 3; ++k) {
    entries.emplace_back(slip_, position() + k);
    entries.emplace_back(speed() + k, slip_);
  }
  for (const int column : carrier().coordinates()) entries.emplace_back(slip_, column);
}

void MountPart::residual(const DaePoint& at, Eigen::Ref<VectorXd> rows) {
  const Hold h = hold(at.y);
  const int n = constraints();
  // The end: m v' + ... - f = 0, x' - v - B mu = 0.
  rows.segment<3>(speed()) -= h.force;
  rows.segment<3>(position()) -= h.axes * at.y.segment(stabiliser(), n);
  // The constraint: B^T r = 0, B^T w = 0; and z' of what slips.
  rows.segment(force(), n) += h.axes.transpose() * h.r;
  rows.segment(stabiliser(), n) += h.axes.transpose() * h.w;
  if (slip_ >= 0) rows[slip_] += at.rate[slip_] - slip(h.strain).rate;
  // The carrier: -J^T (M - r x f, -f), M the moment of the half cell on the mount.
  if (!carrier().moves_freely()) return;
  Vector3d moment = rod_.mount_moment(at, end_);
  if (give_.gives()) moment -= h.r.cross(h.force);
  carrier().push(carrier().jacobian(at.y), {moment, -h.force}, rows);
}

// A rigid mount, by the end's own unknowns.
void MountPart::add_rigid(const numerics::PatternValues& into) const {
  for (int i = 0; i < 3; ++i) {
    into.add(speed() + i, force() + i, -1.0);
    into.add(position() + i, stabiliser() + i, -1.0);
    into.add(force() + i, position() + i, 1.0);
    into.add(stabiliser() + i, speed() + i, 1.0);
  }
}

Wrench MountPart::add_change(const Hold& h, const VectorView& y, int column, const Change& change,
                             const numerics::PatternValues& into) const {
  if (!give_.gives()) {
    for (int i = 0; i < 3; ++i) {
      into.add(force() + i, column, -change.shift[i]);
      into.add(stabiliser() + i, column, -change.velocity[i]);
    }
    return {Vector3d::Zero(), Vector3d::Zero()};
  }
  const Vector3d dr = change.end_shift - change.shift;
  const Vector3d dw = change.end_velocity - change.velocity - change.spin.cross(h.r) - h.omega.cross(dr);
  for (int i = 0; i < 2; ++i) {
    const Vector3d axis = h.axes.col(i), turned = change.turn.cross(axis);
    into.add(force() + i, column, axis.dot(dr) + turned.dot(h.r));
    into.add(stabiliser() + i, column, axis.dot(dw) + turned.dot(h.w));
  }
  const Vector3d turned = change.turn.cross(h.along);
  const double du = h.along.dot(dr) + turned.dot(h.r), du_rate = h.along.dot(dw) + turned.dot(h.w);
  const Vector3d df = change.turn.cross(h.force) - (give_.stiffness * du + give_.damping * du_rate) * h.along;
  const Vector3d drift = change.turn.cross(Vector3d(h.axes * y.segment<2>(stabiliser())));
  for (int k = 0; k < 3; ++k) {
    into.add(speed() + k, column, -df[k]);
    into.add(position() + k, column, -drift[k]);
  }
  if (slip_ >= 0) into.add(slip_, column, -slip(h.strain).by_strain * du);
  return {-dr.cross(h.force) - h.r.cross(df), -df};
}

// By the unknowns of the end, of the multipliers and of the slip, of a mount that gives; with the wrench's
// changes on the carrier.
std::vector<std::pair<int, Wrench>> MountPart::add_own_changes(const Hold& h, const VectorView& y, double c,
                                                               const numerics::PatternValues& into) const {
  std::vector<std::pair<int, Wrench>> changes;
  for (int k = 0; k < 3; ++k) {
    Change shift, velocity;
    shift.end_shift[k] = velocity.end_velocity[k] = 1.0;
    changes.emplace_back(position() + k, add_change(h, y, position() + k, shift, into));
    changes.emplace_back(speed() + k, add_change(h, y, speed() + k, velocity, into));
  }
  const auto pushed = [&](int column, const Vector3d& df) {
    for (int k = 0; k < 3; ++k) into.add(speed() + k, column, -df[k]);
    changes.emplace_back(column, Wrench{-h.r.cross(df), -df});
  };
  for (int i = 0; i < 2; ++i) {
    pushed(force() + i, h.axes.col(i));
    for (int k = 0; k < 3; ++k) into.add(position() + k, stabiliser() + i, -h.axes(k, i));
  }
  if (slip_ >= 0) {
    pushed(slip_, give_.stiffness * h.along);
    into.add(slip_, slip_, c + slip(h.strain).by_strain);
  }
  return changes;
}

void MountPart::jacobian(const DaePoint& at, double c, std::vector<double>& values) {
  const numerics::PatternValues into(slots(), values);
  const std::vector<int> q = carrier().coordinates(), v = carrier().velocities(), x = places(),
                         rows = balances();
  const MovingFrame::Derivatives d = carrier().differentiate(at.y);
  const wire::MountCell cell = rod_.mount_cell(at, end_);
  const Hold h = hold(at.y);
  const auto add_to_cell = [&](int column, const CellVector& by) {
    for (std::size_t r = 0; r < rows.size(); ++r) into.add(rows[r], column, by[static_cast<Eigen::Index>(r)]);
  };
  std::vector<std::pair<int, Wrench>> own;
  if (give_.gives()) {
    own = add_own_changes(h, at.y, c, into);
  } else {
    add_rigid(into);
  }
  // Constraint, half cell and the wrench (M - r x f, -f) by coordinates and velocities of the carrier,
  // through the turn, the shift and the spin of the mount.
  Matrix6X wrench_by_q = Matrix6X::Zero(6, d.place.cols()),
           wrench_by_v = Matrix6X::Zero(6, d.jacobian.cols());
  for (std::size_t k = 0; k < q.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    Change change;
    change.turn = d.place.col(column).head<3>();
    change.shift = d.place.col(column).tail<3>();
    change.spin = d.motion.col(column).head<3>();
    change.velocity = d.motion.col(column).tail<3>();
    const Wrench by = add_change(h, at.y, q[k], change, into);
    add_to_cell(q[k], cell.rows_by_turn * change.turn + cell.rows_by_spin * change.spin);
    wrench_by_q.col(column).head<3>() =
        cell.moment_by_turn * change.turn + cell.moment_by_spin * change.spin + by.moment;
    wrench_by_q.col(column).tail<3>() = by.force;
  }
  for (std::size_t k = 0; k < v.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    Change change;
    change.spin = d.jacobian.col(column).head<3>();
    change.velocity = d.jacobian.col(column).tail<3>();
    const Wrench by = add_change(h, at.y, v[k], change, into);
    add_to_cell(v[k], cell.rows_by_spin * change.spin);
    wrench_by_v.col(column).head<3>() = cell.moment_by_spin * change.spin + by.moment;
    wrench_by_v.col(column).tail<3>() = by.force;
  }
  if (!carrier().moves_freely()) return;
  // Rows of the carrier, -J^T (M - r x f, -f): J turns with q, M changes with the mount and with the half
  // cell.
  Wrench wrench{cell.moment, -h.force};
  if (give_.gives()) wrench.moment -= h.r.cross(h.force);
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
    const Vector3d turning = d.jacobian.col(row).head<3>(), linear = d.jacobian.col(row).tail<3>();
    for (const auto& [column, by] : own)
      into.add(v[r], column, -turning.dot(by.moment) - linear.dot(by.force));
    for (int i = 0; !give_.gives() && i < 3; ++i) into.add(v[r], force() + i, linear[i]);
  }
}

VectorXd MountPart::velocity_error(const VectorView& y, const VectorXd& dv) const {
  const Hold h = hold(y);
  Vector3d change = dv.segment<3>(speed());
  if (carrier().moves_freely()) {
    const Matrix6X J = carrier().jacobian(y);
    const std::vector<int> v = carrier().velocities();
    change -= linear_change(J, v, dv);
    if (give_.gives()) change -= angular_change(J, v, dv).cross(h.r);
  }
  return h.axes.transpose() * change;
}

// d(B^T w)/dt = B^T (-v_M' - omega' x r - omega x r') + (turn x B)^T w, with the velocities as they are.
VectorXd MountPart::acceleration_bias(const VectorView& y, const VectorXd& rate) const {
  const MovingFrame::Derivatives d = carrier().differentiate(y);
  const std::vector<int> q = carrier().coordinates();
  Vector3d change = -linear_change(d.motion, q, rate);
  if (!give_.gives()) return change;
  const Hold h = hold(y);
  change -= angular_change(d.motion, q, rate).cross(h.r) + h.omega.cross(h.w + h.omega.cross(h.r));
  const Vector3d turn = angular_change(d.place, q, rate);
  return h.axes.transpose() * (change - turn.cross(h.w));
}

void MountPart::apply_impulse(const VectorView& y, const VectorXd& multipliers, VectorXd& dv) const {
  const Hold h = hold(y);
  const Vector3d f = h.axes * multipliers;
  dv.segment<3>(speed()) += f / rod_.model().inertia_of(vertex());
  if (!carrier().moves_freely()) return;
  const Vector3d moment = give_.gives() ? Vector3d(-h.r.cross(f)) : Vector3d(Vector3d::Zero());
  carrier().apply_impulse(y, carrier().jacobian(y), {moment, -f}, dv);
}

Wrench MountPart::wrench(const VectorView& y) const {
  const Hold h = hold(y);
  return {give_.gives() ? Vector3d(h.r.cross(h.force)) : Vector3d(Vector3d::Zero()), h.force};
}

double MountPart::spring_energy(const VectorView& y) const {
  if (!give_.gives()) return 0.0;
  const double strain = hold(y).strain;
  return 0.5 * give_.stiffness * strain * strain;
}

double MountPart::lost_power(const VectorView& y) const {
  if (!give_.gives()) return 0.0;
  const Hold h = hold(y);
  return give_.damping * h.rate * h.rate +
         (slip_ >= 0 ? give_.stiffness * h.strain * slip(h.strain).rate : 0.0);
}

double MountPart::gap(const VectorView& y) const {
  const Hold h = hold(y);
  return (h.axes.transpose() * h.r).norm();
}

}  // namespace snare::coupling
