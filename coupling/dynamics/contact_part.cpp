#include "coupling/dynamics/contact_part.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace snare::coupling {

using Eigen::Vector2d;
using Eigen::Vector3d;
using numerics::DaeKind;
using numerics::DaePoint;
using numerics::VectorView;

ContactPart::ContactPart(const MotionContact& contact, const wire::RodPart& rod, const BodyPart& body,
                         const MotionOptions& options)
    : contact_(contact), rod_(rod), body_(body), options_(options) {
  assert(contact.shape && rod.vertices() >= 5);
}

void ContactPart::declare(numerics::DaeLayout& layout) {
  coordinate_ =
      layout.add({contact_.name + " material coordinate", {}, 1, DaeKind::algebraic, options_.position_tolerance, 0});
  layout.add({contact_.name + " normal force", {}, 1, DaeKind::algebraic, options_.force_tolerance, 0});
  layout.add({contact_.name + " stabiliser", {}, 1, DaeKind::algebraic, numerics::no_tolerance, 0});
  // A hundredth of what it gives before it slips.
  if (has_bristle()) {
    layout.add({contact_.name + " bristle",
                {"along", "across"},
                2,
                DaeKind::differential,
                0.01 * contact_.friction.bristle_displacement,
                0});
  }
}

std::vector<int> ContactPart::local_unknowns(int first_vertex) const {
  std::vector<int> list;
  const int end = std::min(rod_.vertices(), first_vertex + window_size);
  for (int i = first_vertex; i < end; ++i) {
    for (int k = 0; k < 3; ++k) list.push_back(rod_.position_of(i) + k);
    for (int k = 0; k < 3; ++k) list.push_back(rod_.velocity_of(i) + k);
  }
  for (int k = 0; k < BodyPart::coordinates; ++k) list.push_back(body_.position() + k);
  for (int k = 0; k < BodyPart::velocities; ++k) list.push_back(body_.velocity() + k);
  for (const int own : own_unknowns()) list.push_back(own);
  return list;
}

std::vector<int> ContactPart::own_unknowns() const {
  std::vector<int> list{coordinate_unknown(), force_unknown(), stabiliser_unknown()};
  for (int a = 0; has_bristle() && a < 2; ++a) list.push_back(bristle_unknown() + a);
  return list;
}

void ContactPart::sparsity(std::vector<std::pair<int, int>>& entries) const {
  for (const int own : own_unknowns()) entries.emplace_back(own, own);
  if (!coupled_) return;
  const std::vector<int> all = local_unknowns(window_);
  const int end = std::min(rod_.vertices(), window_ + window_size);
  const auto whole_row = [&](int row) {
    for (const int column : all) entries.emplace_back(row, column);
  };
  // Balances and kinematics of the wire, balances of the body, and the own rows.
  for (int i = window_; i < end; ++i) {
    for (int k = 0; k < 3; ++k) {
      if (rod_.is_held(i, k)) continue;
      whole_row(rod_.velocity_of(i) + k);
      entries.emplace_back(rod_.position_of(i) + k, stabiliser_unknown());
    }
  }
  if (body_.moves_freely()) {
    for (int k = 0; k < BodyPart::velocities; ++k) whole_row(body_.velocity() + k);
  }
  for (const int own : own_unknowns()) whole_row(own);
}

void ContactPart::attach_pattern(const numerics::SparseMatrix& pattern) {
  pattern_ = &pattern;
}

CurveWeights ContactPart::weights(const VectorView& y) const {
  return curve_weights(rod_, std::clamp(y[coordinate_unknown()], 0.0, rod_.coordinate(rod_.vertices() - 1)));
}

ContactPart::Geometry ContactPart::geometry(const VectorView& y) const {
  const CurveWeights w = weights(y);
  CurvePoint curve;
  for (int k = 0; k < 4; ++k) {
    const Vector3d x = y.segment<3>(rod_.position_of(w.first + k));
    const Vector3d v = y.segment<3>(rod_.velocity_of(w.first + k));
    curve.x += w.value[k] * x;
    curve.slope += w.slope[k] * x;
    curve.bend += w.bend[k] * x;
    curve.v += w.value[k] * v;
    curve.slope_v += w.slope[k] * v;
  }
  const Vector2d bristle = has_bristle() ? Vector2d(y.segment<2>(bristle_unknown())) : Vector2d::Zero();
  return {contact_geometry(contact_, mode_, curve, body_, y, y[force_unknown()], bristle), w};
}

void ContactPart::residual(const DaePoint& at, Eigen::Ref<Eigen::VectorXd> rows) {
  const double zeta = at.y[coordinate_unknown()], lambda = at.y[force_unknown()], mu = at.y[stabiliser_unknown()];
  if (!closed_) {
    rows[coordinate_unknown()] += zeta - kept_coordinate_;
    rows[force_unknown()] += lambda;
    rows[stabiliser_unknown()] += mu;
    if (has_bristle()) rows.segment<2>(bristle_unknown()) += at.y.segment<2>(bristle_unknown());
    return;
  }
  const Geometry g = geometry(at.y);
  // The wire: m v_k' + ... - N_k f = 0,  x_k' - v_k - N_k n mu/m_k = 0, but for components that a mount holds.
  for (int k = 0; k < 4; ++k) {
    const int i = g.weights.first + k;
    for (int a = 0; a < 3; ++a) {
      if (rod_.is_held(i, a)) continue;
      rows[rod_.velocity_of(i) + a] -= g.weights.value[k] * g.force[a];
      rows[rod_.position_of(i) + a] -= g.weights.value[k] * g.normal[a] * mu / rod_.mass_of(i);
    }
  }
  // The body: inertia less forces, + f in the world and + R^T (r x f) in the body.
  if (body_.moves_freely()) {
    rows.segment<3>(body_.velocity()) += g.force;
    rows.segment<3>(body_.spin()) += g.R_WB.transpose() * g.arm.cross(g.force);
  }
  // The bristle: z' - rate of its mode = 0.
  if (has_bristle()) {
    rows.segment<2>(bristle_unknown()) +=
        at.rate.segment<2>(bristle_unknown()) - bristle_rate(contact_.friction, mode_, g.state);
  }
  // zeta: n.X' = 0, or its material point. lambda and mu: g = 0 and dg/dt = 0, or the law and mu = 0.
  rows[coordinate_unknown()] += fixed_ ? zeta - kept_coordinate_ : g.normal.dot(g.slope);
  if (has_law()) {
    rows[force_unknown()] += g.state.normal - contact_.law(-g.gap, -g.gap_rate)[0];
    rows[stabiliser_unknown()] += mu;
  } else {
    rows[force_unknown()] += g.gap;
    rows[stabiliser_unknown()] += g.gap_rate;
  }
}

// One column after another: the unknown's direction, and what changes along it in all rows.
void ContactPart::jacobian(const DaePoint& at, double rate_factor, std::vector<double>& values) {
  const numerics::PatternValues into(*pattern_, values);
  if (!closed_) {
    for (const int own : own_unknowns()) into.add(own, own, 1.0);
    return;
  }
  const Geometry g = geometry(at.y);
  const Vector3d law = has_law() ? contact_.law(-g.gap, -g.gap_rate) : Vector3d::Zero();
  const auto column = [&](int unknown, const ContactDirection& d) {
    const ContactChange c = contact_change(contact_.friction, g, d);
    // Wire and body: -d(N_k f) with dN_k = N_k' dzeta, + df, and -dm for the torque m on the body.
    for (int k = 0; k < 4; ++k) {
      const Vector3d row = -g.weights.value[k] * c.force - g.weights.slope[k] * d.zeta * g.force;
      for (int a = 0; a < 3; ++a) {
        const int i = g.weights.first + k;
        if (!rod_.is_held(i, a)) into.add(rod_.velocity_of(i) + a, unknown, row[a]);
      }
    }
    if (body_.moves_freely()) {
      for (int a = 0; a < 3; ++a) {
        into.add(body_.velocity() + a, unknown, c.force[a]);
        into.add(body_.spin() + a, unknown, -c.torque[a]);
      }
    }
    // Bristle: its rate is the sliding while it sticks, (f/k - z)/tau while it slips.
    for (int a = 0; has_bristle() && a < 2; ++a) {
      const double rate =
          mode_ == FrictionMode::stick
              ? c.sliding[a]
              : (c.friction[a] / contact_.friction.bristle_stiffness() - d.bristle[a]) / contact_.friction.bristle_time;
      into.add(bristle_unknown() + a, unknown, -rate);
    }
    // Tangency, gap and its rate, or the law: lambda - law(-g, -dg/dt).
    if (!fixed_) into.add(coordinate_unknown(), unknown, c.tangency);
    if (has_law()) {
      into.add(force_unknown(), unknown, d.lambda + law[1] * c.gap + law[2] * c.gap_rate);
    } else {
      into.add(force_unknown(), unknown, c.gap);
      into.add(stabiliser_unknown(), unknown, c.gap_rate);
    }
  };
  // Vertices.
  for (int k = 0; k < 4; ++k) {
    const int i = g.weights.first + k;
    for (int a = 0; a < 3; ++a) {
      ContactDirection place;
      place.x = g.weights.value[k] * Vector3d::Unit(a);
      place.slope = g.weights.slope[k] * Vector3d::Unit(a);
      // The velocity's share in N' zeta is in g.slope_v already.
      column(rod_.position_of(i) + a, place);
      ContactDirection velocity;
      velocity.v = g.weights.value[k] * Vector3d::Unit(a);
      column(rod_.velocity_of(i) + a, velocity);
      if (!rod_.is_held(i, a)) {
        into.add(rod_.position_of(i) + a, stabiliser_unknown(), -g.weights.value[k] * g.normal[a] / rod_.mass_of(i));
      }
    }
  }
  // The body: dq turns it by 4 R Q^T dq in the world.
  const Eigen::Matrix<double, 3, 4> turn =
      4.0 * g.R_WB * multibody::quaternion_rates(at.y.segment<4>(body_.quaternion())).transpose();
  for (int a = 0; a < 4; ++a) {
    ContactDirection d;
    d.turn = turn.col(a);
    column(body_.quaternion() + a, d);
  }
  for (int a = 0; a < 3; ++a) {
    ContactDirection place;
    place.p = Vector3d::Unit(a);
    column(body_.position() + a, place);
    ContactDirection velocity;
    velocity.body_velocity = Vector3d::Unit(a);
    column(body_.velocity() + a, velocity);
    ContactDirection spin;
    spin.spin = Vector3d::Unit(a);
    column(body_.spin() + a, spin);
  }
  // The own unknowns.
  ContactDirection zeta;
  zeta.zeta = 1.0;
  column(coordinate_unknown(), zeta);
  ContactDirection lambda;
  lambda.lambda = 1.0;
  column(force_unknown(), lambda);
  for (int a = 0; has_bristle() && a < 2; ++a) {
    ContactDirection z;
    z.bristle = Vector2d::Unit(a);
    column(bristle_unknown() + a, z);
    into.add(bristle_unknown() + a, bristle_unknown() + a, rate_factor);
  }
  if (has_law()) into.add(stabiliser_unknown(), stabiliser_unknown(), 1.0);
  if (fixed_) into.add(coordinate_unknown(), coordinate_unknown(), 1.0);
}

void ContactPart::events(const DaePoint& at, std::span<double> values) {
  if (!closed_)
    values[0] = 1.0;
  else
    values[0] = has_law() ? -geometry(at.y).gap : at.y[force_unknown()] - least_force_;
}

ContactSample ContactPart::sample(const DaePoint& at) const {
  ContactSample s;
  const Geometry g = geometry(at.y);
  s.closed = closed_;
  s.gap = g.gap;
  s.force = g.force;
  s.normal_force = g.state.normal;
  s.point = g.x;
  s.arc = at.y[coordinate_unknown()];
  s.slip_speed = g.state.sliding.norm();
  s.sticking = has_bristle() && mode_ == FrictionMode::stick;
  return s;
}

double ContactPart::gap(const VectorView& y) const {
  return geometry(y).gap;
}

double ContactPart::gap_rate(const VectorView& y) const {
  return geometry(y).gap_rate;
}

}  // namespace snare::coupling
