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

#include <functional>
#include <iostream>

namespace snare::app {

namespace {

using identification::FittedNumber;
using identification::Trace;

std::vector<CurveColumn> columns_of(const Trace& trace) {
  std::vector<CurveColumn> columns{{"measured_N", {}}, {"base_N", {}}, {"final_N", {}}};
  for (std::size_t k = 0; k < trace.series.size(); ++k) {
    columns[0].values.push_back(trace.series[k].readings->force);
    columns[1].values.push_back(trace.base_predictions[k].force);
    columns[2].values.push_back(trace.final_predictions[k].force);
  }
  return columns;
}

std::function<bool(const std::string&)> told_to(Console& console) {
  return [&console](const std::string& stage) {
    console.progress(stage);
    return !interrupted();
  };
}

std::string number_line(const FittedNumber& n) {
  std::string text = fmt::format("  {} = {:.6g}{}{}", n.key, n.value, n.unit.empty() ? "" : " ", n.unit);
  if (n.lower && n.upper) text += fmt::format("  [{:.5g}, {:.5g}]", *n.lower, *n.upper);
  return text;
}

}  // namespace

ExitStatus run_trace(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  const identification::Experiment experiment = open_experiment(file, options);
  identification::TraceOptions tracing;
  tracing.progress = told_to(console);
  const Trace trace = identification::trace(experiment, tracing);
  console.end_progress();
  if (!trace.report.usable()) {
    console.complain(trace.report.message);
    return ExitStatus::solver_stopped;
  }
  const nlohmann::json result = trace_json(experiment, trace);
  write_curves(options.out / "curves.csv", trace.series, trace.final_predictions, columns_of(trace));
  base::write_text(options.out / "trace.json", result.dump(1) + "\n");
  base::write_text(options.out / "report.html", trace_report_html(experiment, trace, version()));
  if (options.json) {
    std::cout << result.dump(1) << '\n';
  } else {
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
  fitting.draw = false;
  fitting.progress = told_to(console);
  const Trace trace = identification::trace(experiment, fitting);
  console.end_progress();
  if (!trace.report.usable()) {
    console.complain(trace.report.message);
    return ExitStatus::solver_stopped;
  }
  const nlohmann::json whole = trace_json(experiment, trace);
  nlohmann::json result{{"schema", "snare-fit/1"}, {"interrupted", trace.interrupted}};
  for (const char* key : {"title", "source", "version", "noise", "declared", "heldout", "left_out", "mesh_error_N"}) {
    result[key] = whole[key];
  }
  result["fit"] = whole["final"];
  result["residual"] = {{"acceptable", trace.base_tests.acceptable()}, {"tests", whole["residual"]["tests"]}};
  write_curves(options.out / "curves.csv", trace.series, trace.final_predictions, columns_of(trace));
  base::write_text(options.out / "fit.json", result.dump(1) + "\n");
  if (options.json) {
    std::cout << result.dump(1) << '\n';
  } else {
    console.say(fmt::format("rmse: declared {:.4g} N, fitted {:.4g} N ({:.3g} times the noise, squared)",
                            trace.declared.rmse, trace.final.rmse, trace.final.chi2_dof));
    for (const FittedNumber& n : trace.final.numbers) console.say(number_line(n));
    console.say(fmt::format("wrote {0}/fit.json, {0}/curves.csv", options.out.string()));
  }
  return trace.interrupted ? ExitStatus::solver_stopped : ExitStatus::done;
}

}  // namespace snare::app
