#include "app/record_commands.hpp"

#include "app/experiment_input.hpp"
#include "app/interruption.hpp"
#include "app/report/record_report.hpp"
#include "app/result_folder.hpp"
#include "base/files.hpp"
#include "identification/motion_tracing/trace_records.hpp"
#include "identification/records/record_file.hpp"
#include "results/record_json.hpp"
#include "results/result_table.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mutex>
#include <optional>

namespace snare::app {

namespace {

using identification::RecordSet;
using identification::RecordStage;
using identification::RecordTrace;

void write_record_curves(const std::filesystem::path& file, const RecordSet& set, const RecordTrace& trace) {
  results::CsvSink csv(file);
  results::give_record_curves(csv, set, trace);
  csv.commit();
}

using Write = void (*)(const RecordSet& set, const RecordTrace& trace, const CommonOptions& options);

void write_trace(const RecordSet& set, const RecordTrace& trace, const CommonOptions& options) {
  write_record_curves(options.out / "curves.csv", set, trace);
  base::write_text(options.out / "report.html", record_report_html(set, trace));
  write_result(options, "trace.json", results::record_trace_json(set, trace));
}

void write_fit(const RecordSet& set, const RecordTrace& trace, const CommonOptions& options) {
  write_record_curves(options.out / "curves.csv", set, trace);
  write_result(options, "fit.json", results::record_fit_json(set, trace));
}

/// What of a trace is whole, for an interruption that comes while the next part is under way.
struct Part {
  std::mutex guard;
  std::optional<RecordTrace> trace;
};

std::string kept_words(const RecordTrace& trace) {
  return fmt::format("what was finished is kept and marked as a part: the base fit{}",
                     trace.selected.empty() ? "" : fmt::format(" and {} effects", trace.selected.size()));
}

RecordTrace run(const RecordSet& set, bool effects, const CommonOptions& options, const char* schema,
                Write write, Console& console) {
  identification::RecordTraceOptions tracing;
  tracing.effects = effects;
  tracing.progress = [&console](const std::string& stage) {
    console.progress(stage);
    return !interrupted();
  };
  Part part;
  tracing.reached = [&part](const RecordTrace& reached) {
    const std::scoped_lock lock(part.guard);
    part.trace = reached;
  };
  const KeepWhenInterrupted keeping(
      [&]() -> std::string {
        const std::scoped_lock lock(part.guard);
        if (!part.trace) {
          if (options.json) print(nlohmann::json{{"schema", schema}, {"interrupted", true}}.dump(1) + "\n");
          return "nothing was finished, nothing is kept";
        }
        write(set, *part.trace, options);
        return kept_words(*part.trace);
      },
      "");
  RecordTrace trace = identification::trace_records(set, tracing);
  console.end_progress();
  begin_writing();
  if (trace.report.usable()) {
    write(set, trace, options);
    for (const std::string& warning : trace.warnings) console.warn(warning);
    if (trace.interrupted) console.complain("interrupted: " + kept_words(trace));
  } else {
    console.complain(trace.report.message);
    if (options.json)
      print(nlohmann::json{
                {"schema", schema}, {"interrupted", trace.interrupted}, {"stopped", trace.report.message}}
                .dump(1) +
            "\n");
  }
  return trace;
}

void tell(const RecordStage& stage, const char* name, Console& console) {
  for (const identification::ChannelError& e : stage.errors)
    console.say(fmt::format("{}: {} within {:.4g} {} ({:.2f} % of the readings)", name, e.sensor, e.rmse,
                            e.unit, 100.0 * e.relative));
  for (const identification::ChannelError& e : stage.heldout)
    console.say(fmt::format("{}, held out: {} within {:.4g} {}", name, e.sensor, e.rmse, e.unit));
}

void tell_numbers(const RecordStage& stage, Console& console) {
  for (const identification::TracedNumber& n : stage.numbers) {
    console.say(fmt::format("  {} = {:.6g}{}{}  {}", n.key, n.value, n.unit.empty() ? "" : " ", n.unit,
                            identification::interval_words(n.lower, n.upper, n.identified, n.bound)));
  }
}

void tell_profiles(const RecordTrace& trace, Console& console) {
  for (const identification::Profile& p : trace.profiles)
    console.say(fmt::format("  {} by its profile: {} to {}{}{}", p.key,
                            p.lower.limit ? fmt::format("{:.5g}", *p.lower.limit) : "no limit",
                            p.upper.limit ? fmt::format("{:.5g}", *p.upper.limit) : "no limit",
                            p.unit.empty() ? "" : " ", p.unit));
}

ExitStatus status_of(const RecordTrace& trace) {
  return trace.report.usable() && !trace.interrupted ? ExitStatus::done : ExitStatus::solver_stopped;
}

}  // namespace

ExitStatus fit_records(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  const RecordSet set = identification::read_records(file, overrides_of(options));
  static_cast<void>(identification::RecordModel(set));  // what is wrong is told before a folder is made
  const ResultFolder folder(options, {"curves.csv", "fit.json"});
  const RecordTrace trace = run(set, false, options, "snare-fit/1", write_fit, console);
  if (trace.report.usable() && !options.json) {
    tell(trace.declared, "declared", console);
    tell(trace.base, "fitted", console);
    tell_numbers(trace.base, console);
    tell_profiles(trace, console);
    console.say(fmt::format("{0} simulations of the fit; wrote {1}/fit.json, {1}/curves.csv",
                            trace.fit_simulations, options.out.string()));
  }
  return status_of(trace);
}

ExitStatus trace_record_file(const std::filesystem::path& file, const CommonOptions& options,
                             Console& console) {
  const RecordSet set = identification::read_records(file, overrides_of(options));
  static_cast<void>(identification::RecordModel(set));
  const ResultFolder folder(options, {"curves.csv", "trace.json", "report.html"});
  const RecordTrace trace = run(set, true, options, "snare-trace/1", write_trace, console);
  if (trace.report.usable() && !options.json) {
    console.say(record_verdict(trace));
    tell(trace.declared, "declared", console);
    tell(trace.base, "base", console);
    tell(trace.final, "final", console);
    tell_numbers(trace.final, console);
    tell_profiles(trace, console);
    if (!trace.next_measurement.empty()) console.say("next: " + trace.next_measurement);
    console.say(fmt::format("wrote {0}/curves.csv, {0}/trace.json, {0}/report.html", options.out.string()));
  }
  return status_of(trace);
}

}  // namespace snare::app
