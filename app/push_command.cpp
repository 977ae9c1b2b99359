#include "app/commands.hpp"
#include "app/curves_csv.hpp"
#include "app/experiment_input.hpp"
#include "app/interruption.hpp"
#include "app/push_json.hpp"
#include "app/result_folder.hpp"
#include "app/warnings.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace snare::app {

ExitStatus run_push(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  const identification::Experiment experiment = open_experiment(file, options);
  const ResultFolder folder(options, {"curves.csv"});
  const KeepWhenInterrupted keeping({}, options.json ? "snare-push/1" : "");

  std::vector<identification::PredictionOptions> prediction_options(experiment.series.size());
  for (std::size_t k = 0; k < experiment.series.size(); ++k) {
    prediction_options[k].examine_out_of_plane = true;
    prediction_options[k].stop = interrupted;
    prediction_options[k].progress = [&console, &series = experiment.series[k]](double travel) {
      console.progress(fmt::format("{}: {:.3f} of {:.3f} mm", series.name, 1e3 * travel,
                                   1e3 * identification::measured_displacement(series).back()));
      return !interrupted();
    };
  }
  const std::vector<identification::Prediction> predictions =
      identification::predict_all(experiment.series, experiment.solver, {}, prediction_options);
  console.end_progress();
  begin_writing();

  const std::filesystem::path csv = options.out / "curves.csv";
  write_curves(csv, experiment.series, predictions);
  nlohmann::json result = push_json(experiment, predictions);
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
  const std::vector<std::string> warnings = push_warnings(experiment.series, predictions);
  result["warnings"] = warnings;
  for (const std::string& warning : warnings) console.warn(warning);
  if (options.json) {
    print(result.dump(1) + "\n");
  } else {
    for (const nlohmann::json& series : result["series"]) {
      console.say(fmt::format("{}: {} points, largest force {:.4g} N", series["series"].get<std::string>(),
                              series["points"].get<std::size_t>(), series["largest_force_N"].get<double>()));
    }
    console.say(fmt::format("wrote {}", csv.string()));
  }
  return status;
}

}  // namespace snare::app
