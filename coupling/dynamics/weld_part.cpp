#include "coupling/dynamics/weld_part.hpp"

#include <Eigen/LU>

namespace snare::coupling {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector4d;
using Eigen::VectorXd;
using multibody::Matrix6;
using multibody::Matrix6X;
using multibody::Vector6;
using multibody::Wrench;
using numerics::DaeKind;
using numerics::DaePoint;
using numerics::VectorView;

namespace {

// Of a stabilising multiplier: its round-off grows as one over the step, and what it does to others is tested there.
constexpr double no_tolerance = 1e6;

Wrench wrench_of(const VectorView& y, int first) {
  return {y.segment<3>(first), y.segment<3>(first + 3)};
}

/// Half the sum of the cross products of the axes: the turn of B from A where it is small.
Vector3d misalignment(const Matrix3d& R_WA, const Matrix3d& R_WB) {
  Vector3d e = Vector3d::Zero();
  for (int k = 0; k < 3; ++k) e += 0.5 * R_WA.col(k).cross(R_WB.col(k));
  return e;
}

VectorXd gathered(const VectorXd& values, const std::vector<int>& indices) {
  VectorXd result(static_cast<Eigen::Index>(indices.size()));
  for (std::size_t k = 0; k < indices.size(); ++k) result[static_cast<Eigen::Index>(k)] = values[indices[k]];
  return result;
}

}  // namespace

VectorXd project(const std::vector<const Constraint*>& links, const VectorView& y, const VectorXd& extra,
                    VectorXd& dv) {
  Eigen::Index n = 0;
  for (const Constraint* link : links) n += link->constraints();
  if (n == 0) return {};
  Eigen::MatrixXd flexibility(n, n);
  VectorXd missing(n);
  const auto velocity_error = [&](const VectorXd& change, auto&& out) {
    Eigen::Index first = 0;
    for (const Constraint* link : links) {
      out.segment(first, link->constraints()) = link->velocity_error(y, change);
      first += link->constraints();
    }
  };
  velocity_error(dv, missing);
  if (extra.size() > 0) missing += extra;
  Eigen::Index column = 0;
  for (const Constraint* link : links) {
    for (int k = 0; k < link->constraints(); ++k) {
      VectorXd unit = VectorXd::Zero(y.size());
      link->apply_impulse(y, VectorXd::Unit(link->constraints(), k), unit);
      velocity_error(unit, flexibility.col(column++));
    }
  }
  const VectorXd multipliers = -flexibility.partialPivLu().solve(missing);
  Eigen::Index first = 0;
  for (const Constraint* link : links) {
    link->apply_impulse(y, multipliers.segment(first, link->constraints()), dv);
    first += link->constraints();
  }
  return multipliers;
}

WeldPart::WeldPart(std::string name, MovingFrame carrier, const BodyPart& held, const multibody::Pose& X_BH,
                   const MotionOptions& options)
    : name_(std::move(name)),
      carrier_(std::move(carrier)),
      held_(held, X_BH),
      body_(held),
      options_(options) {}

void WeldPart::declare(numerics::DaeLayout& layout) {
  const std::vector<std::string> axes{"x", "y", "z"};
  first_ = layout.add({name_ + " moment", axes, 3, DaeKind::algebraic, options_.force_tolerance, 0});
  layout.add({name_ + " force", axes, 3, DaeKind::algebraic, options_.force_tolerance, 0});
  layout.add({name_ + " stabiliser", {}, 6, DaeKind::algebraic, no_tolerance, 0});
}

void WeldPart::sparsity(std::vector<std::pair<int, int>>& entries) const {
  for (const MovingFrame* frame : {&carrier_, static_cast<const MovingFrame*>(&held_)}) {
    const std::vector<int> q = frame->coordinates(), v = frame->velocities();
    for (int i = 0; i < 6; ++i) {
      for (const int column : q) {
        entries.emplace_back(first_ + i, column);
        entries.emplace_back(first_ + 6 + i, column);
      }
      for (const int column : v) entries.emplace_back(first_ + 6 + i, column);
    }
    if (!frame->moves_freely()) continue;
    for (const int row : v) {
      for (const int column : q) entries.emplace_back(row, column);
      for (int i = 0; i < 6; ++i) entries.emplace_back(row, first_ + i);
    }
  }
  for (int i = 0; i < 6; ++i) {
    entries.emplace_back(first_ + i, first_ + i);
    entries.emplace_back(first_ + 6 + i, first_ + 6 + i);
  }
  for (int i = 0; i < 3; ++i) {
    entries.emplace_back(body_.position() + i, first_ + 9 + i);
    for (int j = 0; j < 4; ++j) {
      entries.emplace_back(body_.quaternion() + j, first_ + 6 + i);
      entries.emplace_back(body_.quaternion() + j, body_.quaternion() + i);
      entries.emplace_back(body_.quaternion() + j, body_.quaternion() + 3);
    }
  }
}

void WeldPart::residual(const DaePoint& at, Eigen::Ref<VectorXd> rows) {
  const MovingFrame::State a = carrier_.state(at.y), b = held_.state(at.y);
  const Wrench on_b = wrench_of(at.y, first_);
  held_.push(held_.jacobian(at.y), on_b, rows);
  if (carrier_.moves_freely()) carrier_.push(carrier_.jacobian(at.y), Wrench{} - on_b, rows);
  rows.segment<4>(body_.quaternion()) -=
      multibody::quaternion_rates(at.y.segment<4>(body_.quaternion())) * at.y.segment<3>(first_ + 6);
  rows.segment<3>(body_.position()) -= at.y.segment<3>(first_ + 9);
  rows.segment<3>(first_) += misalignment(a.X_WF.R, b.X_WF.R);
  rows.segment<3>(first_ + 3) += b.X_WF.p - a.X_WF.p;
  rows.segment<3>(first_ + 6) += b.angular - a.angular;
  rows.segment<3>(first_ + 9) += b.linear - a.linear;
}

void WeldPart::jacobian(const DaePoint& at, double /*c*/, std::vector<double>& values) {
  const auto add = [&](int row, int column, double value) {
    const int slot = pattern_->slot(row, column);
    if (slot >= 0) values[static_cast<std::size_t>(slot)] += value;
  };
  const MovingFrame::State a = carrier_.state(at.y), b = held_.state(at.y);
  const Matrix3d ba = b.X_WF.R * a.X_WF.R.transpose();
  const Matrix3d trace = ba.trace() * Matrix3d::Identity();
  const Wrench on_b = wrench_of(at.y, first_);
  for (const bool held : {false, true}) {
    const MovingFrame& frame = held ? held_ : carrier_;
    const MovingFrame::Derivatives d = frame.differentiate(at.y);
    const std::vector<int> q = frame.coordinates(), v = frame.velocities();
    const double sign = held ? 1.0 : -1.0;
    // d(a x b)/2: (a.b) 1 - b a^T on the turn of B, less (a.b) 1 - a b^T on that of A.
    const Matrix3d by_turn = 0.5 * sign * (trace - (held ? ba : Matrix3d(ba.transpose())));
    for (std::size_t k = 0; k < q.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      for (int i = 0; i < 3; ++i) {
        add(first_ + i, q[k], by_turn.row(i).dot(d.place.col(column).head<3>()));
        add(first_ + 3 + i, q[k], sign * d.place(3 + i, column));
      }
      for (int i = 0; i < 6; ++i) add(first_ + 6 + i, q[k], sign * d.motion(i, column));
    }
    for (std::size_t k = 0; k < v.size(); ++k) {
      for (int i = 0; i < 6; ++i)
        add(first_ + 6 + i, v[k], sign * d.jacobian(i, static_cast<Eigen::Index>(k)));
    }
    if (!frame.moves_freely()) continue;
    const Eigen::MatrixXd force = d.force(on_b);
    for (std::size_t r = 0; r < v.size(); ++r) {
      const auto row = static_cast<Eigen::Index>(r);
      for (std::size_t k = 0; k < q.size(); ++k)
        add(v[r], q[k], -sign * force(row, static_cast<Eigen::Index>(k)));
      for (int i = 0; i < 6; ++i) add(v[r], first_ + i, -sign * d.jacobian(i, row));
    }
  }
  const Vector4d quaternion = at.y.segment<4>(body_.quaternion());
  const Eigen::Matrix<double, 4, 3> rates = multibody::quaternion_rates(quaternion);
  const Vector3d mu = at.y.segment<3>(first_ + 6);
  for (int j = 0; j < 4; ++j) {
    // Q(q) mu is linear in q.
    const Vector4d by_q = multibody::quaternion_rates(Vector4d::Unit(j)) * mu;
    for (int i = 0; i < 4; ++i) add(body_.quaternion() + i, body_.quaternion() + j, -by_q[i]);
    for (int i = 0; i < 3; ++i) add(body_.quaternion() + j, first_ + 6 + i, -rates(j, i));
  }
  for (int i = 0; i < 3; ++i) add(body_.position() + i, first_ + 9 + i, -1.0);
}

VectorXd WeldPart::velocity_error(const VectorView& y, const VectorXd& dv) const {
  Vector6 result = held_.jacobian(y) * gathered(dv, held_.velocities());
  if (carrier_.moves_freely()) result -= carrier_.jacobian(y) * gathered(dv, carrier_.velocities());
  return result;
}

VectorXd WeldPart::acceleration_bias(const VectorView& y, const VectorXd& rate) const {
  return held_.differentiate(y).motion * gathered(rate, held_.coordinates()) -
         carrier_.differentiate(y).motion * gathered(rate, carrier_.coordinates());
}

void WeldPart::apply_impulse(const VectorView& y, const VectorXd& multipliers, VectorXd& dv) const {
  const Wrench on_b{multipliers.head<3>(), multipliers.tail<3>()};
  held_.apply_impulse(y, held_.jacobian(y), on_b, dv);
  if (carrier_.moves_freely()) carrier_.apply_impulse(y, carrier_.jacobian(y), Wrench{} - on_b, dv);
}

Wrench WeldPart::wrench(const VectorView& y) const {
  return wrench_of(y, first_);
}

double WeldPart::gap(const VectorView& y) const {
  const MovingFrame::State a = carrier_.state(y), b = held_.state(y);
  return std::max((b.X_WF.p - a.X_WF.p).norm(), misalignment(a.X_WF.R, b.X_WF.R).norm());
}

}  // namespace snare::coupling
