// What forces and impulses at a point of contact do to wire, body and mounts.

#include "coupling/dynamics/contact_part.hpp"

namespace snare::coupling {

using Eigen::Vector3d;
using numerics::VectorView;

// An impulse P on the wire: dv_k = N_k P/m_k of the components that nothing holds; -P on the body, dv_B = -P/m and
// dw = -I^-1 R^T (r x P) in the body.
void ContactPart::respond_along(const Geometry& g, const Vector3d& impulse, Eigen::VectorXd& dv) const {
  for (int k = 0; k < 4; ++k) {
    const int i = g.weights.first + k;
    for (int a = 0; a < 3; ++a) {
      if (!rod_.is_held(i, a)) dv[rod_.velocity_of(i) + a] += g.weights.value[k] * impulse[a] / rod_.mass_of(i);
    }
  }
  if (!body_.moves_freely()) return;
  dv.segment<3>(body_.velocity()) -= impulse / body_.body().properties.mass;
  dv.segment<3>(body_.spin()) -= body_.inverse_inertia() * (g.R_WB.transpose() * g.arm.cross(impulse));
}

void ContactPart::apply_impulse(const VectorView& y, double impulse, Eigen::VectorXd& dv) const {
  const Geometry g = geometry(y);
  respond_along(g, impulse * g.normal, dv);
}

// The normal force with the friction that is proportional to it: lambda (n - df/dlambda).
void ContactPart::respond_with_friction(const VectorView& y, double force, Eigen::VectorXd& rate) const {
  const Geometry g = geometry(y);
  respond_along(g, force * (g.normal - g.in_world(g.friction.by_normal)), rate);
}

std::array<Vector3d, 2> ContactPart::force_on_mounts(const VectorView& y) const {
  if (!closed_) return {Vector3d::Zero(), Vector3d::Zero()};
  return share_of_mounts(y, geometry(y).force);
}

std::array<Vector3d, 2> ContactPart::share_of_mounts(const VectorView& y, const Vector3d& force) const {
  std::array<Vector3d, 2> result{Vector3d::Zero(), Vector3d::Zero()};
  const CurveWeights w = weights(y);
  for (int k = 0; k < 4; ++k) {
    const int i = w.first + k;
    if (i != 0 && i != rod_.vertices() - 1) continue;
    for (int a = 0; a < 3; ++a) {
      if (rod_.is_held(i, a)) result[i == 0 ? 0 : 1][a] += w.value[k] * force[a];
    }
  }
  return result;
}

Vector3d ContactPart::normal(const VectorView& y) const {
  return geometry(y).normal;
}

double ContactPart::gap_rate_of(const VectorView& y, const Eigen::VectorXd& velocities) const {
  const Geometry g = geometry(y);
  Vector3d v = Vector3d::Zero();
  for (int k = 0; k < 4; ++k) v += g.weights.value[k] * velocities.segment<3>(rod_.velocity_of(g.weights.first + k));
  return g.normal.dot(v - velocities.segment<3>(body_.velocity()) -
                      (g.R_WB * velocities.segment<3>(body_.spin())).cross(g.arm));
}

double ContactPart::gap_acceleration_at_rest(const VectorView& y) const {
  const Geometry g = geometry(y);
  ContactDirection d;
  d.x = g.v;
  d.slope = g.slope_v;
  d.p = g.body_velocity;
  d.turn = g.omega;
  // zeta keeps the tangency n.X' = 0: its rate is -(d(n.X')/dt at zeta kept)/(d(n.X')/dzeta).
  if (!fixed_) d.zeta = -contact_change(contact_.friction, g, d).tangency / gap_curvature(g);
  return contact_change(contact_.friction, g, d).gap_rate;
}

}  // namespace snare::coupling
