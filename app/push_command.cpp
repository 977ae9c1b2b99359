#include "app/commands.hpp"
#include "app/experiment_input.hpp"
#include "app/interruption.hpp"
#include "app/result_folder.hpp"
#include "results/curves.hpp"
#include "results/push_result.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace snare::app {

using namespace results;

ExitStatus run_push(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  const identification::Experiment experiment = open_experiment(file, options);
  const ResultFolder folder(options, {"curves.csv"});
  const KeepWhenInterrupted keeping({}, options.json ? "snare-push/1" : "");

  const PushResult pushed =
      push(experiment, {[&console](const std::string& stage) { console.progress(stage); }, interrupted});
  const std::vector<identification::Prediction>& predictions = pushed.predictions;
  console.end_progress();
  begin_writing();

  const std::filesystem::path csv = options.out / "curves.csv";
  write_curves(csv, experiment.series, predictions);
  ExitStatus status = ExitStatus::done;
  for (std::size_t k = 0; k < predictions.size(); ++k) {
    const numerics::SolveReport& report = predictions[k].curve.curve.report;
    if (!report.usable()) {
      console.complain(fmt::format("series {}: {} ({} of {} points kept)", experiment.series[k].name, report.message,
                                   predictions[k].force.size(),
                                   identification::measured_displacement(experiment.series[k]).size()));
      status = ExitStatus::solver_stopped;
    }
  }
  for (const nlohmann::json& warning : pushed.document["warnings"]) console.warn(warning.get<std::string>());
  if (options.json) {
    print(pushed.document.dump(1) + "\n");
  } else {
    for (const nlohmann::json& series : pushed.document["series"]) {
      console.say(fmt::format("{}: {} points, largest force {:.4g} N", series["series"].get<std::string>(),
                              series["points"].get<std::size_t>(), series["largest_force_N"].get<double>()));
    }
    console.say(fmt::format("wrote {}", csv.string()));
  }
  return status;
}

}  // namespace snare::app
