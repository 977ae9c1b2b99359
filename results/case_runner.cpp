#include "results/case_runner.hpp"

#include "base/archive.hpp"
#include "base/errors.hpp"
#include "base/files.hpp"
#include "identification/effects/catalogue.hpp"
#include "identification/motion_tracing/trace_records.hpp"
#include "identification/records/record_file.hpp"
#include "identification/tracing/trace.hpp"
#include "reduction/distil.hpp"
#include "results/curves.hpp"
#include "results/law_json.hpp"
#include "results/motion_history.hpp"
#include "results/push_result.hpp"
#include "results/record_json.hpp"
#include "results/simulation.hpp"
#include "results/trace_json.hpp"
#include "scenario/scenario.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <new>
#include <set>
#include <stdexcept>
#include <utility>

namespace snare::results {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Overrides = std::vector<base::Override>;
using Status = CaseEnd::Status;

/// How a solver ended.
CaseEnd ending(bool usable, numerics::Termination termination, const std::string& message) {
  if (usable) return {};
  return {termination == numerics::Termination::interrupted ? Status::stopped : Status::failed, message};
}

/// Whether a run that ended so has come somewhere by itself: what a signal or a limit of time has cut off
/// depends on the machine.
bool keeps_history(const CaseEnd& end) {
  return end.status == Status::done || end.status == Status::failed;
}

CaseEnd simulate(const scenario::Scenario& asked, const Watch& watch, json& result, TableSink* history) {
  const std::vector<MotionRecord> records = simulate_all(asked.motions.runs, watch);
  CaseEnd end;
  for (const MotionRecord& record : records) {
    const numerics::SolveReport& report = record.result.report;
    if (end.status == Status::done) end = ending(report.usable(), report.termination, report.message);
  }
  if (history != nullptr && keeps_history(end))
    give_history(*history, asked.motions.runs.front().motion, records.front().samples);
  if (end.status == Status::done) result = simulation_document(asked, records, watch);
  return end;
}

CaseEnd push(const identification::Experiment& experiment, const Watch& watch, json& result,
             TableSink* history) {
  PushResult pushed = results::push(experiment, watch);
  CaseEnd end;
  for (std::size_t k = 0; k < pushed.predictions.size() && end.status == Status::done; ++k) {
    const numerics::SolveReport& report = pushed.predictions[k].curve.curve.report;
    end = ending(report.usable(), report.termination,
                 fmt::format("series {}: {}", experiment.series[k].name, report.message));
  }
  if (history != nullptr && keeps_history(end)) give_curves(*history, experiment.series, pushed.predictions);
  if (end.status == Status::done) result = std::move(pushed.document);
  return end;
}

/// Who watches a tracing: sees its stages, and stops it at the next one.
std::function<bool(const std::string&)> stages(const Watch& watch) {
  return [&watch](const std::string& stage) {
    watch.say(stage);
    return !watch.stopped();
  };
}

/// How a tracing ended. What failed because it was stopped was stopped.
template <class Trace>
CaseEnd ending(const Trace& traced, const Watch& watch) {
  if (traced.interrupted || (!traced.report.usable() && watch.stopped()))
    return {Status::stopped, "interrupted"};
  return ending(traced.report.usable(), traced.report.termination, traced.report.message);
}

CaseEnd trace(const identification::Experiment& experiment, bool whole, const Watch& watch, json& result,
              TableSink* history) {
  identification::TraceOptions options = whole ? identification::TraceOptions{} : fitting_options();
  options.progress = stages(watch);
  options.stop = watch.stop;
  const identification::Trace traced = identification::trace(experiment, options);
  const CaseEnd end = ending(traced, watch);
  if (end.status != Status::done) return end;
  if (history != nullptr)
    give_curves(*history, traced.series, traced.final_predictions, curve_columns(traced));
  result = whole ? trace_document(experiment, traced) : fit_json(experiment, traced);
  return end;
}

CaseEnd trace_records(const identification::RecordSet& set, bool whole, const Watch& watch, json& result,
                      TableSink* history) {
  identification::RecordTraceOptions options;
  options.effects = whole;
  options.progress = stages(watch);
  options.stop = watch.stop;
  const identification::RecordTrace traced = identification::trace_records(set, options);
  const CaseEnd end = ending(traced, watch);
  if (end.status != Status::done) return end;
  if (history != nullptr) give_record_curves(*history, set, traced);
  result = whole ? record_trace_json(set, traced) : record_fit_json(set, traced);
  return end;
}

CaseEnd distil(const reduction::WireFile& wire, const Watch& watch, json& result) {
  const reduction::Distillation distilled =
      reduction::distil(wire, {}, [&](std::size_t finished, std::size_t wanted) {
        watch.say(fmt::format("curve {} of {}", finished, wanted));
        return !watch.stopped();
      });
  const numerics::SolveReport& report = distilled.report;
  if (!report.usable()) return ending(false, report.termination, report.message);
  result = law_json(wire, distilled);
  return {};
}

/// One line of a message of several.
std::string one_line(std::string text) {
  std::ranges::replace(text, '\n', ';');
  return text;
}

std::string schema_of(const fs::path& file) {
  const base::TomlNode root = base::parse_toml(file.string(), base::read_text(file, std::size_t{1} << 20u));
  const base::TomlNode* schema = root.find("schema");
  return schema != nullptr && schema->kind == base::TomlNode::Kind::text ? schema->text : std::string();
}

/// The verbs that read files of a schema, the usual one first.
std::vector<std::string> verbs_of(const std::string& schema) {
  if (schema.starts_with("snare-scenario/")) return {"simulate"};
  if (schema.starts_with("snare-experiment/")) return {"push", "fit", "trace"};
  if (schema.starts_with("snare-wire/")) return {"distil"};
  if (schema.starts_with("snare-record/")) return {"fit", "trace"};
  return {};
}

void add_contents(const fs::path& file, std::set<fs::path>& seen, std::string& all);

/// Files that a tree names by its texts, beside `folder`.
void add_named(const base::TomlNode& node, const fs::path& folder, std::set<fs::path>& seen,
               std::string& all) {
  for (const base::TomlEntry& entry : node.entries) add_named(entry.node, folder, seen, all);
  for (const base::TomlNode& item : node.items) add_named(item, folder, seen, all);
  constexpr std::size_t longest = 4096;  // of a path
  if (node.kind != base::TomlNode::Kind::text || node.text.empty() || node.text.size() > longest) return;
  if (node.text.find_first_of(std::string("\0\n", 2)) != std::string::npos) return;
  std::error_code code;
  const fs::path named = fs::path(node.text).is_absolute() ? fs::path(node.text) : folder / node.text;
  if (fs::is_regular_file(named, code)) add_contents(named, seen, all);
}

void add_contents(const fs::path& file, std::set<fs::path>& seen, std::string& all) {
  std::error_code code;
  const fs::path one = fs::weakly_canonical(file, code);
  if (!seen.insert(code ? file : one).second) return;
  try {
    const std::string text = base::read_text(file, std::size_t{1} << 30u);
    if (file.extension() == ".toml") {
      const base::TomlNode root = base::parse_toml(file.string(), text);
      all += fmt::format("{:016x}", base::fingerprint(base::canonical_text(root)));
      add_named(root, file.parent_path(), seen, all);
      return;
    }
    all += fmt::format("{:016x}", base::fingerprint(text));
  } catch (const base::InputError&) {
    return;
  }
}

}  // namespace

CaseRunner::CaseRunner(fs::path file, const std::string& verb, const fs::path& asked_by)
    : file_(std::move(file)) {
  const std::string schema = schema_of(file_);
  of_records_ = schema.starts_with("snare-record/");
  const std::vector<std::string> verbs = verbs_of(schema);
  if (verbs.empty()) {
    throw base::InputError(
        {file_.string(), 0, "schema", schema,
         "must be that of a scenario, an experiment, a wire or a record file, to be a case of a sweep"});
  }
  verb_ = verb.empty() ? verbs.front() : verb;
  if (std::ranges::find(verbs, verb_) == verbs.end()) {
    throw base::InputError(
        {asked_by.string(), 0, "verb", verb,
         fmt::format("must be one of {} for a file of {}", fmt::join(verbs, ", "), schema)});
  }
}

void CaseRunner::check(const Overrides& overrides, TableSink* names) const {
  if (verb_ == "simulate") {
    const scenario::Scenario asked = scenario::read_scenario(file_, overrides);
    if (names == nullptr) return;
    give_history(*names, asked.motions.runs.front().motion, {});
  } else if (verb_ == "distil") {
    static_cast<void>(reduction::read_wire_file(file_, overrides));
  } else if (of_records_) {
    static_cast<void>(identification::read_records(file_, overrides));
    if (names != nullptr) give_record_curves(*names, {}, {});
  } else {
    const identification::Experiment experiment =
        identification::read_experiment(file_, identification::parameters(), overrides);
    if (names == nullptr) return;
    const std::vector<identification::Prediction> none(experiment.series.size());
    give_curves(*names, experiment.series, none,
                verb_ == "push" ? std::vector<CurveColumn>() : curve_columns({}));
  }
}

CaseEnd CaseRunner::run_or_throw(const Overrides& overrides, const Watch& watch, json& result,
                                 TableSink* history) const {
  if (verb_ == "simulate") return simulate(scenario::read_scenario(file_, overrides), watch, result, history);
  if (verb_ == "distil") return distil(reduction::read_wire_file(file_, overrides), watch, result);
  if (of_records_) {
    return trace_records(identification::read_records(file_, overrides), verb_ == "trace", watch, result,
                         history);
  }
  const identification::Experiment experiment =
      identification::read_experiment(file_, identification::parameters(), overrides);
  if (verb_ == "push") return push(experiment, watch, result, history);
  return trace(experiment, verb_ == "trace", watch, result, history);
}

CaseEnd CaseRunner::run(const Overrides& overrides, const Watch& watch, json& result,
                        TableSink* history) const {
  try {
    return run_or_throw(overrides, watch, result, history);
  } catch (const base::InputError& error) {
    return {Status::refused, one_line(error.what())};
  } catch (const std::bad_alloc&) {
    return {Status::broken, "out of memory"};
  } catch (const std::exception& error) {
    return {Status::broken, one_line(error.what())};
  }
}

std::string contents_of_files(const fs::path& file) {
  std::set<fs::path> seen;
  std::string all;
  add_contents(file, seen, all);
  return all;
}

}  // namespace snare::results
