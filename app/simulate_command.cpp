#include "app/commands.hpp"
#include "app/experiment_input.hpp"
#include "app/interruption.hpp"
#include "app/motion_runs.hpp"
#include "app/report/motion_page.hpp"
#include "app/report/motion_pictures.hpp"
#include "app/report/paraview.hpp"
#include "app/result_folder.hpp"
#include "base/files.hpp"
#include "results/motion_history.hpp"
#include "results/motion_summary.hpp"
#include "results/simulation.hpp"
#include "results/warnings.hpp"
#include "scenario/scenario.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <variant>

namespace snare::app {

using namespace results;

namespace {

using nlohmann::json;

/// One line for every model or contact.
void tell(const scenario::WireMotions& motions, const std::vector<FinishedMotion>& finished, Console& console) {
  for (const FinishedMotion& run : finished) {
    const coupling::MotionResult& r = run.result;
    if (!motions.probe) {
      const std::vector<std::string> contacts = run.asked.motion.contact_names();
      for (std::size_t k = 0; k < contacts.size(); ++k) {
        console.say(fmt::format("{}: {} touches, peak {:.4g} N, up to {} points at a time", contacts[k],
                                touches_of(r, k).count, r.peak_force[k], most_points(run, k)));
      }
      continue;
    }
    const multibody::RigidBodyState& after = run.samples.back().bodies.front();
    const std::string spin =
        run.asked.motion.arms.empty() ? fmt::format(", spin {:.4g} rad/s", after.spin.z()) : std::string();
    console.say(fmt::format(
        "{}: peak {:.4g} N, impulse {:.4g} N s, velocity {:.4g} m/s{} after; {} steps, {:.3g} times real time",
        run.asked.name, r.peak_force.front(), r.impulse.front().y(), after.velocity.y(), spin, r.statistics.steps,
        real_time_factor(r)));
  }
}

void write_results(const CommonOptions& options, const json& summary, const std::string& page) {
  base::write_text(options.out / "report.html", page);
  write_result(options, "summary.json", summary);
}

void tell_files(const CommonOptions& options, Console& console) {
  console.say(fmt::format("wrote {0}/history.csv, summary.json, report.html", options.out.string()));
}

ExitStatus simulate(const scenario::Scenario& asked, const scenario::WireMotions& motions, const CommonOptions& options,
                    Console& console) {
  const std::vector<MotionRecord> records = run_motions(
      motions.runs, {options.out / "checkpoint.bin", motions.input, motions.output.checkpoint_wall_time}, console);
  begin_writing();
  const bool partial = left_undone(motions.runs, records);
  const std::vector<FinishedMotion> finished = finished_motions(motions, records);
  const std::vector<std::string> warnings = motion_warnings(finished);
  for (const std::string& warning : warnings) console.warn(warning);
  write_history(options.out / "history.csv", motions, finished);
  if (!motions.sensors.empty()) write_telemetry(options.out / "telemetry.csv", motions, finished.front().samples);
  json summary = motion_summary(asked, motions, finished);
  summary.update({{"interrupted", partial}, {"warnings", warnings}});
  write_results(options, summary, motion_page(asked, motions, finished, version(), warnings, partial));
  if (motions.output.paraview) {
    for (const FinishedMotion& run : finished) {
      write_paraview(options.out, motions.probe ? run.asked.name : "motion",
                     MotionPictures(run.asked.motion, run.samples, motions.drawn).paraview());
    }
  }
  if (partial) console.complain("interrupted: the results are a part of what was asked for");
  if (!options.json) {
    tell(motions, finished, console);
    tell_files(options, console);
  }
  return status_of(records);
}

ExitStatus simulate(const scenario::Scenario& asked, const scenario::ArmMotion& motion, const CommonOptions& options,
                    Console& console) {
  const ArmRecord record =
      simulate_arm(motion, {[&console](const std::string& stage) { console.progress(stage); }, interrupted});
  console.end_progress();
  begin_writing();
  const multibody::ArmHistory& history = record.history;
  write_history(options.out / "history.csv", motion.scenario.arm, history);
  json summary = arm_summary(asked, motion, record);
  summary["interrupted"] = history.report.termination == numerics::Termination::interrupted;
  write_results(options, summary, arm_page(asked, motion, record, version()));
  if (summary["interrupted"].get<bool>()) console.complain("interrupted: the results are a part of what was asked for");
  if (!history.report.usable()) {
    const bool stalled = history.report.termination == numerics::Termination::stalled;
    console.complain(fmt::format("{} (what was reached is kept{})", history.report.message,
                                 stalled ? "; a smaller solver.least_advance_s gives it more" : ""));
    return ExitStatus::solver_stopped;
  }
  if (!options.json) {
    console.say(fmt::format("{} steps, {} events, energy balance within {:.2g}, {:.3g} times real time",
                            history.statistics.steps, history.events.size(), history.energy_error,
                            record.real_time_factor()));
    tell_files(options, console);
  }
  return ExitStatus::done;
}

}  // namespace

ExitStatus run_simulate(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  const scenario::Scenario asked = scenario::read_scenario(file, overrides_of(options));
  const ResultFolder folder(options, {"history.csv", "telemetry.csv", "summary.json", "report.html", "checkpoint.bin"});
  return std::visit([&](const auto& content) { return simulate(asked, content, options, console); }, asked.content);
}

}  // namespace snare::app
