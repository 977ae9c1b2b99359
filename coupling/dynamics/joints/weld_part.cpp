#include "coupling/dynamics/joints/weld_part.hpp"

#include <algorithm>

namespace snare::coupling {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector4d;
using Eigen::VectorXd;
using multibody::Vector6;
using multibody::Wrench;
using numerics::DaeKind;
using numerics::DaePoint;
using numerics::VectorView;

namespace {

/// Half the sum of the cross products of the axes: the turn of H from A where it is small.
Vector3d misalignment(const Matrix3d& R_WA, const Matrix3d& R_WH) {
  Vector3d e = Vector3d::Zero();
  for (int k = 0; k < 3; ++k) e += 0.5 * R_WA.col(k).cross(R_WH.col(k));
  return e;
}

VectorXd gathered(const VectorXd& values, const std::vector<int>& indices) {
  VectorXd result(static_cast<Eigen::Index>(indices.size()));
  for (std::size_t k = 0; k < indices.size(); ++k) result[static_cast<Eigen::Index>(k)] = values[indices[k]];
  return result;
}

}  // namespace

WeldPart::WeldPart(std::string name, MovingFrame carrier, const BodyPart& held, const multibody::Pose& X_BH,
                   const MotionOptions& options)
    : Constraint(std::move(name), std::move(carrier), options), held_(held, X_BH), body_(held) {}

void WeldPart::declare(numerics::DaeLayout& layout) {
  const std::vector<std::string> axes{"x", "y", "z"};
  const double tolerance = options().force_tolerance;
  set_multipliers(layout.add({name() + " moment", axes, 3, DaeKind::algebraic, tolerance, 0}));
  layout.add({name() + " force", axes, 3, DaeKind::algebraic, tolerance, 0});
  stabiliser_ = layout.add({name() + " stabiliser", {}, 6, DaeKind::algebraic, numerics::no_tolerance, 0});
}

void WeldPart::sparsity(std::vector<std::pair<int, int>>& entries) const {
  for (const MovingFrame* frame : {&carrier(), static_cast<const MovingFrame*>(&held_)}) {
    const std::vector<int> q = frame->coordinates(), v = frame->velocities();
    // The constraints' rows: turn and place by coordinates, motion by coordinates and velocities.
    for (int i = 0; i < constraints(); ++i) {
      for (const int column : q) {
        entries.emplace_back(moment() + i, column);
        entries.emplace_back(turn_stabiliser() + i, column);
      }
      for (const int column : v) entries.emplace_back(turn_stabiliser() + i, column);
    }
    // The balances of forces.
    if (!frame->moves_freely()) continue;
    for (const int row : v) {
      for (const int column : q) entries.emplace_back(row, column);
      for (int i = 0; i < constraints(); ++i) entries.emplace_back(row, moment() + i);
    }
  }
  for (int i = 0; i < constraints(); ++i) {
    entries.emplace_back(moment() + i, moment() + i);
    entries.emplace_back(turn_stabiliser() + i, turn_stabiliser() + i);
  }
  // The kinematics of the held body.
  for (int i = 0; i < 3; ++i) entries.emplace_back(body_.position() + i, shift_stabiliser() + i);
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 3; ++i) entries.emplace_back(body_.quaternion() + j, turn_stabiliser() + i);
    for (int i = 0; i < 4; ++i) entries.emplace_back(body_.quaternion() + j, body_.quaternion() + i);
  }
}

void WeldPart::residual(const DaePoint& at, Eigen::Ref<VectorXd> rows) {
  const MovingFrame::State a = carrier().state(at.y), h = held_.state(at.y);
  // Balances of forces, inertia less forces: -J_H^T (M, F) for the held body, +J_A^T (M, F) for the carrier.
  const Wrench on_held = wrench(at.y);
  held_.push(held_.jacobian(at.y), on_held, rows);
  if (carrier().moves_freely()) carrier().push(carrier().jacobian(at.y), Wrench{} - on_held, rows);
  // Kinematics of the held body: q' - Q(q) (w + mu_w) = 0, p' - v - mu_p = 0.
  rows.segment<4>(body_.quaternion()) -=
      multibody::quaternion_rates(at.y.segment<4>(body_.quaternion())) * at.y.segment<3>(turn_stabiliser());
  rows.segment<3>(body_.position()) -= at.y.segment<3>(shift_stabiliser());
  // The constraints, H less A, in the axes of the world.
  rows.segment<3>(moment()) += misalignment(a.X_WF.R, h.X_WF.R);
  rows.segment<3>(force()) += h.X_WF.p - a.X_WF.p;
  rows.segment<3>(turn_stabiliser()) += h.angular - a.angular;
  rows.segment<3>(shift_stabiliser()) += h.linear - a.linear;
}

void WeldPart::jacobian(const DaePoint& at, double /*c*/, std::vector<double>& values) {
  const numerics::PatternValues into(slots(), values);
  const MovingFrame::State a = carrier().state(at.y), h = held_.state(at.y);
  const Matrix3d R_AH_in_world = h.X_WF.R * a.X_WF.R.transpose();  // sum_k h_k a_k^T
  const Matrix3d trace = R_AH_in_world.trace() * Matrix3d::Identity();
  const Wrench on_held = wrench(at.y);
  for (const MovingFrame* frame : {&carrier(), static_cast<const MovingFrame*>(&held_)}) {
    const bool held = frame == &held_;
    const MovingFrame::Derivatives d = frame->differentiate(at.y);
    const std::vector<int> q = frame->coordinates(), v = frame->velocities();
    const double sign = held ? 1.0 : -1.0;
    // d(a x h)/2 = ((a.h) 1 - h a^T) phi/2 by the turn phi of H, -((a.h) 1 - a h^T) phi/2 by that of A.
    const Matrix3d by_turn =
        0.5 * sign * (trace - (held ? R_AH_in_world : Matrix3d(R_AH_in_world.transpose())));
    for (std::size_t k = 0; k < q.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      const Vector3d turn = d.place.col(column).head<3>(), shift = d.place.col(column).tail<3>();
      for (int i = 0; i < 3; ++i) {
        into.add(moment() + i, q[k], by_turn.row(i).dot(turn));
        into.add(force() + i, q[k], sign * shift[i]);
      }
      for (int i = 0; i < constraints(); ++i)
        into.add(turn_stabiliser() + i, q[k], sign * d.motion(i, column));
    }
    for (std::size_t k = 0; k < v.size(); ++k) {
      for (int i = 0; i < constraints(); ++i)
        into.add(turn_stabiliser() + i, v[k], sign * d.jacobian(i, static_cast<Eigen::Index>(k)));
    }
    // The balances -+J^T (M, F): by the coordinates, which turn J, and by the multipliers.
    if (!frame->moves_freely()) continue;
    const Eigen::MatrixXd force_by_q = d.force(on_held);
    for (std::size_t r = 0; r < v.size(); ++r) {
      const auto row = static_cast<Eigen::Index>(r);
      for (std::size_t k = 0; k < q.size(); ++k)
        into.add(v[r], q[k], -sign * force_by_q(row, static_cast<Eigen::Index>(k)));
      for (int i = 0; i < constraints(); ++i) into.add(v[r], moment() + i, -sign * d.jacobian(i, row));
    }
  }
  // -Q(q) mu_w of the quaternion's rates, linear in q and in mu_w; -mu_p of the position's.
  const Vector4d quaternion = at.y.segment<4>(body_.quaternion());
  const Eigen::Matrix<double, 4, 3> by_mu = multibody::quaternion_rates(quaternion);
  const Vector3d mu = at.y.segment<3>(turn_stabiliser());
  for (int j = 0; j < 4; ++j) {
    const Vector4d by_q = multibody::quaternion_rates(Vector4d::Unit(j)) * mu;
    for (int i = 0; i < 4; ++i) into.add(body_.quaternion() + i, body_.quaternion() + j, -by_q[i]);
    for (int i = 0; i < 3; ++i) into.add(body_.quaternion() + j, turn_stabiliser() + i, -by_mu(j, i));
  }
  for (int i = 0; i < 3; ++i) into.add(body_.position() + i, shift_stabiliser() + i, -1.0);
}

VectorXd WeldPart::velocity_error(const VectorView& y, const VectorXd& dv) const {
  Vector6 result = held_.jacobian(y) * gathered(dv, held_.velocities());
  if (carrier().moves_freely()) result -= carrier().jacobian(y) * gathered(dv, carrier().velocities());
  return result;
}

VectorXd WeldPart::acceleration_bias(const VectorView& y, const VectorXd& rate) const {
  return held_.differentiate(y).motion * gathered(rate, held_.coordinates()) -
         carrier().differentiate(y).motion * gathered(rate, carrier().coordinates());
}

void WeldPart::apply_impulse(const VectorView& y, const VectorXd& multipliers, VectorXd& dv) const {
  const Wrench on_held{multipliers.head<3>(), multipliers.tail<3>()};
  held_.apply_impulse(y, held_.jacobian(y), on_held, dv);
  if (carrier().moves_freely()) carrier().apply_impulse(y, carrier().jacobian(y), Wrench{} - on_held, dv);
}

Wrench WeldPart::wrench(const VectorView& y) const {
  return {y.segment<3>(moment()), y.segment<3>(force())};
}

double WeldPart::gap(const VectorView& y) const {
  const MovingFrame::State a = carrier().state(y), h = held_.state(y);
  return std::max((h.X_WF.p - a.X_WF.p).norm(), misalignment(a.X_WF.R, h.X_WF.R).norm());
}

}  // namespace snare::coupling
