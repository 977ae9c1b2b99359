#include "coupling/dynamics/run/pressed_start.hpp"

#include "base/errors.hpp"
#include "coupling/contact/revolved_solids.hpp"
#include "coupling/dynamics/model/start.hpp"
#include "coupling/dynamics/run/simulate.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace snare::coupling {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

namespace {

/// Largest distance of a wire's vertices from the axis of a wall [m].
double reach_of(const Matrix3Xd& wire, const RoundWall& wall) {
  return (wire.colwise() - wall.centre).topRows<2>().colwise().norm().maxCoeff();
}

/// Vertices on a circle through both ends, their edges as long as the wire's: half the angle of n edges of
/// length L/n whose ends are a span apart,  sin(a)/(n sin(a/n)) = span/L.
Matrix3Xd arc_between(double span, double length, int n) {
  double low = 0.0, high = std::numbers::pi;
  for (int k = 0; k < 100; ++k) {
    const double a = 0.5 * (low + high);
    (std::sin(a) / (n * std::sin(a / n)) > span / length ? low : high) = a;
  }
  const double a = 0.5 * (low + high);
  const double radius = length / (2.0 * n * std::sin(a / n));
  Matrix3Xd x(3, n + 1);
  for (int i = 0; i <= n; ++i) {
    const double turn = a * (2.0 * i / n - 1.0);
    x.col(i) << 0.5 * span + radius * std::sin(turn), radius * (std::cos(turn) - std::cos(a)), 0.0;
  }
  return x;
}

}  // namespace

// Without inertia a wire comes to rest within a few times of its damping in bending, whatever its stiffness.
Matrix3Xd pressed_wire(const wire::RodInMotion& rod, double wire_radius, const RoundWall& wall) {
  Matrix3Xd free = resting_wire(rod);
  if (reach_of(free, wall) + wire_radius <= wall.inner_radius) return free;
  const double span = (rod.properties.right.position - rod.properties.left.position).norm();
  const Matrix3Xd arc = arc_between(span, rod.length, rod.elements);
  if (reach_of(arc, wall) + wire_radius > wall.inner_radius) {
    throw base::InputError(
        {"", 0, "wall.radius_mm", fmt::format("{:.6g}", 1e3 * wall.inner_radius),
         fmt::format("must leave room for the arc of the open wire, which reaches to {:.6g} mm",
                     1e3 * (reach_of(arc, wall) + wire_radius))});
  }
  constexpr double damping = 1e-3, duration = 60.0 * damping;  // [s]
  constexpr double still = 1e-8;                               // [m], over the second half of it
  Motion motion;
  MotionWire wire;
  wire.rod = rod;
  wire.rod.quasi_static = true;
  wire.rod.strands = {};
  wire.rod.damping = {damping, 0.1 * damping, 0.0};
  wire.positions = arc;
  wire.positions.col(0) = rod.properties.left.position;
  wire.positions.rightCols<1>() = rod.properties.right.position;
  motion.wires.push_back(wire);
  MotionBody housing;
  housing.name = "wall";
  housing.driven = true;
  housing.start.position = wall.centre;
  motion.bodies.push_back(housing);
  MotionContact contact;
  contact.name = "wall on wire";
  contact.shape = hollow_cylinder(wall.inner_radius, wall.outer_radius, wall.length, 0.0);
  contact.wire_radius = wire_radius;
  contact.foundation = wall.foundation;
  motion.contacts.push_back(contact);
  MotionOptions options;
  options.duration = duration;
  options.output_interval = 0.5 * duration;
  options.position_tolerance = 1e-9;
  options.quasi_static_velocity_tolerance = 1e-5 / 3.0;
  Matrix3Xd before, now = arc;
  const MotionResult result = simulate(motion, options, [&](const MotionSample& s) {
    before = now;
    now = s.wires.front();
    return false;
  });
  if (!result.report.usable() || !((now - before).colwise().norm().maxCoeff() <= still)) {
    throw base::InputError(
        {"", 0, "wall.radius_mm", fmt::format("{:.6g}", 1e3 * wall.inner_radius),
         "must let the open wire come to rest against it: " +
             (result.report.usable() ? std::string("it still moves") : result.report.message)});
  }
  return now;
}

}  // namespace snare::coupling
