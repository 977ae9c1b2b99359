#include "validation/friction_checks.hpp"

#include "base/units.hpp"
#include "coupling/dynamics/model/start.hpp"
#include "coupling/dynamics/run/simulate.hpp"
#include "coupling/statics/push_solver.hpp"
#include "validation/declared_wire.hpp"
#include "wire/motion/rod_in_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace snare::validation {

namespace {

using coupling::Motion;
using coupling::MotionEvent;
using coupling::MotionOptions;
using coupling::MotionResult;
using coupling::MotionSample;
using Eigen::Vector3d;
using std::numbers::pi;

using base::mm;
constexpr double g = 9.81;
using base::degree;

constexpr double thickness = 6.0 * mm;
constexpr double span = 40.0 * mm;
constexpr double cylinder_radius = 5.0 * mm;

/// A thick steel wire between clamps as ground (it gives by 0.3 um under 10 N, and rings at 1 kHz, damped),
/// and on its middle a cylinder of 1 kg across it, that does not turn and slides along its own axis z: a flat
/// block.
Motion block_on_wire() {
  wire::WireSpecification w = declared_specification();
  w.diameter = thickness;
  w.length = span;
  Motion motion;
  wire::RodInMotion rod = wire::rod_in_motion(w, span, 8);
  rod.damping.bending_time = rod.damping.axial_time = 1e-4;
  motion.wires.push_back({"wire", rod, coupling::straight_wire(rod, Vector3d::Zero(), {span, 0.0, 0.0}), {}});
  coupling::MotionBody body;
  body.properties.mass = 1.0;
  // The friction's moment of 0.02 N m turns it by 1e-9 rad in 10 s.
  body.properties.inertia = 1e9 * Eigen::Matrix3d::Identity();
  body.start.position = {0.5 * span, cylinder_radius + 0.5 * thickness, 0.0};
  motion.bodies.push_back(body);
  coupling::MotionContact contact;
  contact.shape = std::make_shared<coupling::EndlessCylinder>(cylinder_radius);
  contact.wire_radius = 0.5 * thickness;
  motion.contacts.push_back(contact);
  motion.gravity = {0.0, -g, 0.0};
  return motion;
}

Vector3d tilted_gravity(double angle) {
  return g * Vector3d(0.0, -std::cos(angle), std::sin(angle));
}

/// The slip has the dynamic coefficient at once: what textbooks call Coulomb's friction.
coupling::MotionFriction two_coefficients(double fixed, double sliding) {
  coupling::MotionFriction f;
  f.static_coefficient = fixed;
  f.dynamic_coefficient = sliding;
  f.static_speed = f.dynamic_speed = 0.0;
  return f;
}

MotionOptions accurate(double duration) {
  MotionOptions options;
  options.duration = duration;
  options.output_interval = duration / 1000.0;
  options.relative_tolerance = 1e-6;
  options.position_tolerance = 1e-9;
  options.velocity_tolerance = 1e-6;
  return options;
}

/// Place of the block along z at two times; NaN when the integration did not get there.
struct Travel {
  MotionResult result;
  double early = not_computed;
  double late = not_computed;
};

Travel travel(const Motion& motion, double early, double late) {
  Travel t;
  MotionOptions options = accurate(late);
  options.output_interval = early / 10.0;
  t.result = coupling::simulate(motion, options, [&](const MotionSample& s) {
    if (s.time <= (1.0 + 1e-9) * early) t.early = s.bodies[0].position.z();
    t.late = s.bodies[0].position.z();
    return false;
  });
  if (!t.result.report.usable()) t.late = not_computed;
  return t;
}

}  // namespace

std::vector<Row> incline_rows() {
  std::vector<Row> rows;
  Motion motion = block_on_wire();
  const double friction_angle = std::atan(0.3);
  motion.contacts[0].friction = {0.3, 0.1, 0.01, 1.0};
  motion.gravity = tilted_gravity(0.9 * friction_angle);
  // The block rings on its bristle at 280 Hz and decays by exp(-15 t/s): after a second 3e-7 of 1 um is left.
  const Travel rest = travel(motion, 1.0, 11.0);
  rows.push_back({"friction", "block at 0.9 of the friction angle, creep in 10 s", "m", "Coulomb: rest",
                  Kind::closed_form, 0.0, std::abs(rest.late - rest.early),
                  Limit::absolute(1e-9, "zero reference; a thousandth of the displacement of the bristle")});
  // The smooth law carries mu_static cos(a) m g only while it slides at static_speed x, x (3 - x^2)/2 =
  // tan(a)/mu_s.
  {
    motion.contacts[0].friction.law = coupling::ContactFriction::smooth;
    double x = 0.5;
    for (int k = 0; k < 50; ++k)
      x -= (0.5 * x * (3.0 - x * x) - std::tan(0.9 * friction_angle) / 0.3) / (1.5 * (1.0 - x * x));
    const Travel creeping = travel(motion, 0.1, 1.1);
    rows.push_back({"friction", "the same with the smooth law, creep in 1 s", "m", "root of its cubic",
                    Kind::closed_form, 0.01 * x, creeping.late - creeping.early, Limit::relative(1e-3)});
  }
  for (const double angle : {20.0 * degree, 35.0 * degree}) {
    motion.contacts[0].friction = two_coefficients(0.3, 0.1);
    motion.gravity = tilted_gravity(angle);
    double early = 0.0;
    double late = 0.0;
    const MotionResult r = coupling::simulate(motion, accurate(0.2), [&](const MotionSample& s) {
      if (s.time <= 0.1 + 1e-12) early = s.bodies[0].velocity.z();
      late = s.bodies[0].velocity.z();
      return false;
    });
    rows.push_back({"friction", fmt::format("acceleration down {:.0f} degrees", angle / degree), "m/s^2",
                    "g (sin a - mu cos a)", Kind::closed_form, g * (std::sin(angle) - 0.1 * std::cos(angle)),
                    r.report.usable() ? (late - early) / 0.1 : not_computed, Limit::relative(1e-4)});
  }
  return rows;
}

std::vector<Row> stopping_block_rows() {
  Motion motion = block_on_wire();
  constexpr double mu = 0.3;
  constexpr double speed = 0.2;
  motion.contacts[0].friction = two_coefficients(mu, mu);
  motion.bodies[0].start.velocity = {0.0, 0.0, speed};
  const double path = speed * speed / (2.0 * mu * g);
  // At rest the bristle has sprung back.
  const double back = motion.contacts[0].friction.bristle_displacement;
  const Travel t = travel(motion, 1.0, 11.0);
  std::vector<Row> rows;
  rows.push_back({"friction", "block at 0.2 m/s, way to rest", "m", "v^2/(2 mu g) less the bristle's give",
                  Kind::closed_form, path - back, t.late, Limit::relative(1e-4)});
  rows.push_back({"friction", "and then moves in 10 s by", "m", "rest", Kind::closed_form, 0.0,
                  std::abs(t.late - t.early),
                  Limit::absolute(1e-9, "zero reference; a thousandth of the displacement of the bristle")});
  const double energy = 0.5 * speed * speed;
  rows.push_back({"friction", "and has turned into heat, of its kinetic energy", "", "conservation",
                  Kind::closed_form, 1.0, t.result.energy.dissipated / energy, Limit::relative(1e-3)});
  return rows;
}

// A cylinder that rolls down a wire without sliding: x'' = g sin a/(1 + I/(m R^2)), R to the wire's
// centreline.
std::vector<Row> rolling_rows() {
  Motion motion = block_on_wire();
  constexpr double angle = 20.0 * degree;
  const double radius = cylinder_radius + 0.5 * thickness;
  const double inertia = 0.5 * radius * radius;
  motion.bodies[0].properties.inertia = Vector3d(1e9, 1e9, inertia).asDiagonal();
  motion.bodies[0].start.position.x() = 0.25 * span;
  motion.contacts[0].friction = two_coefficients(0.3, 0.3);
  motion.gravity = g * Vector3d(std::sin(angle), -std::cos(angle), 0.0);
  double early = 0.0;
  double late = 0.0;
  bool sticks = true;
  const MotionResult r = coupling::simulate(motion, accurate(0.08), [&](const MotionSample& s) {
    if (s.time <= 0.03 + 1e-12) early = s.bodies[0].velocity.x();
    if (s.time > 0.03) sticks = sticks && s.contacts[0].sticking;
    late = s.bodies[0].velocity.x();
    return false;
  });
  const double expected = g * std::sin(angle) / (1.0 + inertia / (radius * radius));
  const double found = r.report.usable() && sticks ? (late - early) / 0.05 : not_computed;
  return {{"friction", "cylinder rolls down a wire, acceleration", "m/s^2", "g sin a / (1 + I/(m R^2))",
           Kind::closed_form, expected, found, Limit::relative(1e-3)}};
}

// A mass on a belt, held by a spring K: seen from the belt, the spring's far end moves at v. In the slip the
// mass swings about mu_d N/K with the frequency w = sqrt(K/m), from D = (mu_s - mu_d) N/K beyond it at the
// speed v; it sticks again where its speed is v the next time, at -D.
std::vector<Row> stick_slip_rows() {
  Motion motion = block_on_wire();
  constexpr double stiffness = 400.0;
  constexpr double belt = 0.05;
  constexpr double fixed = 0.3;
  constexpr double sliding = 0.2;
  motion.contacts[0].friction = two_coefficients(fixed, sliding);
  motion.contacts[0].friction.bristle_displacement = 1e-8;  // 1e-5 of the swing
  coupling::PointContactLaw spring;
  spring.direction = -Vector3d::UnitZ();  // a law only presses: it pulls the mass along
  spring.origin = motion.bodies[0].start.position;
  spring.origin_speed = -belt;
  spring.law = coupling::spring_dashpot(stiffness, 0.0);
  motion.point_contacts.push_back(spring);
  const double w = std::sqrt(stiffness);
  const double jump = (fixed - sliding) * g / stiffness;
  const double period = 2.0 * jump / belt + 2.0 / w * (pi - std::atan(jump * w / belt));
  const double amplitude = std::hypot(jump, belt / w);
  MotionOptions options = accurate(3.6 * period + fixed * g / stiffness / belt);
  options.output_interval = period / 1000.0;
  options.max_step =
      period /
      2000.0;  // in the stick time alone moves, which the integrals see and the error of a step does not
  double least = 1e9;
  double most = -1e9;
  double heat = 0.0;
  double travel = 0.0;
  double area = 0.0;
  double last_place = 0.0;
  double last_force = 0.0;
  const MotionResult r = coupling::simulate(motion, options, [&](const MotionSample& s) {
    const double stretch = belt * s.time - s.bodies[0].position.z();
    if (s.time > 0.5 * options.duration) {
      least = std::min(least, stretch);
      most = std::max(most, stretch);
    }
    heat = s.energy.dissipated;
    travel = s.bodies[0].position.z();
    const double force = s.contacts[0].force.z();  // on the wire: along the motion
    area += 0.5 * (force + last_force) * (travel - last_place);
    last_place = travel;
    last_force = force;
    return false;
  });
  std::vector<double> slips;
  for (const MotionEvent& e : r.events) {
    if (e.kind == MotionEvent::Kind::slip && e.time > 0.05) slips.push_back(e.time);
  }
  const bool fine = r.report.usable() && slips.size() == 4;
  const double nothing = not_computed;
  return {{"friction", "mass on a belt, period of stick and slip", "s", "piecewise linear oscillator",
           Kind::closed_form, period, fine ? (slips[3] - slips[0]) / 3.0 : nothing, Limit::relative(1e-3)},
          {"friction", "mass on a belt, amplitude", "m", "piecewise linear oscillator", Kind::closed_form,
           amplitude, fine ? 0.5 * (most - least) : nothing, Limit::relative(1e-3)},
          {"friction", "mass on a belt, heat", "J", "mu_d N times the way slid", Kind::closed_form,
           sliding * g * travel, fine ? heat : nothing, Limit::relative(1e-3)},
          {"friction", "mass on a belt, heat", "J", "area of force over way", Kind::closed_form, area,
           fine ? heat : nothing, Limit::relative(2e-3)}};
}

namespace {

/// The pusher goes 2 mm in and comes back, slowly; the static wire does the same on the same mesh. Friction
/// of one coefficient, or strands.
std::vector<Row> reversed_push(coupling::PushProblem test, const std::string& name,
                               const std::vector<double>& stations) {
  constexpr double depth = 2.0 * mm;
  constexpr int elements = 200;
  const double radius = test.pusher.radius;
  coupling::PushOptions push;
  push.elements = elements;
  push.grading = 0.0;
  test.travel = {0.1 * mm};
  const double touch_height = coupling::solve_push(test, push).touch_height;

  wire::RodInMotion rod = wire::rod_in_motion(test.wire, test.mount.span, elements);
  rod.damping.bending_time = rod.damping.axial_time = 1e-5;
  rod.damping.mass_rate = 20.0;
  Motion motion;
  motion.wires.push_back({"wire", rod, coupling::resting_wire(rod), {}});
  coupling::MotionContact contact;
  contact.shape = std::make_shared<coupling::EndlessCylinder>(radius);
  contact.wire_radius = 0.5 * test.wire.diameter;
  contact.friction = two_coefficients(test.pusher.friction, test.pusher.friction);
  contact.friction.bristle_displacement = 1e-7;  // 5e-5 of the travel
  motion.contacts.push_back(contact);
  // The speed is a sine: zero at the start, the turn and the end.
  constexpr double half = 0.5;
  coupling::MotionBody pusher;
  pusher.driven = true;
  pusher.course_velocity = [](double t) {
    return Vector3d(0.0, 0.5 * depth * pi / half * std::sin(pi * t / half), 0.0);
  };
  pusher.course_acceleration = [](double t) {
    return Vector3d(0.0, 0.5 * depth * pi * pi / (half * half) * std::cos(pi * t / half), 0.0);
  };
  pusher.start.position = {test.contact_position, touch_height, 0.0};
  motion.bodies.push_back(pusher);
  MotionOptions options = accurate(2.0 * half);
  options.output_interval = half / 500.0;
  options.velocity_tolerance = 1e-6;
  options.position_tolerance = 1e-9;
  std::vector<double> travels;
  std::vector<double> forces;
  const MotionResult r = coupling::simulate(motion, options, [&](const MotionSample& s) {
    travels.push_back(s.bodies[0].position.y() - touch_height);
    forces.push_back(s.contacts[0].force.y());
    return false;
  });
  // The static wire turns where the integrated motion has turned (1 um short of 2 mm).
  test.travel = stations;
  test.travel.push_back(*std::max_element(travels.begin(), travels.end()));
  test.travel.insert(test.travel.end(), stations.rbegin(), stations.rend());
  const coupling::PushCurve curve = coupling::solve_push(test, push);
  std::vector<Row> rows;
  double range = 0.0;
  for (const coupling::PushPoint& p : curve.points) range = std::max(range, std::abs(p.force));
  for (std::size_t k = 0; k < curve.points.size(); ++k) {
    const double d = test.travel[k];
    const bool loading = k <= stations.size();
    double force = not_computed;
    for (std::size_t i = 1; i < travels.size(); ++i) {
      const bool passes =
          loading ? travels[i - 1] < d && travels[i] >= d : travels[i - 1] > d && travels[i] <= d;
      if (!passes) continue;
      const double share = (d - travels[i - 1]) / (travels[i] - travels[i - 1]);
      force = forces[i - 1] + share * (forces[i] - forces[i - 1]);
      break;
    }
    // At the turn the least motion back unloads what sticks: there the largest force counts.
    if (k == stations.size()) force = *std::max_element(forces.begin(), forces.end());
    if (!r.report.usable()) force = not_computed;
    rows.push_back(
        {"friction",
         fmt::format("slow push, {}, {} {:.3g} mm, over the largest force", name, loading ? "in" : "back at",
                     d / mm),
         "", "static wire", Kind::convergence, curve.points[k].force / range, force / range,
         curve.points[k].force != 0.0
             ? Limit::relative(2e-3)
             : Limit::absolute(1e-3, "zero reference; the value is a share of the largest force")});
  }
  return rows;
}

}  // namespace

std::vector<Row> reversed_push_rows() {
  coupling::PushProblem test = declared_wire(65.0 * mm, 6.0 * mm);
  test.pusher.friction = 0.2;
  return reversed_push(test, "friction on the pusher", {0.5 * mm, 1.0 * mm, 1.5 * mm, 1.9 * mm});
}

// A straight wire, so that both begin without a moment; soft in tension, so that it bends.
std::vector<Row> strand_push_rows() {
  coupling::PushProblem test = declared_wire(87.5 * mm, 6.0 * mm);
  test.wire.length = test.mount.span;
  test.wire.bending_stiffness_override = 5e-3;
  test.wire.axial_stiffness_override = 1e3;
  test.wire.strand_friction = wire::StrandFriction{2e-2, 0.2};
  return reversed_push(test, "strands", {0.1 * mm, 0.3 * mm, 1.0 * mm, 1.5 * mm, 1.9 * mm});
}

std::vector<Check> friction_checks() {
  return {{"friction on an incline", incline_rows},
          {"friction stops a block", stopping_block_rows},
          {"rolling without sliding", rolling_rows},
          {"stick and slip", stick_slip_rows},
          {"slow push with friction", reversed_push_rows},
          {"slow push of a wire with strands", strand_push_rows}};
}

}  // namespace snare::validation
