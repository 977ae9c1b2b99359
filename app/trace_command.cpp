#include "app/commands.hpp"
#include "app/curves_csv.hpp"
#include "app/experiment_input.hpp"
#include "app/report/trace_findings.hpp"
#include "app/report/trace_report.hpp"
#include "app/trace_json.hpp"
#include "base/files.hpp"
#include "identification/tracing/trace.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace snare::app {

namespace {

using identification::FittedNumber;
using identification::Trace;

std::vector<CurveColumn> columns_of(const Trace& trace) {
  std::vector<CurveColumn> columns{{"base_N", {}}, {"final_N", {}}};
  for (std::size_t k = 0; k < trace.series.size(); ++k) {
    columns[0].values.push_back(trace.base_predictions[k].force);
    columns[1].values.push_back(trace.final_predictions[k].force);
  }
  return columns;
}

/// The trace of an experiment; its curves are written. What stops it is told to the console.
Trace trace_and_write_curves(const identification::Experiment& experiment, identification::TraceOptions tracing,
                             const CommonOptions& options, Console& console) {
  tracing.progress = [&console](const std::string& stage) {
    console.progress(stage);
    return !interrupted();
  };
  Trace trace = identification::trace(experiment, tracing);
  console.end_progress();
  if (trace.report.usable())
    write_curves(options.out / "curves.csv", trace.series, trace.final_predictions, columns_of(trace));
  else
    console.complain(trace.report.message);
  return trace;
}

std::string number_line(const FittedNumber& n) {
  std::string text = fmt::format("  {} = {:.6g}{}{}", n.key, n.value, n.unit.empty() ? "" : " ", n.unit);
  if (n.lower && n.upper) text += fmt::format("  [{:.5g}, {:.5g}]", *n.lower, *n.upper);
  return text;
}

}  // namespace

ExitStatus run_trace(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  const identification::Experiment experiment = open_experiment(file, options);
  const Trace trace = trace_and_write_curves(experiment, {}, options, console);
  if (!trace.report.usable()) return ExitStatus::solver_stopped;
  const nlohmann::json result = trace_json(experiment, trace);
  write_result(options, "trace.json", result);
  base::write_text(options.out / "report.html", trace_report_html(experiment, trace, version()));
  if (!options.json) {
    console.say(verdict(trace));
    console.say(fmt::format("rmse: declared {:.4g} N, base {:.4g} N, final {:.4g} N; noise {:.3g} N ({})",
                            trace.declared.rmse, trace.base.rmse, trace.final.rmse,
                            result["noise"]["sigma_N"].get<double>(), trace.noise.source));
    for (const FittedNumber& n : trace.final.numbers) console.say(number_line(n));
    if (trace.next) console.say("next: " + trace.next->what);
    console.say(fmt::format("wrote {0}/curves.csv, {0}/trace.json, {0}/report.html", options.out.string()));
  }
  if (trace.interrupted) {
    console.complain("interrupted: what was finished is kept");
    return ExitStatus::solver_stopped;
  }
  return ExitStatus::done;
}

ExitStatus run_fit(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  const identification::Experiment experiment = open_experiment(file, options);
  identification::TraceOptions fitting;
  fitting.most_effects = 0;
  fitting.intervals = true;
  fitting.attribute = false;
  const Trace trace = trace_and_write_curves(experiment, fitting, options, console);
  if (!trace.report.usable()) return ExitStatus::solver_stopped;
  const nlohmann::json whole = trace_json(experiment, trace);
  nlohmann::json result{{"schema", "snare-fit/1"}, {"interrupted", trace.interrupted}};
  for (const char* key : {"title", "source", "version", "noise", "declared", "heldout", "left_out", "mesh_error_N"}) {
    result[key] = whole[key];
  }
  result["fit"] = whole["final"];
  result["residual"] = {{"acceptable", trace.base_tests.acceptable(trace.tolerance)},
                        {"tests", whole["residual"]["tests"]}};
  write_result(options, "fit.json", result);
  if (!options.json) {
    console.say(fmt::format("rmse: declared {:.4g} N, fitted {:.4g} N ({:.3g} times the noise, squared)",
                            trace.declared.rmse, trace.final.rmse, trace.final.chi2_dof));
    for (const FittedNumber& n : trace.final.numbers) console.say(number_line(n));
    console.say(fmt::format("wrote {0}/fit.json, {0}/curves.csv", options.out.string()));
  }
  return trace.interrupted ? ExitStatus::solver_stopped : ExitStatus::done;
}

}  // namespace snare::app
