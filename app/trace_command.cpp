#include "app/commands.hpp"
#include "app/experiment_input.hpp"
#include "app/interruption.hpp"
#include "app/record_commands.hpp"
#include "app/report/push_report.hpp"
#include "app/report/trace_report.hpp"
#include "app/result_folder.hpp"
#include "base/files.hpp"
#include "identification/records/record_file.hpp"
#include "identification/tracing/trace.hpp"
#include "results/curves.hpp"
#include "results/trace_findings.hpp"
#include "results/trace_json.hpp"
#include "results/warnings.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mutex>
#include <optional>

namespace snare::app {

using namespace results;

namespace {

using identification::FittedNumber;
using identification::Trace;

/// What of a trace is whole, for an interruption that comes while the next part is under way.
class Part {
 public:
  void reached(const Trace& part) {
    const std::scoped_lock lock(mutex_);
    part_ = part;
  }
  [[nodiscard]] std::optional<Trace> last() {
    const std::scoped_lock lock(mutex_);
    return part_;
  }

 private:
  std::mutex mutex_;
  std::optional<Trace> part_;
};

constexpr const char* nothing_kept = "nothing was finished, nothing is kept";

std::string kept_words(const Trace& trace) {
  return fmt::format("what was finished is kept and marked as a part: the base model{}",
                     trace.selected.empty() ? "" : fmt::format(" and {} effects", trace.selected.size()));
}

using Write = void (*)(const identification::Experiment& experiment, const Trace& trace,
                       const CommonOptions& options);

/// The trace of an experiment, written by `write`, also where it is a part that an interruption leaves. What
/// stops it is told to the console.
Trace trace_and_write(const identification::Experiment& experiment, identification::TraceOptions tracing,
                      const CommonOptions& options, const char* schema, Write write, Console& console) {
  tracing.progress = [&console](const std::string& stage) {
    console.progress(stage);
    return !interrupted();
  };
  Part part;
  tracing.reached = [&part](const Trace& reached) { part.reached(reached); };
  const KeepWhenInterrupted keeping(
      [&]() -> std::string {
        const std::optional<Trace> reached = part.last();
        if (!reached) {
          if (options.json) print(nlohmann::json{{"schema", schema}, {"interrupted", true}}.dump(1) + "\n");
          return nothing_kept;
        }
        write(experiment, *reached, options);
        return kept_words(*reached);
      },
      "");
  Trace trace = identification::trace(experiment, tracing);
  console.end_progress();
  begin_writing();
  if (trace.report.usable()) {
    write(experiment, trace, options);
  } else {
    console.complain(trace.report.message);
    if (options.json) {
      const nlohmann::json word{
          {"schema", schema}, {"interrupted", trace.interrupted}, {"stopped", trace.report.message}};
      print(word.dump(1) + "\n");
    }
  }
  return trace;
}

void write_trace(const identification::Experiment& experiment, const Trace& trace,
                 const CommonOptions& options) {
  const std::vector<std::string> warnings = trace_warnings(experiment, trace);
  write_curves(options.out / "curves.csv", trace.series, trace.final_predictions, curve_columns(trace));
  base::write_text(options.out / "report.html", trace_report_html(experiment, trace, version(), warnings));
  write_result(options, "trace.json", trace_document(experiment, trace));
}

void write_fit(const identification::Experiment& experiment, const Trace& trace,
               const CommonOptions& options) {
  write_curves(options.out / "curves.csv", trace.series, trace.final_predictions, curve_columns(trace));
  base::write_text(options.out / "report.html",
                   fit_report_html(experiment, trace, trace_warnings(experiment, trace)));
  write_result(options, "fit.json", fit_json(experiment, trace));
}

ExitStatus status_of(const identification::Experiment& experiment, const Trace& trace, Console& console) {
  for (const std::string& warning : trace_warnings(experiment, trace)) console.warn(warning);
  if (!trace.interrupted) return ExitStatus::done;
  console.complain("interrupted: " + kept_words(trace));
  return ExitStatus::solver_stopped;
}

std::string number_line(const FittedNumber& n) {
  return fmt::format("  {} = {:.6g}{}{}  {}", n.key, n.value, n.unit.empty() ? "" : " ", n.unit,
                     identification::interval_words(n.lower, n.upper, n.identified, n.bound));
}

}  // namespace

ExitStatus run_trace(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  if (identification::is_record_file(file, overrides_of(options)))
    return trace_record_file(file, options, console);
  const identification::Experiment experiment = open_experiment(file, options);
  const ResultFolder folder(options, {"curves.csv", "trace.json", "report.html"});
  const Trace trace = trace_and_write(experiment, {}, options, "snare-trace/1", write_trace, console);
  if (!trace.report.usable()) return ExitStatus::solver_stopped;
  if (!options.json) {
    console.say(verdict(trace));
    console.say(fmt::format("rmse: declared {:.4g} N, base {:.4g} N, final {:.4g} N; noise {:.3g} N ({})",
                            trace.declared.rmse, trace.base.rmse, trace.final.rmse,
                            reading_noise(trace).value_or(0.0), trace.noise.source));
    for (const FittedNumber& n : trace.final.numbers) console.say(number_line(n));
    if (trace.next) console.say("next: " + trace.next->what);
    console.say(fmt::format("wrote {0}/curves.csv, {0}/trace.json, {0}/report.html", options.out.string()));
  }
  return status_of(experiment, trace, console);
}

ExitStatus run_fit(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  if (identification::is_record_file(file, overrides_of(options))) return fit_records(file, options, console);
  const identification::Experiment experiment = open_experiment(file, options);
  const ResultFolder folder(options, {"curves.csv", "fit.json", "report.html"});
  const Trace trace =
      trace_and_write(experiment, fitting_options(), options, "snare-fit/1", write_fit, console);
  if (!trace.report.usable()) return ExitStatus::solver_stopped;
  if (!options.json) {
    console.say(fmt::format("rmse: declared {:.4g} N, fitted {:.4g} N ({:.3g} times the noise, squared)",
                            trace.declared.rmse, trace.final.rmse, trace.final.chi2_dof));
    for (const FittedNumber& n : trace.final.numbers) console.say(number_line(n));
    console.say(fmt::format("wrote {0}/fit.json, {0}/curves.csv, {0}/report.html", options.out.string()));
  }
  return status_of(experiment, trace, console);
}

}  // namespace snare::app
