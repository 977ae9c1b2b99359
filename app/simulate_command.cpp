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
#include "results/simulation.hpp"
#include "scenario/scenario.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace snare::app {

using namespace results;

namespace {

using nlohmann::json;

/// One line for every contact, and what it cost.
void tell(const FinishedMotion& run, Console& console) {
  const std::vector<std::string> contacts = run.asked.motion.contact_names();
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    console.say(fmt::format("{}: {} touches, peak {:.4g} N, up to {} points at a time", contacts[k],
                            touches_of(run.result, k).count, run.result.peak_force[k], most_points(run, k)));
  }
  console.say(fmt::format("{} steps, {:.3g} times real time", run.result.statistics.steps,
                          real_time_factor(run.result)));
}

ExitStatus simulate(const scenario::Scenario& asked, const CommonOptions& options, Console& console) {
  const scenario::WireMotions& motions = asked.motions;
  const std::vector<MotionRecord> records = run_motions(
      motions.runs, {options.out / "checkpoint.bin", motions.input, motions.output.checkpoint_wall_time},
      console);
  const json summary = simulation_document(asked, records, {{}, interrupted});
  begin_writing();
  const bool partial = summary["interrupted"].get<bool>();
  const auto warnings = summary["warnings"].get<std::vector<std::string>>();
  const std::vector<FinishedMotion> finished = finished_motions(motions, records);
  const FinishedMotion& run = finished.front();
  for (const std::string& warning : warnings) console.warn(warning);
  write_history(options.out / "history.csv", run.asked.motion, run.samples);
  if (!motions.sensors.empty()) write_telemetry(options.out / "telemetry.csv", motions, run.samples);
  base::write_text(options.out / "report.html", motion_page(asked, run, version(), warnings, partial));
  write_result(options, "summary.json", summary);
  if (motions.output.paraview)
    write_paraview(options.out, "motion",
                   MotionPictures(run.asked.motion, run.samples, motions.drawn).paraview());
  if (partial) console.complain("interrupted: the results are a part of what was asked for");
  if (!options.json) {
    tell(run, console);
    console.say(fmt::format("wrote {0}/history.csv, summary.json, report.html", options.out.string()));
  }
  return status_of(records);
}

}  // namespace

ExitStatus run_simulate(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  const scenario::Scenario asked = scenario::read_scenario(file, overrides_of(options));
  const ResultFolder folder(
      options, {"history.csv", "telemetry.csv", "summary.json", "report.html", "checkpoint.bin"});
  return simulate(asked, options, console);
}

}  // namespace snare::app
