#include "app/commands.hpp"
#include "app/experiment_input.hpp"
#include "app/interruption.hpp"
#include "app/report/push_report.hpp"
#include "app/result_folder.hpp"
#include "base/files.hpp"
#include "results/curves.hpp"
#include "results/push_result.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace snare::app {

using namespace results;

ExitStatus run_push(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  const identification::Experiment experiment = open_experiment(file, options);
  const ResultFolder folder(options, {"curves.csv", "report.html"});

  const PushResult pushed =
      push(experiment, {[&console](const std::string& stage) { console.progress(stage); }, interrupted});
  const std::vector<identification::Prediction>& predictions = pushed.predictions;
  console.end_progress();
  begin_writing();

  const std::filesystem::path csv = options.out / "curves.csv";
  write_curves(csv, experiment.series, predictions);
  const auto warnings = pushed.document["warnings"].get<std::vector<std::string>>();
  base::write_text(options.out / "report.html", push_report_html(experiment, predictions, warnings,
                                                                 pushed.document["interrupted"].get<bool>()));
  ExitStatus status = ExitStatus::done;
  for (std::size_t k = 0; k < predictions.size(); ++k) {
    const numerics::SolveReport& report = predictions[k].curve.curve.report;
    if (!report.usable()) {
      console.complain(fmt::format("series {}: {} ({} of {} points kept)", experiment.series[k].name,
                                   report.message, predictions[k].force.size(),
                                   identification::measured_displacement(experiment.series[k]).size()));
      status = ExitStatus::solver_stopped;
    }
  }
  for (const std::string& warning : warnings) console.warn(warning);
  if (options.json) {
    print_result(pushed.document);
  } else {
    for (const nlohmann::json& series : pushed.document["series"]) {
      const nlohmann::json& misfit = series["misfit"];
      console.say(fmt::format("{}: {} points, largest force {:.4g} N{}", series["series"].get<std::string>(),
                              series["points"].get<std::size_t>(), series["largest_force_N"].get<double>(),
                              misfit.is_null() ? ""
                                               : fmt::format(", rms distance from the readings {:.3g} N",
                                                             misfit["rmse_N"].get<double>())));
    }
    console.say(fmt::format("wrote {0}/curves.csv, {0}/report.html", options.out.string()));
  }
  return status;
}

}  // namespace snare::app
