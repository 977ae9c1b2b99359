#include "validation/linked_motion_checks.hpp"

#include "coupling/dynamics/model/start.hpp"
#include "coupling/dynamics/run/simulate.hpp"

#include <cmath>

namespace snare::validation {

namespace {

using coupling::Motion;
using coupling::MotionBody;
using coupling::MotionCarrier;
using coupling::MotionOptions;
using coupling::MotionResult;
using coupling::MotionSample;
using Eigen::Vector3d;

Row linked_row(const std::string& name, const std::string& unit, const std::string& source, Kind kind,
               double reference, double value, const Limit& limit) {
  return {"linked motion", name, unit, source, kind, reference, value, limit};
}

MotionOptions fine(double duration) {
  MotionOptions o;
  o.duration = o.output_interval = duration;
  o.relative_tolerance = 1e-8;
  o.position_tolerance = o.angle_tolerance = 1e-11;
  o.velocity_tolerance = o.spin_tolerance = 1e-8;
  o.max_order = 5;
  return o;
}

MotionBody block(double mass, const Vector3d& moments, const Vector3d& position) {
  MotionBody body;
  body.properties.mass = mass;
  body.properties.inertia = moments.asDiagonal();
  body.start.position = position;
  return body;
}

}  // namespace

// Two welded bodies of one symmetry axis are a free symmetric top: seen from it w turns about the axis with
// (I3 - I1)/I1 w3, and the axis goes round the momentum L with L/I1, so that the weld's force is m r L w1/I1.
std::vector<Row> welded_top_rows() {
  constexpr double duration = 10.0, w1 = 0.5, w3 = 2.0, m = 3.0, r = 1.0 / 3.0;
  constexpr double I1 = 0.3 + 0.4 + 2.0 * 0.25 + m * r * r, I3 = 0.2 + 0.25;
  Motion motion;
  motion.bodies = {block(2.0, {0.3, 0.3, 0.2}, {0.0, 0.0, 0.5}), block(m, {0.4, 0.4, 0.25}, {0.0, 0.0, -r})};
  const Vector3d spin(w1, 0.0, w3);
  motion.bodies[0].start.spin = spin;
  motion.bodies[0].start.velocity = spin.cross(motion.bodies[0].start.position);
  coupling::MotionWeld weld;
  weld.carrier = {MotionCarrier::Kind::body, 0, 0};
  weld.body = 1;
  motion.welds = {weld};
  MotionSample last;
  const MotionResult result = coupling::simulate(motion, fine(duration), [&](const MotionSample& s) {
    last = s;
    return false;
  });
  const double usable = result.report.usable() ? 0.0 : not_computed;
  const double angle = (I3 - I1) / I1 * w3 * duration;
  const double L = std::hypot(I1 * w1, I3 * w3);
  return {
      linked_row("two welded bodies as a symmetric top, w_x after 10 s", "rad/s", "Euler", Kind::closed_form,
                 w1 * std::cos(angle), last.bodies[1].spin.x() + usable, Limit::relative(1e-5)),
      linked_row("two welded bodies as a symmetric top, w_y after 10 s", "rad/s", "Euler", Kind::closed_form,
                 w1 * std::sin(angle), last.bodies[1].spin.y() + usable, Limit::relative(2e-6)),
      linked_row("two welded bodies as a symmetric top, force in the weld", "N", "m r L w1/I1",
                 Kind::closed_form, m * r * L * w1 / I1, last.welds[0].force.norm() + usable,
                 Limit::relative(1e-5)),
      linked_row("two welded bodies, largest gap of the weld", "m", "welded", Kind::closed_form, 0.0,
                 result.largest_drift + usable,
                 Limit::absolute(1e-8, "zero reference; a constraint between bodies that are a metre apart")),
      linked_row("two welded bodies, integrator's energy over the energy", "", "conservation",
                 Kind::closed_form, 0.0, result.energy.integrator / result.energy.kinetic + usable,
                 Limit::absolute(1e-6, "zero reference; the value is a share of the kinetic energy"))};
}

// A straight wire on a heavy body that spins about its middle: EA u'' = -m w^2 x between fixed ends, N = m
// w^2 (l^2/24 - x^2/2), so that either mount presses with m w^2 l^2/12.
std::vector<Row> moving_mount_rows() {
  constexpr double length = 0.2, spin = 6.0;
  wire::RodInMotion rod;
  rod.properties.bending_stiffness = rod.properties.second_bending_stiffness = 1e-3;
  rod.properties.torsional_stiffness = 8e-4;
  rod.properties.axial_stiffness = 1e3;
  rod.properties.right.position = {length, 0.0, 0.0};
  rod.mass_per_length = 0.01;
  rod.length = length;
  rod.elements = 60;
  rod.damping.axial_time = 2e-3;
  rod.damping.bending_time = 1e-2;
  Motion motion;
  const Vector3d middle(0.5 * length, 0.0, 0.0);
  motion.wires = {{"wire", rod, coupling::straight_wire(rod, Vector3d::Zero(), {length, 0.0, 0.0}),
                   Eigen::Matrix3Xd::Zero(3, 61)}};
  for (int i = 0; i <= 60; ++i)
    motion.wires[0].velocities.col(i) =
        spin * Vector3d::UnitZ().cross(motion.wires[0].positions.col(i) - middle);
  motion.bodies = {block(1e4, Vector3d::Constant(1e4), middle)};
  motion.bodies[0].start.spin = {0.0, 0.0, spin};
  for (const wire::End end : wire::ends) {
    coupling::MotionMount mount;
    mount.end = end;
    mount.carrier = {MotionCarrier::Kind::body, 0, 0};
    motion.mounts.push_back(mount);
  }
  MotionOptions options = fine(0.5);
  MotionSample last;
  const MotionResult result = coupling::simulate(motion, options, [&](const MotionSample& s) {
    last = s;
    return false;
  });
  const double usable = result.report.usable() ? 0.0 : not_computed;
  const Vector3d along = last.bodies[0].orientation * Vector3d::UnitX();
  const double reference = -0.01 * spin * spin * length * length / 12.0;
  double off = 0.0;
  for (int i = 0; i <= 60; ++i) {
    const Vector3d x =
        last.bodies[0].orientation.inverse() * (last.wires[0].col(i) - last.bodies[0].position);
    off = std::max(off, x.tail<2>().norm());
  }
  return {linked_row("wire on a spinning body, force of a mount along the wire", "N", "-m w^2 l^2/12",
                     Kind::closed_form, reference, last.mount_forces[1].dot(along) + usable,
                     Limit::relative(2e-3)),
          linked_row("wire on a spinning body, off its chord", "m", "straight", Kind::closed_form, 0.0,
                     off + usable, Limit::absolute(1e-7, "zero reference; the wire is 0.2 m long")),
          linked_row("wire on a spinning body, largest gap of its mounts", "m", "held", Kind::closed_form,
                     0.0, result.largest_drift + usable,
                     Limit::absolute(1e-8, "zero reference; a constraint of a wire that is 0.2 m long"))};
}

std::vector<Check> linked_motion_checks() {
  return {{"welded bodies", welded_top_rows}, {"mounts that move", moving_mount_rows}};
}

}  // namespace snare::validation
