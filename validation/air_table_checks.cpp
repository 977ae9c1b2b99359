#include "validation/air_table_checks.hpp"

#include "base/units.hpp"
#include "scenario/contact_scenario.hpp"
#include "validation/declared_wire.hpp"

#include <fmt/format.h>

#include <cmath>

namespace snare::validation {

namespace {

using coupling::MotionResult;
using scenario::ContactScenario;

using base::mm;
constexpr double mass = 8.9;      // [kg], Table 5
constexpr double inertia = 0.16;  // [kg m^2], Table 5

constexpr PublishedLaw law_at_90 = published_laws[2];

ContactScenario meeting(double speed, double offset) {
  ContactScenario s;
  s.push = declared_wire(90.0 * mm, 6.0 * mm);
  s.damping.bending_time = s.damping.axial_time = 1e-5;
  s.body.properties.mass = mass;
  s.body.properties.inertia = inertia * Eigen::Matrix3d::Identity();
  s.body.start.position.y() = -0.1 * mm;
  s.body.start.velocity = {0.0, speed, 0.0};
  s.probe = {offset, 100.0 * mm, 0.0};
  s.friction = {0.3, 0.1, 0.01, 1.0};
  s.models = {{"wire", "wire", {}},
              {"law", "quadratic", coupling::quadratic_law(law_at_90.a, law_at_90.b, law_at_90.c)}};
  s.options.duration = 0.6;
  s.options.output_interval = 0.6;
  s.options.max_step = 0.2 * 6.75 * mm / speed;
  return s;
}

}  // namespace

// Head-on, without damping: m v^2/2 = A d^3/3 + B d^2/2 + C d, F = A d^2 + B d + C there, impulse 2 m v. Where the
// quadratic would pull (0.35 to 1.11 mm) our law is zero, which moves depth and force by 1e-3.
std::vector<Row> quadratic_law_rows() {
  std::vector<Row> rows;
  for (const double speed : {0.05, 0.1, 0.2}) {
    ContactScenario s = meeting(speed, 0.0);
    s.options.relative_tolerance = 1e-8;
    s.options.body_position_tolerance = 1e-11;
    s.options.body_velocity_tolerance = 1e-8;
    s.options.max_step = 1e-3;  // no step may leap from where the law is zero over its first 0.35 mm
    s.options.duration = 1.0;
    const MotionResult r = coupling::simulate(scenario::motion_of(s, s.models[1]), s.options);
    double low = 0.0;
    double high = 50.0 * mm;
    for (int k = 0; k < 60; ++k) {
      const double d = 0.5 * (low + high);
      (((law_at_90.a / 3.0 * d + law_at_90.b / 2.0) * d + law_at_90.c) * d < 0.5 * mass * speed * speed ? low : high) =
          d;
    }
    const double force = law_at_90.force(low);
    const std::string at = fmt::format("quadratic law head-on at {:g} m/s", speed);
    rows.push_back({"air table", at + ", peak force", "N", "energy balance of Table 4", force, r.peak_force[0],
                    ErrorKind::relative, 5e-3});
    rows.push_back({"air table", at + ", impulse", "N s", "2 m v", 2.0 * mass * speed, r.impulse[0].y(),
                    ErrorKind::relative, 1e-3});
  }
  return rows;
}

// The paper: the law misses the peak force, the impulse is almost the same. Approach speed and offset are not printed.
std::vector<Row> law_beside_wire_rows() {
  std::vector<Row> rows;
  for (const double speed : {0.05, 0.1, 0.2}) {
    for (const double offset : {0.0, 50.0 * mm, 100.0 * mm}) {
      ContactScenario s = meeting(speed, offset);
      // A slow body has little energy: of 0.05 m/s a share of 1e-3.
      s.options.body_position_tolerance = 1e-9;
      s.options.body_velocity_tolerance = 1e-7;
      const MotionResult wire = coupling::simulate(scenario::motion_of(s, s.models[0]), s.options);
      const MotionResult law = coupling::simulate(scenario::motion_of(s, s.models[1]), s.options);
      const std::string at = fmt::format("{:g} m/s, probe {:g} mm off the centre of mass", speed, offset / mm);
      rows.push_back({"air table", "impulse of law over full wire, " + at, "",
                      "Abiko et al., section 4.3: almost the same", 1.0, law.impulse[0].y() / wire.impulse[0].y(),
                      ErrorKind::absolute, 0.1});
      rows.push_back({"air table", "full wire, integrator's energy over that of the impact, " + at, "", "conservation",
                      0.0, wire.energy.integrator / (0.5 * mass * speed * speed), ErrorKind::absolute, 1e-3});
    }
  }
  return rows;
}

std::vector<Check> air_table_checks() {
  return {{"quadratic law of the air table", quadratic_law_rows}, {"air table", law_beside_wire_rows}};
}

}  // namespace snare::validation
