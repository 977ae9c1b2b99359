#include "coupling/dynamics/contact/contact_geometry.hpp"

#include <cmath>

namespace snare::coupling {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;
using numerics::VectorView;

namespace {

/// An axis of the world well across a unit vector.
Vector3d axis_across(const Vector3d& n) {
  constexpr double steep = 0.9;
  return std::abs(n.z()) < steep ? Vector3d::UnitZ() : Vector3d::UnitX();
}

}  // namespace

ContactGeometry contact_geometry(const MotionContact& contact, const ContactShape& shape,
                                 const CurvePoint& curve, const BodyPart& body, const VectorView& y,
                                 const BristlesBeside& beside, ContactPlace place) {
  ContactGeometry g;
  const bool at_mount = place == ContactPlace::mount;
  static_cast<CurvePoint&>(g) = curve;
  // The shape: distance, normal and Hessian in S, at R_WS^T (r - R_WB p_BS).
  const Vector4d q = y.segment<4>(body.quaternion());
  g.R_WB = multibody::rotation(q);
  g.arm = g.x - y.segment<3>(body.position());
  const Matrix3d R_WS = g.R_WB * contact.X_BS.R;
  const Vector3d in_shape = R_WS.transpose() * (g.arm - g.R_WB * contact.X_BS.p);
  const DistanceField field = shape.at(in_shape);
  g.gap = field.distance - contact.wire_radius;
  g.normal = R_WS * field.normal;
  g.hessian = R_WS * field.hessian * R_WS.transpose();
  // Velocity of the wire against the body.
  g.omega = g.R_WB * y.segment<3>(body.spin());
  g.body_velocity = y.segment<3>(body.velocity());
  g.relative = g.v - g.body_velocity - g.omega.cross(g.arm);
  g.gap_rate = g.normal.dot(g.relative);
  g.direction = g.slope.normalized();
  // Tangent plane and forces.
  constexpr double upright = 1e-3;  // sine of the angle between wire and normal
  Vector3d level = g.slope - g.normal.dot(g.slope) * g.normal;
  g.by_wire = !at_mount && level.norm() > upright * g.slope.norm();
  g.toward = g.by_wire ? g.slope : axis_across(g.normal);
  if (!g.by_wire) level = g.toward - g.normal.dot(g.toward) * g.normal;
  g.run = level.norm();
  g.along = level / g.run;
  g.across = g.normal.cross(g.along);
  g.state.sliding = {g.along.dot(g.relative), g.across.dot(g.relative)};
  if (contact.law) {  // at a minimum of the gap n.t is zero
    const Vector3d force = contact.law(-g.gap, -g.gap_rate), spring = contact.law.elastic(-g.gap);
    g.load = {force[0], -force[1], -force[2]};
    g.elastic = {spring[0], -spring[1], spring[2]};
    g.opening = Opening::of_gap(g.gap_rate);
  } else {
    const double across = g.gap_rate - g.normal.dot(g.direction) * g.direction.dot(g.relative);
    g.opening = at_mount ? Opening::of_gap(g.gap_rate) : Opening::between(g.gap_rate, across);
    g.load = contact.foundation.load(g.gap, g.opening.rate);
    g.elastic = contact.foundation.elastic_load(g.gap);
  }
  g.state.normal = g.load[0];
  g.state.elastic = g.elastic[0];
  if (contact.friction.has_bristle()) {
    g.shape_functions = beside.shape_functions;
    for (std::size_t h = 0; h < 2; ++h) {
      BristleState at = g.state;
      at.bristle = beside.bristles[h];
      g.of_bristles[h] = tangent_force(contact.friction, at);
      g.friction.add(g.shape_functions[h], g.of_bristles[h]);
    }
  } else if (contact.friction.acts()) {
    g.friction = tangent_force(contact.friction, g.state);
  }
  g.force = g.state.normal * g.normal - g.in_world(g.friction.force);
  return g;
}

// Against the turned body the wire's point moves by rho = dX - dp - phi x r; then dg = n.rho and dn = H rho +
// phi x n.
ContactChange contact_change(const MotionFriction& friction, const ContactGeometry& g,
                             const ContactDirection& d) {
  ContactChange c;
  const Vector3d dx = d.x + g.slope * d.zeta;
  const Vector3d dslope = d.slope + g.bend * d.zeta;
  const Vector3d darm = dx - d.p;
  const Vector3d rho = darm - d.turn.cross(g.arm);
  c.normal = g.hessian * rho + d.turn.cross(g.normal);
  c.gap = g.normal.dot(rho);
  c.tangency = g.slope.dot(c.normal) + g.normal.dot(dslope);
  // dw = dv - dv_B - domega x r - omega x dr,  domega = phi x omega + R dspin;  d(dg/dt) = w.dn + n.dw
  const Vector3d domega = d.turn.cross(g.omega) + g.R_WB * d.spin;
  const Vector3d drelative =
      d.v + g.slope_v * d.zeta - d.body_velocity - domega.cross(g.arm) - g.omega.cross(darm);
  c.gap_rate = g.relative.dot(c.normal) + g.normal.dot(drelative);
  double opening = (g.opening.by_gap + g.opening.by_across) * c.gap_rate;
  if (g.opening.by_across != 0.0) {
    const Vector3d ddirection = (dslope - g.direction.dot(dslope) * g.direction) / g.slope.norm();
    opening -= g.opening.by_across *
               ((c.normal.dot(g.direction) + g.normal.dot(ddirection)) * g.direction.dot(g.relative) +
                g.normal.dot(g.direction) * (ddirection.dot(g.relative) + g.direction.dot(drelative)));
  }
  c.load = g.load[1] * c.gap + g.load[2] * opening;
  c.force = c.load * g.normal + g.state.normal * c.normal;
  if (friction.acts()) {
    // The axes turn with e and n: |u| da = du - a (a.du), du = de - d(n.e) n - (n.e) dn, db = dn x a + n x
    // da.
    const Vector3d dtoward = g.by_wire ? dslope : Vector3d::Zero();
    const Vector3d du = dtoward - (c.normal.dot(g.toward) + g.normal.dot(dtoward)) * g.normal -
                        g.normal.dot(g.toward) * c.normal;
    const Vector3d dalong = (du - g.along.dot(du) * g.along) / g.run;
    const Vector3d dacross = c.normal.cross(g.along) + g.normal.cross(dalong);
    c.sliding = {dalong.dot(g.relative) + g.along.dot(drelative),
                 dacross.dot(g.relative) + g.across.dot(drelative)};
    c.elastic = g.elastic[1] * c.gap;
    c.elastic_rate = g.elastic[2] * g.gap_rate * c.gap + g.elastic[1] * c.gap_rate;
    c.friction =
        g.friction.by_sliding * c.sliding + g.friction.by_normal * c.load + g.friction.by_elastic * c.elastic;
    for (std::size_t h = 0; h < 2; ++h)
      c.friction += g.shape_functions[h] * g.of_bristles[h].by_bristle * d.bristles[h];
    c.force -= g.in_world(c.friction) + g.friction.force.x() * dalong + g.friction.force.y() * dacross;
  }
  // Torque on the body, in the body: m = R^T (r x -f), dm = R^T (d(r x -f) - phi x (r x -f)).
  const Vector3d moment = -g.arm.cross(g.force);
  const Vector3d dmoment = -darm.cross(g.force) - g.arm.cross(c.force);
  c.torque = g.R_WB.transpose() * (dmoment - d.turn.cross(moment));
  return c;
}

}  // namespace snare::coupling
