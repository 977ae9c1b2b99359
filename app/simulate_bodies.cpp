#include "app/commands.hpp"
#include "app/experiment_input.hpp"
#include "app/motion_json.hpp"
#include "app/report/motion_pictures.hpp"
#include "app/report/motion_report.hpp"
#include "app/motion_runs.hpp"
#include "app/report/paraview.hpp"
#include "app/report/report_page.hpp"
#include "app/simulate_kinds.hpp"
#include "scenario/bodies_scenario.hpp"
#include "base/csv.hpp"
#include "base/files.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iostream>

namespace snare::app {

namespace {

using coupling::ContactSample;
using coupling::MotionEvent;
using coupling::MotionResult;
using coupling::MotionSample;
using scenario::MotionScenario;
using Eigen::Vector3d;
using nlohmann::json;

void write_history(const std::filesystem::path& file, const MotionScenario& scenario, const std::vector<MotionSample>& samples) {
  std::vector<std::string> columns{"time_s"};
  for (const auto& b : scenario.motion.bodies) {
    for (const char* of : {"x_mm", "y_mm", "z_mm", "qw", "qx", "qy", "qz", "vx_m_s", "vy_m_s", "vz_m_s", "wx_rad_s", "wy_rad_s", "wz_rad_s"})
      columns.push_back(fmt::format("{} {}", b.name, of));
  }
  for (const auto& c : scenario.motion.contacts) {
    for (const char* of : {"points", "gap_mm", "arc_mm", "normal_N", "fx_N", "fy_N", "fz_N"}) columns.push_back(fmt::format("{} {}", c.name, of));
  }
  for (const char* of : {"kinetic_J", "strain_J", "potential_J", "dissipated_J", "impacts_J", "work_J", "integrator_J"}) columns.emplace_back(of);
  base::CsvWriter csv(file, columns);
  for (const MotionSample& s : samples) {
    std::vector<base::CsvCell> row{s.time};
    for (const multibody::RigidBodyState& b : s.bodies) {
      for (const double x : b.position) row.emplace_back(1e3 * x);
      for (const double x : {b.orientation.w(), b.orientation.x(), b.orientation.y(), b.orientation.z()}) row.emplace_back(x);
      for (const double x : b.velocity) row.emplace_back(x);
      for (const double x : b.spin) row.emplace_back(x);
    }
    for (const ContactSample& c : s.contacts) {
      for (const double x : {static_cast<double>(c.points.size()), 1e3 * c.gap, 1e3 * c.arc, c.normal_force}) row.emplace_back(x);
      for (const double x : c.force) row.emplace_back(x);
    }
    for (const double x : {s.energy.kinetic, s.energy.strain, s.energy.potential, s.energy.dissipated, s.energy.impacts, s.energy.work, s.energy.integrator})
      row.emplace_back(x);
    csv.row(row);
  }
  csv.commit();
}

json contact_json(const MotionScenario& scenario, const MotionResult& r, const std::vector<MotionSample>& samples, std::size_t k) {
  json first;
  json last;
  int touches = 0;
  for (const MotionEvent& e : r.events) {
    if (static_cast<std::size_t>(e.contact) != k) continue;
    if (e.kind == MotionEvent::Kind::touch) {
      if (touches++ == 0) first = e.time;
    } else if (e.kind == MotionEvent::Kind::lift_off) {
      last = e.time;
    }
  }
  std::size_t most = 0;
  for (const MotionSample& s : samples) most = std::max(most, s.contacts[k].points.size());
  const coupling::MotionContact& c = scenario.motion.contacts[k];
  return {{"contact", c.name},
          {"body", scenario.motion.bodies[static_cast<std::size_t>(c.body)].name},
          {"wire", scenario.motion.wires[static_cast<std::size_t>(c.wire)].name},
          {"peak_force_N", r.peak_force[k]},
          {"impulse_Ns", vector_json(r.impulse[k])},
          {"first_touch_s", first},
          {"last_lift_off_s", last},
          {"touches", touches},
          {"most_points", most},
          {"in_contact_at_the_end", samples.back().contacts[k].closed}};
}

json summary_of(const MotionScenario& scenario, const MotionResult& r, const std::vector<MotionSample>& samples) {
  json summary{{"schema", "snare-summary/1"},
               {"kind", "contact"},
               {"title", scenario.title},
               {"source", scenario.source},
               {"version", version()},
               {"duration_s", scenario.options.duration},
               {"bodies", json::array()},
               {"contacts", json::array()},
               {"events", json::array()}};
  for (std::size_t k = 0; k < scenario.motion.bodies.size(); ++k) {
    const multibody::RigidBodyState& before = samples.front().bodies[k];
    const multibody::RigidBodyState& after = samples.back().bodies[k];
    summary["bodies"].push_back({{"body", scenario.motion.bodies[k].name},
                                 {"position_after_mm", vector_json(1e3 * after.position)},
                                 {"velocity_before_m_s", vector_json(before.velocity)},
                                 {"velocity_after_m_s", vector_json(after.velocity)},
                                 {"spin_before_rad_s", vector_json(before.spin)},
                                 {"spin_after_rad_s", vector_json(after.spin)}});
  }
  for (std::size_t k = 0; k < scenario.motion.contacts.size(); ++k) summary["contacts"].push_back(contact_json(scenario, r, samples, k));
  for (const MotionEvent& e : r.events) {
    const bool touch = e.kind == MotionEvent::Kind::touch;
    json event{{"time_s", e.time},
               {"what", coupling::to_string(e.kind)},
               {"contact", scenario.motion.contacts[static_cast<std::size_t>(e.contact)].name},
               {"point", e.point + 1},
               {"arc_mm", 1e3 * e.arc}};
    if (touch) event["approach_m_s"] = e.approach_speed;
    summary["events"].push_back(event);
  }
  add_result(r, summary);
  return summary;
}

std::string report_of(const MotionScenario& scenario, const std::vector<MotionSample>& samples, const json& summary) {
  ReportPage page(scenario.title, scenario.source);
  page.heading("Summary");
  add_balance(summary, page);
  Table table{"",
              {{"Contact", ColumnKind::code},
               {"Peak force [N]", ColumnKind::number},
               {"First touch [s]", ColumnKind::number},
               {"Touches", ColumnKind::number},
               {"Points at a time", ColumnKind::number}},
              {}};
  for (const json& c : summary["contacts"]) {
    table.rows.push_back({c["contact"].get<std::string>(), format_significant(c["peak_force_N"].get<double>()),
                          c["first_touch_s"].is_null() ? "never" : format_significant(c["first_touch_s"].get<double>(), 6),
                          std::to_string(c["touches"].get<int>()), std::to_string(c["most_points"].get<int>())});
  }
  page.table(table);
  page.heading("Time histories");
  PlotSpecification forces{"Contact forces", {"time", "s"}, {"force", "N"}};
  for (std::size_t k = 0; k < scenario.motion.contacts.size(); ++k) {
    forces.curves.push_back(time_curve(scenario.motion.contacts[k].name, static_cast<int>(k), samples,
                                       [k](const MotionSample& s) { return s.contacts[k].normal_force; }));
  }
  page.line_plot(forces);
  PlotSpecification speeds{"Speeds of the bodies", {"time", "s"}, {"speed", "m/s"}};
  for (std::size_t k = 0; k < scenario.motion.bodies.size(); ++k) {
    speeds.curves.push_back(time_curve(scenario.motion.bodies[k].name, static_cast<int>(k), samples,
                                       [k](const MotionSample& s) { return s.bodies[k].velocity.norm(); }));
  }
  page.line_plot(speeds);
  page.heading("The motion");
  for (const View view : {View::along_z, View::along_x}) page.animation(animation_of(scenario.motion, samples, view));
  page.footer(fmt::format("Written by snare {}. The numbers are in history.csv and summary.json beside this page.", version()));
  return page.html();
}

}  // namespace

ExitStatus simulate_bodies(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  const MotionScenario scenario = scenario::read_motion_scenario(file, overrides_of(options));
  const std::vector<MotionRecord> records =
      run_motions({{scenario.title, scenario.motion, scenario.options}},
                  {options.out / "checkpoint.bin", scenario.input, scenario.output.checkpoint_wall_time}, console);
  const ExitStatus status = status_of(records);
  const std::vector<MotionSample>& samples = records.front().samples;
  const MotionResult& result = records.front().result;
  const json summary = summary_of(scenario, result, samples);
  write_history(options.out / "history.csv", scenario, samples);
  base::write_text(options.out / "summary.json", summary.dump(1) + "\n");
  base::write_text(options.out / "report.html", report_of(scenario, samples, summary));
  if (scenario.output.paraview) write_paraview(options.out, "motion", paraview_frames(scenario.motion, samples));
  if (options.json) {
    std::cout << summary.dump(1) << '\n';
    return status;
  }
  for (const json& c : summary["contacts"]) {
    console.say(fmt::format("{}: {} touches, peak {:.4g} N, up to {} points at a time", c["contact"].get<std::string>(), c["touches"].get<int>(),
                            c["peak_force_N"].get<double>(), c["most_points"].get<int>()));
  }
  console.say(fmt::format("wrote {0}/history.csv, summary.json, report.html", options.out.string()));
  return status;
}

}  // namespace snare::app
