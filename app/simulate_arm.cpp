#include "base/units.hpp"
#include "app/commands.hpp"
#include "app/experiment_input.hpp"
#include "app/report/report_page.hpp"
#include "app/simulate_kinds.hpp"
#include "scenario/arm_scenario_file.hpp"
#include "base/csv.hpp"
#include "base/files.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <iostream>
#include <numbers>

namespace snare::app {

namespace {

using multibody::ArmHistory;
using multibody::ArmSample;
using scenario::ArmScenarioFile;
using nlohmann::json;

using base::degree;

void write_history(const std::filesystem::path& file, const ArmScenarioFile& asked,
                   const ArmHistory& history) {
  std::vector<std::string> columns{"time_s"};
  for (const multibody::ElasticJoint& j : asked.scenario.arm.joints) {
    for (const char* what : {"motor_deg", "deflection_deg", "joint_torque_Nm", "drive_torque_Nm"})
      columns.push_back(j.name + "_" + what);
  }
  for (const char* what : {"energy_J", "work_drives_J", "work_loads_J", "lost_J", "momentum_x_Ns",
                           "momentum_y_Ns", "momentum_z_Ns"})
    columns.emplace_back(what);
  base::CsvWriter csv(file, columns);
  for (const ArmSample& s : history.samples) {
    std::vector<base::CsvCell> row{s.time};
    for (Eigen::Index j = 0; j < s.deflection.size(); ++j) {
      for (const double v :
           {s.state.motor[j] / degree, s.deflection[j] / degree, s.joint_torque[j], s.drive_torque[j]})
        row.emplace_back(v);
    }
    for (const double v :
         {s.energy, s.work.motors, s.work.loads, s.work.lost, s.momentum.force.x(), s.momentum.force.y(), s.momentum.force.z()})
      row.emplace_back(v);
    csv.row(row);
  }
  csv.commit();
}

json swings_json(const ArmScenarioFile& asked, const ArmHistory& history) {
  json result = json::array();
  if (asked.joint < 0) return result;
  for (const scenario::Swing& s : scenario::swings(history, asked.scenario.arm, asked.joint)) {
    result.push_back({{"begin_s", s.begin},
                      {"end_s", s.end},
                      {"peak_deg", s.peak / degree},
                      {"frequency_Hz", s.frequency()}});
  }
  return result;
}

std::string report_of(const ArmScenarioFile& asked, const ArmHistory& history, const json& summary) {
  ReportPage page(asked.title, asked.source);
  page.heading("Summary");
  if (!history.report.usable()) page.callout(history.report.message, Tone::bad);
  page.key_figures(
      {{"Steps", std::to_string(history.statistics.steps), fmt::format("{} events", history.events.size())},
       {"Energy balance", format_significant(history.energy_error, 2),
        "largest error over the largest energy"},
       {"Real-time factor", format_significant(summary["real_time_factor"].get<double>()), ""}});
  if (!summary["swings"].empty()) {
    Table table{"Swings of the joint, from zero to zero of its deflection",
                {{"Begin [s]", ColumnKind::number},
                 {"Peak [deg]", ColumnKind::number},
                 {"Frequency [Hz]", ColumnKind::number}},
                {}};
    for (const json& s : summary["swings"]) {
      table.rows.push_back({format_significant(s["begin_s"].get<double>(), 4),
                            format_significant(s["peak_deg"].get<double>()),
                            format_significant(s["frequency_Hz"].get<double>(), 4)});
    }
    page.table(table);
  }
  page.heading("Time histories");
  PlotSpecification deflection{"Deflection of the joints", {"time", "s"}, {"deflection", "deg"}};
  PlotSpecification torque{"Torque of the joints", {"time", "s"}, {"torque", "N m"}};
  PlotSpecification motor{"Motors", {"time", "s"}, {"angle", "deg"}};
  PlotSpecification energy{"Energy", {"time", "s"}, {"energy", "J"}};
  const auto curve = [&](const std::string& name, int colour,
                         const std::function<double(const ArmSample&)>& value) {
    Curve c{name, {}, {}, CurveStyle::line, colour};
    for (const ArmSample& s : history.samples) {
      c.x.push_back(s.time);
      c.y.push_back(value(s));
    }
    return c;
  };
  for (int j = 0; j < asked.scenario.arm.motors(); ++j) {
    const std::string& name = asked.scenario.arm.joints[static_cast<std::size_t>(j)].name;
    deflection.curves.push_back(curve(name, j, [j](const ArmSample& s) { return s.deflection[j] / degree; }));
    torque.curves.push_back(curve(name, j, [j](const ArmSample& s) { return s.joint_torque[j]; }));
    motor.curves.push_back(curve(name, j, [j](const ArmSample& s) { return s.state.motor[j] / degree; }));
  }
  energy.curves = {curve("kinetic, potential and elastic", 0, [](const ArmSample& s) { return s.energy; }),
                   curve("lost", 1, [](const ArmSample& s) { return s.work.lost; })};
  for (const PlotSpecification* plot : {&deflection, &torque, &motor, &energy}) page.line_plot(*plot);
  page.footer(fmt::format(
      "Written by snare {}. The numbers are in history.csv and summary.json beside this page.", version()));
  return page.html();
}

}  // namespace

ExitStatus simulate_arm(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  ArmScenarioFile asked = scenario::read_arm_scenario(file, overrides_of(options));
  const double end = asked.scenario.end;
  asked.scenario.progress = [&console, end](double time) {
    console.progress(fmt::format("{:.2f} of {:.2f} s", time, end));
    return !interrupted();
  };
  const auto begin = std::chrono::steady_clock::now();
  const ArmHistory history = multibody::simulate(asked.scenario);
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  console.end_progress();
  json events = json::array();
  for (const multibody::ArmEvent& e : history.events) {
    events.push_back(
        {{"time_s", e.time},
         {"joint",
          e.joint < 0 ? json() : json(asked.scenario.arm.joints[static_cast<std::size_t>(e.joint)].name)},
         {"what", e.what}});
  }
  const numerics::IdaStatistics& n = history.statistics;
  json summary{{"schema", "snare-summary/1"},
               {"kind", asked.kind},
               {"title", asked.title},
               {"source", asked.source},
               {"version", version()},
               {"finished", history.report.usable()},
               {"message", history.report.usable() ? json() : json(history.report.message)},
               {"time_s", history.samples.empty() ? 0.0 : history.samples.back().time},
               {"energy_error", history.energy_error},
               {"steps", n.steps},
               {"residuals", n.residuals},
               {"jacobians", n.jacobians},
               {"factorizations", n.factorizations},
               {"restarts", n.restarts},
               {"wall_s", wall},
               {"events", events},
               {"swings", swings_json(asked, history)}};
  summary["real_time_factor"] = wall > 0.0 ? summary["time_s"].get<double>() / wall : 0.0;
  write_history(options.out / "history.csv", asked, history);
  base::write_text(options.out / "summary.json", summary.dump(1) + "\n");
  base::write_text(options.out / "report.html", report_of(asked, history, summary));
  if (options.json) std::cout << summary.dump(1) << '\n';
  if (!history.report.usable()) {
    console.complain(history.report.message + " (what was reached is kept)");
    return ExitStatus::solver_stopped;
  }
  if (options.json) return ExitStatus::done;
  console.say(fmt::format("{} steps, {} events, energy balance within {:.2g}, {:.3g} times real time",
                          n.steps, history.events.size(), history.energy_error,
                          summary["real_time_factor"].get<double>()));
  console.say(fmt::format("wrote {0}/history.csv, summary.json, report.html", options.out.string()));
  return ExitStatus::done;
}

}  // namespace snare::app
