#include "validation/motion_accuracy_checks.hpp"

#include "base/units.hpp"
#include "coupling/dynamics/model/start.hpp"
#include "coupling/dynamics/run/simulate.hpp"
#include "coupling/statics/push_solver.hpp"
#include "validation/declared_wire.hpp"
#include "wire/motion/rod_in_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

namespace snare::validation {

namespace {

using coupling::Motion;
using coupling::MotionOptions;
using coupling::MotionResult;
using coupling::MotionSample;
using Eigen::Vector3d;
using std::numbers::pi;

using base::mm;
constexpr double span = 175.0 * mm;
constexpr double radius = 6.0 * mm;
constexpr double body_mass = 8.9;  // [kg]
constexpr double speed = 0.1;      // [m/s]
constexpr double energy = 0.5 * body_mass * speed * speed;

/// A body of 8.9 kg meets the declared wire with a probe 50 mm beside and 100 mm before its centre of mass.
Motion impact(double damping, const coupling::MotionFriction& friction) {
  const wire::WireSpecification w = declared_specification();
  constexpr int elements = 60;
  wire::RodInMotion rod = wire::rod_in_motion(w, span, elements);
  rod.damping.bending_time = rod.damping.axial_time = damping;
  Motion motion;
  motion.wires.push_back({"wire", rod, coupling::resting_wire(rod), {}});
  coupling::MotionBody body;
  body.properties.mass = body_mass;
  body.properties.inertia = 0.16 * Eigen::Matrix3d::Identity();
  const double top = motion.wires[0].positions(1, elements / 2);
  body.start.position = {37.5 * mm, top - radius - 0.5 * w.diameter - 100.1 * mm, 0.0};
  body.start.velocity = {0.0, speed, 0.0};
  motion.bodies.push_back(body);
  coupling::MotionContact contact;
  contact.shape = std::make_shared<coupling::EndlessCylinder>(radius);
  contact.X_BS.p = {50.0 * mm, 100.0 * mm, 0.0};
  contact.wire_radius = 0.5 * w.diameter;
  contact.friction = friction;
  motion.contacts.push_back(contact);
  return motion;
}

MotionOptions scaled(double factor) {
  MotionOptions options;
  for (double* tolerance :
       {&options.relative_tolerance, &options.position_tolerance, &options.velocity_tolerance,
        &options.twist_tolerance, &options.body_position_tolerance, &options.body_velocity_tolerance,
        &options.angle_tolerance, &options.spin_tolerance}) {
    *tolerance *= factor;
  }
  return options;
}

double value_of(const MotionResult& result, double value) {
  return result.report.usable() ? value : not_computed;
}

constexpr const char* conserved = "conservation";

/// At tolerances that resolve the waves.
Row resolved_impact_row(const std::string& what, double damping) {
  MotionOptions options;
  options.duration = 0.03;  // beyond the last lift-off
  options.relative_tolerance = 1e-8;
  options.velocity_tolerance = 1e-6;
  options.body_position_tolerance = 1e-10;
  options.body_velocity_tolerance = 1e-7;
  options.max_order = 5;
  const MotionResult r = coupling::simulate(impact(damping, {}), options);
  return {"balances",
          fmt::format("impact, {}, tolerances that resolve the waves, integrator's energy over the impact's",
                      what),
          "",
          conserved,
          Kind::closed_form,
          0.0,
          value_of(r, r.energy.integrator / energy),
          Limit::absolute(1e-6, "zero reference; the value is a share of the energy of the impact")};
}

}  // namespace

std::vector<Row> undamped_impact_rows() {
  return {resolved_impact_row("undamped", 0.0)};
}

std::vector<Row> balance_rows() {
  std::vector<Row> rows;
  {
    MotionOptions options;
    options.duration = 0.04;
    const MotionResult r = coupling::simulate(impact(0.0, {}), options);
    rows.push_back(
        {"balances", "undamped impact, default tolerances, integrator's energy over the impact's", "",
         conserved, Kind::closed_form, 0.0, value_of(r, r.energy.integrator / energy),
         Limit::absolute(1e-3, "zero reference; the value is a share of the energy of the impact")});
  }
  // A Kelvin-Voigt time that quiets nothing but the axial modes of a few elements; without it see
  // undamped_impact_rows.
  rows.push_back(resolved_impact_row("damped by 1e-7 s", 1e-7));
  MotionOptions options;
  options.duration = 0.3;
  const MotionResult r = coupling::simulate(impact(1e-5, {0.3, 0.1, 0.01, 1.0}), options);
  const double impulse = r.impulse[0].norm();
  rows.push_back({"balances",
                  "momentum less the impulse of mounts, damped impact with friction, over the impulse", "",
                  "Newton", Kind::closed_form, 0.0, value_of(r, r.momentum_error.norm() / impulse),
                  Limit::absolute(1e-6, "zero reference; the value is a share of the impulse")});
  rows.push_back(
      {"balances", "angular momentum less that of mounts with couples, over impulse times span", "", "Euler",
       Kind::closed_form, 0.0, value_of(r, r.angular_momentum_error.norm() / (impulse * span)),
       Limit::absolute(1e-6, "zero reference; the value is a share of the impulse times the span")});
  rows.push_back({"balances", "energy left when damping and friction are taken off, over the impact's", "",
                  conserved, Kind::closed_form, 0.0, value_of(r, r.energy.integrator / energy),
                  Limit::absolute(1e-3, "zero reference; the value is a share of the energy of the impact")});
  rows.push_back({"balances", "penetration", "m", "foundation", Kind::closed_form, 0.0,
                  value_of(r, r.largest_penetration),
                  Limit::absolute(1e-6, "zero reference; the wire is 1.5 mm thick")});
  rows.push_back(
      {"balances", "drift of quaternion and mounts", "", "constraint", Kind::closed_form, 0.0,
       value_of(r, r.largest_drift),
       Limit::absolute(
           1e-9, "zero reference; a constraint of a wire that is 0.18 m long and of a unit quaternion")});
  // The axial wave crosses an element in h/c.
  const wire::WireSpecification w = declared_specification();
  const double crossing = w.length / 60 / std::sqrt(w.axial_stiffness() / w.mass_per_length());
  rows.push_back({"balances", "time in which the axial wave crosses an element, over the mean step", "",
                  "no step is limited by the wave", Kind::convergence, 0.0,
                  value_of(r, crossing * static_cast<double>(r.statistics.steps) / options.duration),
                  Limit::absolute(0.05, "an upper bound of a ratio of two times")});
  return rows;
}

// Against a run at a hundredth of the default tolerances; a damped wire, whose waves all runs resolve alike.
std::vector<Row> tolerance_rows() {
  const Motion motion = impact(1e-5, {});
  const auto run = [&motion](double factor) {
    MotionOptions options = scaled(factor);
    options.duration = 0.04;
    return coupling::simulate(motion, options);
  };
  const MotionResult finest = run(0.003);
  std::vector<Row> rows;
  constexpr std::array<double, 3> factors{10.0, 1.0, 0.03};
  std::array<double, 3> impulse_error{};
  for (std::size_t k = 0; k < factors.size(); ++k) {
    const MotionResult r = run(factors[k]);
    impulse_error[k] = value_of(r, (r.impulse[0] - finest.impulse[0]).norm() / finest.impulse[0].norm());
    const std::string at =
        fmt::format("{:g} times the default tolerances, {} steps", factors[k], r.statistics.steps);
    const double limit = std::array{1e-3, 1e-4, 1e-5}[k];
    // Vibrations of the wire, which coarse steps damp, have some 5e-4 of the force.
    const double force_limit = std::array{3e-3, 1e-3, 5e-4}[k];
    rows.push_back({"tolerances", "impulse, " + at, "N s", "at a 300th of the default tolerances",
                    Kind::convergence, finest.impulse[0].norm(), r.impulse[0].norm(),
                    Limit::relative(limit)});
    rows.push_back({"tolerances", "peak force, " + at, "N", "at a 300th of the default tolerances",
                    Kind::convergence, finest.peak_force[0], r.peak_force[0], Limit::relative(force_limit)});
  }
  rows.push_back({"tolerances", "exponent of the tolerance in the error of the impulse", "",
                  "order 2: error ~ step^2, step ~ tolerance^(1/3)", Kind::convergence, 2.0 / 3.0,
                  std::log(impulse_error[0] / impulse_error[2]) / std::log(factors[0] / factors[2]),
                  Limit::relative(0.6)});
  return rows;
}

namespace {

/// A driven cylinder at a place along the chord and the static push that it follows.
struct SlowPush {
  Motion motion;
  coupling::PushProblem test;
  coupling::PushOptions options;
};

SlowPush slow_push(double position, int elements, double friction, coupling::PushDirection direction) {
  SlowPush p;
  const wire::WireSpecification w = declared_specification();
  p.test = declared_wire(position, radius);
  p.test.pusher.friction = friction;
  p.test.pusher.direction = direction;
  p.options.elements = elements;
  p.options.grading = 0.0;
  wire::RodInMotion rod = wire::rod_in_motion(w, span, elements);
  rod.damping.bending_time = rod.damping.axial_time = 1e-5;
  rod.damping.mass_rate = 200.0;
  p.motion.wires.push_back({"wire", rod, coupling::resting_wire(rod), {}});
  coupling::MotionBody pusher;
  pusher.driven = true;
  p.motion.bodies.push_back(pusher);
  coupling::MotionContact contact;
  contact.shape = std::make_shared<coupling::EndlessCylinder>(radius);
  contact.wire_radius = 0.5 * w.diameter;
  // So slow that the wire slides faster than the law creeps.
  contact.friction = {friction, friction, 1e-5, 1.0};
  p.motion.contacts.push_back(contact);
  return p;
}

/// Static force at the travels, in their order.
std::vector<double> static_forces(SlowPush& p, const std::vector<double>& travel) {
  p.test.travel = travel;
  const coupling::PushCurve curve = coupling::solve_push(p.test, p.options);
  std::vector<double> forces(travel.size(), not_computed);
  for (std::size_t k = 0; k < std::min(forces.size(), curve.points.size()); ++k)
    forces[k] = curve.points[k].force;
  return forces;
}

/// Height of the pusher's centre at first touch in the static push.
double touch_height(SlowPush& p) {
  p.test.travel = {0.01 * mm};
  return coupling::solve_push(p.test, p.options).touch_height;
}

}  // namespace

std::vector<Row> friction_reversal_rows() {
  constexpr double position = 65.0 * mm;
  constexpr double pace = 5.0 * mm;  // [m/s]
  constexpr double load = 0.4;       // [s]
  constexpr double turn = 0.04;
  SlowPush p = slow_push(position, 200, 0.2, coupling::PushDirection::outward);
  const double touch = touch_height(p);
  // Up, a smooth turn, down.
  coupling::MotionBody& pusher = p.motion.bodies[0];
  pusher.start.position = {position, touch - 1e-6, 0.0};
  pusher.course_velocity = [](double t) {
    const double x = std::clamp((t - load) / turn, 0.0, 1.0);
    return Vector3d(0.0, pace * std::cos(pi * x), 0.0);
  };
  pusher.course_acceleration = [](double t) {
    const double x = (t - load) / turn;
    return Vector3d(0.0, x > 0.0 && x < 1.0 ? -pace * pi / turn * std::sin(pi * x) : 0.0, 0.0);
  };
  MotionOptions options;
  options.duration = 2.0 * load + turn - 0.1;
  options.output_interval = 0.01;
  // The force at an instant to 1e-3, with the wire's stiffness of 20 to 80 N/mm.
  options.position_tolerance = 1e-7;
  options.velocity_tolerance = 1e-3;
  std::vector<double> travel;
  std::vector<double> force;
  const MotionResult r = coupling::simulate(p.motion, options, [&](const MotionSample& s) {
    if (s.contacts[0].closed && s.time > 0.05) {
      travel.push_back(s.bodies[0].position.y() - touch);
      force.push_back(s.contacts[0].force.y());
    }
    return false;
  });
  const std::vector<double> reference = static_forces(p, travel);
  std::vector<Row> rows;
  const auto deepest =
      static_cast<std::size_t>(std::max_element(travel.begin(), travel.end()) - travel.begin());
  const auto row = [&](const std::string& name, std::size_t k) {
    rows.push_back({"quasi-static limit", fmt::format("friction 0.2, {} at {:.3f} mm", name, travel[k] / mm),
                    "N", "static curve, loaded and unloaded", Kind::convergence, reference[k],
                    value_of(r, force[k]), Limit::relative(1e-3)});
  };
  if (travel.size() < 20 || deepest + 10 >= travel.size())
    return {{"quasi-static limit", "friction reversal", "N", "", Kind::convergence, 1.0, not_computed,
             Limit::relative(1e-3)}};
  row("loading", deepest / 2);
  row("loading", deepest - 4);
  row("unloading", deepest + (travel.size() - deepest) / 2);
  row("unloading", travel.size() - 1);
  return rows;
}

std::vector<Row> snap_through_rows() {
  constexpr double position = 80.0 * mm;
  constexpr double pace = 20.0 * mm;  // [m/s]
  // a body meets the wire between vertices, the static push at one: 1e-3 apart with 100
  constexpr int elements = 200;
  SlowPush p = slow_push(position, elements, 0.0, coupling::PushDirection::inward);
  const double touch = touch_height(p);
  coupling::MotionBody& pusher = p.motion.bodies[0];
  pusher.start.position = {position, touch + 1e-6, 0.0};
  pusher.start.velocity = {0.0, -pace, 0.0};
  // The wire that has snapped is the one pushed outward, upside down.
  SlowPush after = slow_push(position, elements, 0.0, coupling::PushDirection::outward);
  const double far_touch = -touch_height(after);
  constexpr double beyond = 1.5 * mm;
  MotionOptions options;
  options.duration = (touch - far_touch + beyond) / pace;
  options.output_interval = 0.25 * mm / pace;
  struct Point {
    double y, force;
    bool closed;
  };
  std::vector<Point> points;
  const MotionResult r = coupling::simulate(p.motion, options, [&](const MotionSample& s) {
    points.push_back({s.bodies[0].position.y(), -s.contacts[0].force.y(), s.contacts[0].closed});
    return false;
  });
  std::vector<Row> rows;
  const auto row = [&](const std::string& name, double reference, double value) {
    rows.push_back({"quasi-static limit", name, "N", "static curve", Kind::convergence, reference,
                    value_of(r, value), Limit::relative(1e-3)});
  };
  std::vector<double> travel;
  std::vector<double> force;
  bool snapped = false;
  for (const Point& point : points) {
    snapped = snapped || (!travel.empty() && !point.closed);
    if (point.closed && !snapped && touch - point.y > 0.1 * mm) {
      travel.push_back(touch - point.y);
      force.push_back(point.force);
    }
  }
  const std::vector<double> reference = static_forces(p, travel);
  for (const double share : {0.25, 0.5, 0.75}) {
    if (travel.empty()) break;
    const auto k = static_cast<std::size_t>(share * static_cast<double>(travel.size() - 1));
    row(fmt::format("inward, before the snap, at {:.2f} mm", travel[k] / mm), reference[k], force[k]);
  }
  const double depth = points.empty() ? not_computed : far_touch - points.back().y;
  const std::vector<double> outward = static_forces(after, {0.5 * depth, depth});
  row(fmt::format("after the snap, at {:.2f} mm on the other side", depth / mm), outward.back(),
      points.empty() ? not_computed : points.back().force);
  return rows;
}

// Of length L, folded tightly: v^2 = g x (2 L - x)/(L - x) after a fall x of the free end when nothing is
// lost.
std::vector<Row> folded_chain_rows() {
  constexpr double g = 9.81;
  constexpr double length = 0.5;
  constexpr double fold = 2.5 * mm;  // radius
  constexpr int elements = 200;
  wire::WireSpecification w = declared_specification();
  w.bending_stiffness_override = 1e-8;
  wire::RodInMotion rod = wire::rod_in_motion(w, 0.0, elements);
  rod.length = length;
  rod.properties.left.kind = wire::SpatialEnd::Kind::pin;
  rod.properties.right.kind = wire::SpatialEnd::Kind::free;
  rod.properties.right.position = Vector3d::Zero();
  rod.damping.axial_time = 1e-5;
  Motion motion;
  motion.gravity = {0.0, -g, 0.0};
  Eigen::Matrix3Xd x(3, elements + 1);
  const double leg = 0.5 * (length - pi * fold);
  for (int i = 0; i <= elements; ++i) {
    const double s = length * i / elements;
    if (s <= leg) {
      x.col(i) = Vector3d(0.0, -s, 0.0);
    } else if (s >= length - leg) {
      x.col(i) = Vector3d(2.0 * fold, s - length, 0.0);
    } else {
      const double a = (s - leg) / fold;
      x.col(i) = Vector3d(fold - fold * std::cos(a), -leg - fold * std::sin(a), 0.0);
    }
  }
  motion.wires.push_back({"chain", rod, x, {}});
  constexpr double share = 0.9;
  // With x = L z^2: t = 2 sqrt(L/g) times the integral of sqrt((1 - z^2)/(2 - z^2)) dz, by the midpoint rule.
  double time = 0.0;
  constexpr int intervals = 20000;
  const double end = std::sqrt(share);
  for (int k = 0; k < intervals; ++k) {
    const double square = std::pow(end * (k + 0.5) / intervals, 2);
    time += 2.0 * std::sqrt(length / g) * end / intervals * std::sqrt((1.0 - square) / (2.0 - square));
  }
  MotionOptions options;
  options.duration = 1.1 * time;
  options.output_interval = time / 1000.0;
  double passed = not_computed;
  double last = 0.0;
  double last_time = 0.0;
  const MotionResult r = coupling::simulate(motion, options, [&](const MotionSample& s) {
    const double fallen = -s.wires[0](1, elements);
    // The first time: behind its whip the end rises and comes down again.
    if (std::isnan(passed) && last < share * length && fallen >= share * length)
      passed = last_time + (s.time - last_time) * (share * length - last) / (fallen - last);
    last = fallen;
    last_time = s.time;
    return false;
  });
  return {{"gravity", "folded chain, time for nine tenths of the fall", "s",
           "Calkin and March 1989, energy conserved", Kind::closed_form, time, value_of(r, passed),
           Limit::relative(5e-3)}};
}

std::vector<Check> motion_accuracy_checks() {
  return {{"balances of a motion", balance_rows},     {"undamped impact", undamped_impact_rows},
          {"tolerances of a motion", tolerance_rows}, {"slow push with friction", friction_reversal_rows},
          {"slow snap-through", snap_through_rows},   {"folded chain", folded_chain_rows}};
}

}  // namespace snare::validation
