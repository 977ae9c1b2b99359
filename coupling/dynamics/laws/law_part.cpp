#include "coupling/dynamics/laws/law_part.hpp"

#include "multibody/spatial.hpp"

#include <Eigen/Geometry>

namespace snare::coupling {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector4d;
using numerics::DaePoint;

namespace {

constexpr int body_rows = BodyPart::velocities;
constexpr int body_columns = BodyPart::coordinates + BodyPart::velocities;

}  // namespace

struct LawPart::Geometry {
  Matrix3d r;      // R_WB
  Vector3d arm;    // p_BP
  Vector3d swing;  // w x p_BP, in B
  double penetration = 0.0;
  double rate = 0.0;
  Vector3d law;  // force and its derivatives
};

LawPart::Geometry LawPart::geometry(double time, const numerics::VectorView& y) const {
  Geometry g;
  g.r = multibody::rotation(y.segment<4>(body_.quaternion()));
  g.arm = spring_.point;
  g.swing = Vector3d(y.segment<3>(body_.spin())).cross(g.arm);
  g.penetration = spring_.direction.dot(y.segment<3>(body_.position()) + g.r * g.arm - spring_.origin) -
                  spring_.origin_speed * time;
  g.rate = spring_.direction.dot(y.segment<3>(body_.velocity()) + g.r * g.swing) - spring_.origin_speed;
  g.law = spring_.law(g.penetration, g.rate);
  return g;
}

void LawPart::declare(numerics::DaeLayout& /*layout*/) {}

void LawPart::sparsity(std::vector<std::pair<int, int>>& entries) const {
  for (int i = 0; i < body_rows; ++i) {
    for (int j = 0; j < body_columns; ++j) entries.emplace_back(body_.velocity() + i, body_.position() + j);
  }
}

void LawPart::attach_pattern(const numerics::SparseMatrix& pattern) {
  slots_.clear();
  for (int i = 0; i < body_rows; ++i) {
    for (int j = 0; j < body_columns; ++j)
      slots_.push_back(pattern.slot(body_.velocity() + i, body_.position() + j));
  }
}

void LawPart::residual(const DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) {
  const Geometry g = geometry(at.time, at.y);
  // Rows are inertia less forces, here -F n; the moment r x R^T (-F n) is about the centre of mass, in B.
  rows.segment<3>(body_.velocity()) += g.law.x() * spring_.direction;
  rows.segment<3>(body_.spin()) += g.law.x() * g.arm.cross(g.r.transpose() * spring_.direction);
}

void LawPart::jacobian(const DaePoint& at, double /*c*/, std::vector<double>& values) {
  const Geometry g = geometry(at.time, at.y);
  const Vector4d q = at.y.segment<4>(body_.quaternion());
  const Vector3d& n = spring_.direction;
  // dF = F_d dd + F_d' dd', with d by p and q, d' by q, v and w.
  Eigen::Matrix<double, 1, body_columns> force_by;
  const Eigen::RowVector4d penetration_by_q = n.transpose() * multibody::rotated_by_quaternion(q, g.arm);
  const Eigen::RowVector4d rate_by_q = n.transpose() * multibody::rotated_by_quaternion(q, g.swing);
  force_by << g.law.y() * n.transpose(), g.law.y() * penetration_by_q + g.law.z() * rate_by_q,
      g.law.z() * n.transpose(), -g.law.z() * (n.transpose() * g.r * numerics::cross_matrix(g.arm));
  const Vector3d n_in_body = g.r.transpose() * n;
  Eigen::Matrix<double, body_rows, body_columns> by;
  by.topRows<3>() = n * force_by;
  by.bottomRows<3>() = g.arm.cross(n_in_body) * force_by;
  // The direction turns in B: R^T n changes by -phi x (R^T n), phi = 4 Q^T dq.
  by.bottomRows<3>().middleCols<4>(body_.quaternion() - body_.position()) +=
      g.law.x() * numerics::cross_matrix(g.arm) * numerics::cross_matrix(n_in_body) * 4.0 *
      multibody::quaternion_rates(q).transpose();
  for (int i = 0; i < body_rows; ++i) {
    for (int j = 0; j < body_columns; ++j)
      values[static_cast<std::size_t>(slots_[static_cast<std::size_t>(body_columns * i + j)])] += by(i, j);
  }
}

void LawPart::events(const DaePoint& at, std::span<double> values) {
  values[0] = geometry(at.time, at.y).penetration;
}

ContactSample LawPart::sample(const DaePoint& at) const {
  const Geometry g = geometry(at.time, at.y);
  ContactSample s;
  s.closed = g.penetration > 0.0;
  s.gap = -g.penetration;
  s.normal_force = g.law.x();
  s.force = g.law.x() * spring_.direction;
  s.point = at.y.segment<3>(body_.position()) + g.r * g.arm;
  return s;
}

LawPart::Power LawPart::power(const DaePoint& at) const {
  const Geometry g = geometry(at.time, at.y);
  return {spring_.law.energy(g.penetration), (g.law.x() - spring_.law.elastic(g.penetration).x()) * g.rate};
}

// The plane takes the force from outside, and does work where it moves.
void LawPart::add_rates(const DaePoint& at, const IntegralRates& rates) const {
  const ContactSample s = sample(at);
  Eigen::Ref<Eigen::VectorXd> all = rates.all;
  all.segment<3>(rates.force) = s.force;
  all[rates.normal] = s.normal_force;
  all[integral::laws] += power(at).lost;
  all[integral::work] -= s.normal_force * spring_.origin_speed;
  all.segment<3>(integral::outer) -= s.force;
  all.segment<3>(integral::outer_moment) -= s.point.cross(s.force);
}

Interaction::Load LawPart::load(const DaePoint& at) const {
  const ContactSample s = sample(at);
  return {s.force, s.normal_force};
}

Interaction::Observed LawPart::observe(const DaePoint& now, double /*time_before*/,
                                       const Eigen::VectorXd& /*before*/) {
  return {.normal = sample(now).normal_force, .events = {}};
}

}  // namespace snare::coupling
