#include "validation/air_table_checks.hpp"

#include "base/toml_tree.hpp"
#include "base/units.hpp"
#include "scenario/scenario.hpp"
#include "validation/declared_wire.hpp"

#include <fmt/format.h>

#include <string>

namespace snare::validation {

namespace {

using base::mm;
using coupling::MotionResult;
constexpr double mass = 8.9;  // [kg], Table 5

constexpr PublishedLaw law_at_90 = published_laws[2];

/// The shipped scenario with its probe that far beside the centre of mass [m], at a speed [m/s], run with a
/// model of the wire.
MotionResult meeting(const std::filesystem::path& data, const std::string& model, double speed, double offset,
                     const std::vector<std::string>& settings) {
  std::vector<base::Override> overrides;
  const auto set = [&overrides](const std::string& one) { overrides.push_back(base::parse_override(one)); };
  set(fmt::format("wires[wire].model=\"{}\"", model));
  set(fmt::format("bodies[target].velocity_m_s=[0.0, {}, 0.0]", speed));
  set(fmt::format("bodies[target].position_mm=[{}, -88.0123, 0.0]", 90.0 - offset / mm));
  set(fmt::format("shapes[probe].position_mm=[{}, 100.0, 0.0]", offset / mm));
  for (const std::string& one : settings) set(one);
  const scenario::Scenario asked = scenario::read_scenario(data / "scenarios/air_table.toml", overrides);
  const scenario::NamedMotion& run = asked.motions.runs.front();
  return coupling::simulate(run.motion, run.options);
}

}  // namespace

// Head-on, without damping: m v^2/2 = A d^3/3 + B d^2/2 + C d, F = A d^2 + B d + C there, impulse 2 m v.
// Where the quadratic would pull (0.35 to 1.11 mm) our law is zero, which moves depth and force by 1e-3.
std::vector<Row> quadratic_law_rows(const std::filesystem::path& data) {
  std::vector<Row> rows;
  for (const double speed : {0.05, 0.1, 0.2}) {
    const MotionResult r =
        meeting(data, "quadratic", speed, 0.0,
                {"duration_s=1.0", "output_interval_s=1.0", "solver.relative_tolerance=1e-8",
                 "solver.body_position_tolerance_m=1e-11", "solver.body_velocity_tolerance_m_s=1e-8",
                 "solver.max_step_s=1e-3"});
    double low = 0.0;
    double high = 50.0 * mm;
    for (int k = 0; k < 60; ++k) {
      const double d = 0.5 * (low + high);
      (((law_at_90.a / 3.0 * d + law_at_90.b / 2.0) * d + law_at_90.c) * d < 0.5 * mass * speed * speed
           ? low
           : high) = d;
    }
    const double force = law_at_90.force(low);
    const std::string at = fmt::format("quadratic law head-on at {:g} m/s", speed);
    rows.push_back({"air table", at + ", peak force", "N", "energy balance of Table 4", Kind::closed_form,
                    force, r.peak_force[0], Limit::relative(5e-3)});
    rows.push_back({"air table", at + ", impulse", "N s", "2 m v", Kind::closed_form, 2.0 * mass * speed,
                    r.impulse[0].y(), Limit::relative(1e-3)});
  }
  return rows;
}

// The paper: the law misses the peak force, the impulse is almost the same. Approach speed and offset are not
// printed.
std::vector<Row> law_beside_wire_rows(const std::filesystem::path& data) {
  std::vector<Row> rows;
  for (const double speed : {0.05, 0.1, 0.2}) {
    for (const double offset : {0.0, 50.0 * mm, 100.0 * mm}) {
      // A slow body has little energy: of 0.05 m/s a share of 1e-3.
      const std::vector<std::string> settings{"duration_s=0.6", "output_interval_s=0.6",
                                              "solver.body_position_tolerance_m=1e-9",
                                              "solver.body_velocity_tolerance_m_s=1e-7",
                                              fmt::format("solver.max_step_s={}", 0.2 * 6.75 * mm / speed)};
      const MotionResult wire = meeting(data, "full", speed, offset, settings);
      const MotionResult law = meeting(data, "quadratic", speed, offset, settings);
      const std::string at =
          fmt::format("{:g} m/s, probe {:g} mm off the centre of mass", speed, offset / mm);
      rows.push_back({"air table", "impulse of law over full wire, " + at, "",
                      "Abiko et al., section 4.3: almost the same", Kind::published_measurement, 1.0,
                      law.impulse[0].y() / wire.impulse[0].y(), Limit::relative(0.1)});
      rows.push_back({"air table", "full wire, integrator's energy over that of the impact, " + at, "",
                      "conservation", Kind::closed_form, 0.0,
                      wire.energy.integrator / (0.5 * mass * speed * speed),
                      Limit::absolute(
                          1e-3, "zero reference; the value is a share of the kinetic energy of the impact")});
    }
  }
  return rows;
}

std::vector<Check> air_table_checks(const std::filesystem::path& data) {
  return {{"quadratic law of the air table", [data] { return quadratic_law_rows(data); }},
          {"air table", [data] { return law_beside_wire_rows(data); }}};
}

}  // namespace snare::validation
