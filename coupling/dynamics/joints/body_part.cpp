#include "coupling/dynamics/joints/body_part.hpp"

#include "multibody/spatial.hpp"

namespace snare::coupling {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector4d;
using numerics::DaeKind;
using numerics::DaePoint;

BodyPart::BodyPart(const MotionBody& body, const Vector3d& gravity, const MotionOptions& options)
    : body_(body),
      force_(body.force + body.properties.mass * gravity),
      options_(options),
      inverse_inertia_(body.properties.inertia.inverse()) {}

void BodyPart::declare(numerics::DaeLayout& layout) {
  const std::vector<std::string> axes{"x", "y", "z"};
  const std::string& name = body_.name;
  first_ = layout.add(
      {name + " position", axes, 3, DaeKind::differential, options_.body_position_tolerance, 0, false});
  layout.add({name + " quaternion",
              {"w", "x", "y", "z"},
              4,
              DaeKind::differential,
              options_.angle_tolerance,
              0,
              false});
  layout.add({name + " velocity", axes, 3, DaeKind::differential, options_.body_velocity_tolerance, 0});
  layout.add({name + " angular velocity", axes, 3, DaeKind::differential, options_.spin_tolerance, 0});
  layout.add({name + " length of the quaternion", {}, 1, DaeKind::algebraic, numerics::no_tolerance, 0});
}

void BodyPart::sparsity(std::vector<std::pair<int, int>>& entries) const {
  const auto add = [&](int row, int rows, int column, int columns) {
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) entries.emplace_back(first_ + row + i, first_ + column + j);
    }
  };
  for (int i = 0; i < Local::count; ++i) add(i, 1, i, 1);
  for (int k = 0; k < 3; ++k) add(Local::position + k, 1, Local::velocity + k, 1);
  add(Local::quaternion, 4, Local::quaternion, 4);
  add(Local::quaternion, 4, Local::spin, 3);
  add(Local::quaternion, 4, Local::length, 1);
  add(Local::spin, 3, Local::spin, 3);
  add(Local::length, 1, Local::quaternion, 4);
}

void BodyPart::rates(std::vector<std::pair<int, int>>& pairs) const {
  for (int k = 0; k < 3; ++k) pairs.emplace_back(position() + k, velocity() + k);
}

void BodyPart::attach_pattern(const numerics::SparseMatrix& pattern) {
  slots_.clear();
  for (int i = 0; i < Local::count; ++i) {
    for (int j = 0; j < Local::count; ++j) slots_.push_back(pattern.slot(first_ + i, first_ + j));
  }
}

void BodyPart::residual(const DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) {
  const Vector4d q = at.y.segment<4>(quaternion());
  const Vector3d v = at.y.segment<3>(velocity());
  const Vector3d w = at.y.segment<3>(spin());
  // p' - v = 0,  q' - Q(q) w - nu q = 0,  |q|^2 - 1 = 0
  rows.segment<3>(position()) += at.rate.segment<3>(position()) - v;
  rows.segment<4>(quaternion()) +=
      at.rate.segment<4>(quaternion()) - multibody::quaternion_rates(q) * w - at.y[length_multiplier()] * q;
  rows[length_multiplier()] += q.squaredNorm() - 1.0;
  if (body_.driven) {
    rows.segment<3>(velocity()) += v - course_velocity(at.time);
    rows.segment<3>(spin()) += w;
    return;
  }
  // Inertia less forces: m v' + c v - F = 0 in the world, I w' + w x I w + c w = 0 in the body. Others add
  // theirs.
  const Matrix3d& inertia = body_.properties.inertia;
  rows.segment<3>(velocity()) +=
      body_.properties.mass * at.rate.segment<3>(velocity()) + body_.linear_drag * v - force_;
  rows.segment<3>(spin()) +=
      inertia * at.rate.segment<3>(spin()) + w.cross(inertia * w) + body_.angular_drag * w;
}

void BodyPart::jacobian(const DaePoint& at, double c, std::vector<double>& values) {
  const auto add = [&](int i, int j, double value) {
    const int slot = slots_[static_cast<std::size_t>(Local::count * i + j)];
    if (slot >= 0) values[static_cast<std::size_t>(slot)] += value;
  };
  const Vector4d q = at.y.segment<4>(quaternion());
  const Vector3d w = at.y.segment<3>(spin());
  // p' - v
  for (int k = 0; k < 3; ++k) {
    add(Local::position + k, Local::position + k, c);
    add(Local::position + k, Local::velocity + k, -1.0);
  }
  // q' - Q(q) w - nu q: Q(q) w is bilinear, 1/2 W(w) q as well. |q|^2 - 1.
  Eigen::Matrix4d W;
  W << 0.0, -w.x(), -w.y(), -w.z(), w.x(), 0.0, w.z(), -w.y(), w.y(), -w.z(), 0.0, w.x(), w.z(), w.y(),
      -w.x(), 0.0;
  const Eigen::Matrix<double, 4, 3> Q = multibody::quaternion_rates(q);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      add(Local::quaternion + i, Local::quaternion + j,
          (i == j ? c - at.y[length_multiplier()] : 0.0) - 0.5 * W(i, j));
    }
    for (int j = 0; j < 3; ++j) add(Local::quaternion + i, Local::spin + j, -Q(i, j));
    add(Local::quaternion + i, Local::length, -q[i]);
    add(Local::length, Local::quaternion + i, 2.0 * q[i]);
  }
  if (body_.driven) {
    for (int k = 0; k < 3; ++k) {
      add(Local::velocity + k, Local::velocity + k, 1.0);
      add(Local::spin + k, Local::spin + k, 1.0);
    }
    return;
  }
  // d(w x I w) = ([w] I - [I w]) dw
  const Matrix3d& inertia = body_.properties.inertia;
  const Matrix3d gyro = numerics::cross_matrix(w) * inertia - numerics::cross_matrix(inertia * w);
  for (int i = 0; i < 3; ++i) {
    add(Local::velocity + i, Local::velocity + i, c * body_.properties.mass + body_.linear_drag);
    for (int j = 0; j < 3; ++j) {
      add(Local::spin + i, Local::spin + j,
          c * inertia(i, j) + gyro(i, j) + (i == j ? body_.angular_drag : 0.0));
    }
  }
}

std::vector<int> BodyPart::unknowns_across(int normal) const {
  std::vector<int> unknowns{position() + normal, velocity() + normal};
  for (int k = 0; k < 3; ++k) {
    if (k != normal) unknowns.insert(unknowns.end(), {quaternion() + 1 + k, spin() + k});
  }
  return unknowns;
}

void BodyPart::place(Eigen::VectorXd& y) const {
  const multibody::RigidBodyState& s = body_.start;
  y.segment<3>(position()) = s.position;
  y.segment<4>(quaternion()) << s.orientation.w(), s.orientation.x(), s.orientation.y(), s.orientation.z();
  y.segment<3>(velocity()) = body_.driven ? course_velocity(0.0) : s.velocity;
  y.segment<3>(spin()) = body_.driven ? Vector3d::Zero() : s.spin;
  y[length_multiplier()] = 0.0;
}

Vector3d BodyPart::course_velocity(double time) const {
  return body_.course_velocity ? body_.course_velocity(time) : body_.start.velocity;
}

Vector3d BodyPart::course_acceleration(double time) const {
  return body_.course_acceleration ? body_.course_acceleration(time) : Vector3d::Zero();
}

multibody::RigidBodyState BodyPart::state(const numerics::VectorView& y) const {
  multibody::RigidBodyState s;
  s.position = y.segment<3>(position());
  const Vector4d q = y.segment<4>(quaternion());
  s.orientation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  s.velocity = y.segment<3>(velocity());
  s.spin = y.segment<3>(spin());
  return s;
}

double BodyPart::drag_power(const numerics::VectorView& y) const {
  if (body_.driven) return 0.0;
  return body_.linear_drag * y.segment<3>(velocity()).squaredNorm() +
         body_.angular_drag * y.segment<3>(spin()).squaredNorm();
}

double BodyPart::force_power(const numerics::VectorView& y) const {
  return body_.driven ? 0.0 : body_.force.dot(y.segment<3>(velocity()));
}

}  // namespace snare::coupling
