#include "coupling/dynamics/run/check.hpp"

#include "base/index.hpp"
#include "coupling/dynamics/joints/constraint_set.hpp"
#include "coupling/dynamics/model/complaints.hpp"

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace snare::coupling {

namespace {

bool presses_on_body(ContactKind kind) {
  return kind == ContactKind::shape || kind == ContactKind::law_wire || kind == ContactKind::bodies;
}

void validate_friction(Complaints& c, const std::string& key, const MotionFriction& f) {
  const auto not_negative = [&](const std::string& name, double value) {
    c.require(std::isfinite(value) && value >= 0.0, key + name, value, "must be >= 0");
  };
  not_negative("static_coefficient", f.static_coefficient);
  not_negative("dynamic_coefficient", f.dynamic_coefficient);
  if (f.law == ContactFriction::smooth) {
    c.require(f.static_speed > 0.0 && f.dynamic_speed > f.static_speed, key + "static_speed", f.static_speed,
              "must be > 0 and < dynamic_speed");
    return;
  }
  const bool at_once = f.static_speed == 0.0 && f.dynamic_speed == 0.0;
  c.require(at_once || (f.static_speed >= 0.0 && f.dynamic_speed > f.static_speed), key + "static_speed",
            f.static_speed, "must be >= 0 and < dynamic_speed, or both 0");
  c.require(f.static_coefficient >= f.dynamic_coefficient, key + "static_coefficient", f.static_coefficient,
            "must be at least the dynamic coefficient");
  for (const auto& [name, value] :
       {std::pair{"bristle_displacement", f.bristle_displacement}, {"bristle_time", f.bristle_time}}) {
    c.require(std::isfinite(value) && value > 0.0, key + name, value, "must be > 0");
  }
}

void validate_foundation(Complaints& c, const std::string& key, const ElasticFoundation& f) {
  c.require(std::isfinite(f.modulus) && f.modulus >= 0.0, key + "modulus", f.modulus,
            "must be > 0, or 0 for the default");
  c.require(std::isfinite(f.damping) && f.damping >= 0.0, key + "damping", f.damping, "must be >= 0");
}

void validate_laws(const Motion& motion, Complaints& c) {
  const auto at_least_zero = [&c](const std::string& key, double value) {
    c.require(std::isfinite(value) && value >= 0.0, key, value, "must be >= 0");
  };
  for (const LawWire& w : motion.law_wires) {
    for (const MotionCarrier& carrier : {w.from, w.to, w.shaft.carrier})
      ConstraintSet::check_carrier(motion, w.name, carrier, c);
    at_least_zero(w.name + ".axial_time", w.axial_time);
    at_least_zero(w.name + ".standoff", w.standoff);
    at_least_zero(w.name + ".radius", w.radius);
    at_least_zero(w.name + ".shaft.radius", w.shaft.radius);
    c.require(w.shaft.half_length > 0.0, w.name + ".shaft.half_length", w.shaft.half_length, "must be > 0");
    c.require((w.p_to - w.p_from).norm() > 0.0, w.name + ".p_to", 0.0, "must not be where the wire begins");
    c.require(w.friction.law == ContactFriction::smooth || !w.friction.acts(), w.name + ".friction", 0.0,
              "must be the smooth law");
    validate_friction(c, w.name + ".friction.", w.friction);
    if (w.kind == LawWire::Kind::stretched) {
      c.require(w.length > 0.0 && w.axial_stiffness > 0.0, w.name + ".length", w.length,
                "must be > 0, and so the axial stiffness");
    } else if (w.kind == LawWire::Kind::rod) {
      c.require(static_cast<bool>(w.law), w.name + ".law", 0.0, "must be given");
    } else {
      c.require(static_cast<bool>(w.push), w.name + ".push", 0.0, "must be given");
      c.require(w.from == w.to, w.name + ".to", 0.0, "must be the carrier of the other mount");
    }
  }
  for (const BodyContact& b : motion.body_contacts) {
    ConstraintSet::check_carrier(motion, b.name, b.carrier, c);
    ConstraintSet::check_carrier(motion, b.name, b.other, c);
    c.require(b.shape != nullptr, b.name + ".shape", 0.0, "must be given");
    c.require(static_cast<bool>(b.law), b.name + ".law", 0.0, "must be given");
    c.require(!b.points.empty(), b.name + ".points", 0.0, "must be at least one");
    at_least_zero(b.name + ".radius", b.radius);
    validate_friction(c, b.name + ".friction.", b.friction);
  }
  for (const FrameLoad& l : motion.loads) {
    ConstraintSet::check_carrier(motion, l.name, l.carrier, c);
    const auto n = static_cast<Eigen::Index>(l.times.size());
    c.require(n >= 2 && l.forces.cols() == n && l.moments.cols() == n, l.name + ".times",
              static_cast<double>(n), "must be at least two, with a force and a moment each");
    c.require(std::is_sorted(l.times.begin(), l.times.end()), l.name + ".times", 0.0, "must ascend");
    c.require(l.forces.allFinite() && l.moments.allFinite(), l.name + ".forces", std::nan(""),
              "must be finite");
  }
}

void require_positive(Complaints& c, const std::string& key, double value) {
  c.require(std::isfinite(value) && value > 0.0, key, value, "must be > 0");
}

void validate_options(const MotionOptions& options, Complaints& c) {
  require_positive(c, "duration", options.duration);
  require_positive(c, "output_interval", options.output_interval);
  require_positive(c, "relative_tolerance", options.relative_tolerance);
  require_positive(c, "position_tolerance", options.position_tolerance);
  require_positive(c, "velocity_tolerance", options.velocity_tolerance);
  require_positive(c, "quasi_static_velocity_tolerance", options.quasi_static_velocity_tolerance);
  require_positive(c, "twist_tolerance", options.twist_tolerance);
  require_positive(c, "body_position_tolerance", options.body_position_tolerance);
  require_positive(c, "body_velocity_tolerance", options.body_velocity_tolerance);
  require_positive(c, "angle_tolerance", options.angle_tolerance);
  require_positive(c, "spin_tolerance", options.spin_tolerance);
  require_positive(c, "newton_share", options.newton_share.value_or(1.0));
  c.require(options.peak_window >= 0.0, "peak_window", options.peak_window, "must be >= 0");
  c.require(options.checkpoint_interval > 0.0, "checkpoint_interval", options.checkpoint_interval,
            "must be > 0");
  const int order = options.max_order.value_or(1);
  c.require(order >= 1 && order <= 5, "max_order", order, "must be 1 to 5");
}

void validate_wire(const MotionWire& w, Complaints& c) {
  require_positive(c, w.name + ".length", w.rod.length);
  require_positive(c, w.name + ".mass_per_length", w.rod.mass_per_length);
  require_positive(c, w.name + ".axial_stiffness", w.rod.properties.axial_stiffness);
  require_positive(c, w.name + ".bending_stiffness", w.rod.properties.bending_stiffness);
  require_positive(c, w.name + ".torsional_stiffness", w.rod.properties.torsional_stiffness);
  c.require(w.strength.breaking_tension > 0.0, w.name + ".strength", w.strength.breaking_tension,
            "must be > 0");
  c.require(w.rod.elements >= 4, w.name + ".elements", w.rod.elements, "must be >= 4");
  if (w.rod.strands.act()) {
    require_positive(c, w.name + ".strands.slip_curvature", w.rod.strands.slip_curvature);
    require_positive(c, w.name + ".strands.time", w.rod.strands.time);
  }
  c.require(w.positions.cols() == w.rod.elements + 1, w.name + ".positions",
            static_cast<double>(w.positions.cols()), "must be one more than the elements");
  c.require(w.velocities.cols() == 0 || w.velocities.cols() == w.rod.elements + 1, w.name + ".velocities",
            static_cast<double>(w.velocities.cols()), "must be none or one more than the elements");
  c.require(w.positions.allFinite() && w.velocities.allFinite(), w.name + ".positions", std::nan(""),
            "must be finite");
}

void validate_body(const Motion& motion, const MotionBody& b, Complaints& c) {
  require_positive(c, b.name + ".mass", b.properties.mass);
  const Eigen::LLT<Eigen::Matrix3d> factor(b.properties.inertia);
  c.require(factor.info() == Eigen::Success, b.name + ".inertia", b.properties.inertia.trace(),
            "must be positive definite");
  c.require(static_cast<bool>(b.course_velocity) == static_cast<bool>(b.course_acceleration),
            b.name + ".course", b.course_velocity ? 1.0 : 0.0,
            "must have both velocity and acceleration, or none");
  if (b.robot) {
    c.require(b.driven && !b.course_velocity, b.name + ".robot", 0.0,
              "must be of a driven body without a course");
    require_positive(c, b.name + ".robot.mass", b.robot->mass);
    require_positive(c, b.name + ".robot.delay", b.robot->delay);
    for (const MotionRobot::Measured& m : b.robot->measured)
      c.require(m.contact >= 0 && m.contact < static_cast<int>(motion.contact_names().size()) &&
                    presses_on_body(motion.contact_place(base::at(m.contact)).kind),
                b.name + ".robot.contact", m.contact, "must be the index of a contact of a body");
  }
  c.require(std::abs(b.start.orientation.norm() - 1.0) < 1e-9, b.name + ".orientation",
            b.start.orientation.norm(), "must be a unit quaternion");
}

void validate_contact(const Motion& motion, const MotionContact& k, Complaints& c) {
  c.require(k.wire >= 0 && k.wire < static_cast<int>(motion.wires.size()), k.name + ".wire", k.wire,
            "must be the index of a wire");
  c.require(k.body >= 0 && k.body < static_cast<int>(motion.bodies.size()), k.name + ".body", k.body,
            "must be the index of a body");
  c.require(k.shape != nullptr, k.name + ".shape", 0.0, "must be given");
  validate_foundation(c, k.name + ".foundation.", k.foundation);
  c.require(std::isfinite(k.wire_radius) && k.wire_radius >= 0.0, k.name + ".wire_radius", k.wire_radius,
            "must be >= 0");
  c.require(!k.shape || k.shape->smallest_radius() > 0.0 || k.wire_radius > 0.0, k.name + ".wire_radius",
            k.wire_radius, "must be > 0 for a shape with edges");
  validate_friction(c, k.name + ".friction.", k.friction);
}

void validate_pair(const Motion& motion, const WirePair& p, Complaints& c) {
  bool both = true;
  for (std::size_t w = 0; w < 2; ++w) {
    both = c.require(p.wires[w] >= 0 && p.wires[w] < static_cast<int>(motion.wires.size()), p.name + ".wires",
                     p.wires[w], "must be indices of wires") &&
           both;
    require_positive(c, p.name + ".radii", p.radii[w]);
  }
  c.require(!both || p.wires[0] != p.wires[1], p.name + ".wires", p.wires[0], "must be two different wires");
  validate_foundation(c, p.name + ".foundation.", p.foundation);
  validate_friction(c, p.name + ".friction.", p.friction);
}

void validate_point_contact(const Motion& motion, const PointContactLaw& s, Complaints& c) {
  c.require(s.body >= 0 && s.body < static_cast<int>(motion.bodies.size()), s.name + ".body", s.body,
            "must be the index of a body");
  c.require(std::abs(s.direction.norm() - 1.0) < 1e-12, s.name + ".direction", s.direction.norm(),
            "must be a unit vector");
  c.require(static_cast<bool>(s.law), s.name + ".law", 0.0, "must be given");
}

void validate_mount(const Motion& motion, const MotionMount& m, Complaints& c) {
  if (m.wire < 0 || m.wire >= static_cast<int>(motion.wires.size())) return;  // ConstraintSet::check says so
  const MotionWire& w = motion.wires[base::at(m.wire)];
  c.require(m.carrier.kind == MotionCarrier::Kind::world || w.rod.damping.mass_rate == 0.0,
            w.name + ".damping.mass_rate", w.rod.damping.mass_rate,
            fmt::format("must be 0: it drags against the world, which {} leaves", m.name));
}

void validate_sensed(const Motion& motion, Complaints& c) {
  for (const SensedSignal& s : motion.sensed) {
    require_positive(c, "sensed.interval", s.interval);
    c.require(s.delay >= 0.0, "sensed.delay", s.delay, "must be >= 0");
    c.require(static_cast<bool>(s.make), "sensed.make", 0.0, "must be given");
  }
  for (const MotionPhase& p : motion.phases) {
    for (const SensedBound& b : p.sensed)
      c.require(b.sensed >= 0 && b.sensed < static_cast<int>(motion.sensed.size()), p.name + ".sensed",
                b.sensed, "must be the index of a sensed signal");
  }
}

}  // namespace

void require_valid(const Motion& motion, const MotionOptions& options) {
  Complaints c;
  validate_options(options, c);
  for (const MotionWire& w : motion.wires) validate_wire(w, c);
  for (const MotionBody& b : motion.bodies) validate_body(motion, b, c);
  for (const MotionContact& k : motion.contacts) validate_contact(motion, k, c);
  for (const WirePair& p : motion.wire_pairs) validate_pair(motion, p, c);
  for (const PointContactLaw& s : motion.point_contacts) validate_point_contact(motion, s, c);
  for (const MotionMount& m : motion.mounts) validate_mount(motion, m, c);
  validate_sensed(motion, c);
  ConstraintSet::check(motion, c);
  validate_laws(motion, c);
  c.raise();
}

}  // namespace snare::coupling
