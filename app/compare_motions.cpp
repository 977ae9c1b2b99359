#include "app/compare_motions.hpp"

#include "app/experiment_input.hpp"
#include "app/interruption.hpp"
#include "app/motion_runs.hpp"
#include "app/motion_summary.hpp"
#include "app/report/report_page.hpp"
#include "app/report/report_words.hpp"
#include "app/result_folder.hpp"
#include "base/files.hpp"
#include "scenario/scenario.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace snare::app {

namespace {

using nlohmann::json;

/// The scenario once for each model of its wires, and the models that it cannot have, with the reason.
struct Candidates {
  std::vector<scenario::NamedMotion> runs;
  std::vector<std::pair<std::string, std::string>> left_out;
};

Candidates with_models(const std::filesystem::path& file, const CommonOptions& options,
                       const std::vector<std::string>& model_keys) {
  Candidates candidates;
  for (const char* model : {"full", "quasi_static", "stretched", "rod", "rod_linear"}) {
    std::vector<base::Override> overrides = overrides_of(options);
    for (const std::string& key : model_keys) overrides.push_back({key, fmt::format("\"{}\"", model)});
    try {
      const scenario::Scenario asked = scenario::read_scenario(file, overrides);
      scenario::NamedMotion one = std::get<scenario::WireMotions>(asked.content).runs.front();
      one.name = one.model = model;
      candidates.runs.push_back(std::move(one));
    } catch (const base::InputError& error) {
      candidates.left_out.emplace_back(model, error.problems().front().message());
    }
  }
  return candidates;
}

/// A difference relative to a reference; none where there is nothing to relate to.
json relative(double value, double reference) {
  return reference != 0.0 ? json(value / reference - 1.0) : json();
}

/// Differences of an outcome from that of the full wire: relative ones of forces, impulses and tensions, those of times [s].
json differences(const json& outcome, const json& reference) {
  json result = json::object();
  for (const char* key : {"peak_force_N", "peak_tension_N"}) {
    for (const auto& [name, value] : reference[key].items()) {
      if (value.is_number() && outcome[key].contains(name) && outcome[key][name].is_number())
        result[key][name] = relative(outcome[key][name].get<double>(), value.get<double>());
    }
  }
  for (const char* key : {"first_touch_s", "tight_s"}) {
    for (const auto& [name, value] : reference[key].items()) {
      if (value.is_number() && outcome[key].contains(name) && outcome[key][name].is_number())
        result[key][name] = outcome[key][name].get<double>() - value.get<double>();
    }
  }
  for (const auto& [name, value] : reference["impulse_Ns"].items()) {
    if (!outcome["impulse_Ns"].contains(name)) continue;
    double apart = 0.0, size = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double whole = value[k].get<double>();
      apart += std::pow(outcome["impulse_Ns"][name][k].get<double>() - whole, 2);
      size += whole * whole;
    }
    if (size > 0.0) result["impulse_Ns"][name] = std::sqrt(apart / size);
  }
  result["same_outcome"] = outcome["caught"] == reference["caught"];
  return result;
}

std::string page_of(const std::string& title, const std::string& subtitle, const json& models) {
  ReportPage page(title, subtitle);
  page.heading("Wire models beside the full wire");
  Table table{"", {"Model"_code, "Steps"_number, "Wall time [s]"_number, "Real-time factor"_number, "Caught"_text}, {}};
  for (const json& m : models) {
    table.rows.push_back(
        {m["model"].get<std::string>(), std::to_string(m["cost"]["steps"].get<long>()),
         format_significant(m["cost"]["wall_s"].get<double>()),
         format_significant(m["cost"]["real_time_factor"].get<double>()),
         m["outcome"]["caught"].is_boolean() ? (m["outcome"]["caught"].get<bool>() ? "yes" : "no") : "-"});
  }
  page.table(table);
  Table contacts{"Peak forces", {"Contact"_text}, {}};
  for (const json& m : models) contacts.columns.push_back({m["model"].get<std::string>() + " [N]", ColumnKind::number});
  for (const auto& [name, value] : models.front()["outcome"]["peak_force_N"].items()) {
    std::vector<Cell> row{name};
    for (const json& m : models) {
      const json& forces = m["outcome"]["peak_force_N"];
      row.emplace_back(forces.contains(name) ? format_significant(forces[name].get<double>()) : "-");
    }
    contacts.rows.push_back(std::move(row));
  }
  page.table(contacts);
  page.footer(written_by(version(), "compare.json"));
  return page.html();
}

}  // namespace

ExitStatus compare_motions(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  const scenario::Scenario asked = scenario::read_scenario(file, overrides_of(options));
  const auto* motions = std::get_if<scenario::WireMotions>(&asked.content);
  if (motions == nullptr || !motions->composed)
    throw base::InputError(
        {file.string(), 0, "schema", asked.kind, "must be \"snare-scenario/2\": a scenario that lists what there is"});
  if (motions->model_keys.empty())
    throw base::InputError(
        {file.string(), 0, "wires", "", "must have at least one, here or in [[snares]], to compare"});
  const ResultFolder folder(options, {"compare.json", "report.html", "checkpoint.bin"});
  const KeepWhenInterrupted word({}, options.json ? "snare-comparison/1" : "");
  scenario::WireMotions with = *motions;
  Candidates candidates = with_models(file, options, motions->model_keys);
  with.runs = std::move(candidates.runs);
  const std::vector<MotionRecord> records = run_motions(
      with.runs, {options.out / "checkpoint.bin", "compare\n" + motions->input, motions->output.checkpoint_wall_time},
      console);
  begin_writing();
  const bool partial = left_undone(with.runs, records);
  json models = json::array();
  std::optional<json> reference;
  for (const FinishedMotion& run : finished_motions(with, records)) {
    const json outcome = outcome_json(with, run);
    models.push_back({{"model", run.asked.model},
                      {"outcome", outcome},
                      {"finished", run.result.report.usable()},
                      {"cost",
                       {{"wall_s", run.result.wall_seconds},
                        {"steps", run.result.statistics.steps},
                        {"real_time_factor", real_time_factor(run.result)}}},
                      {"from_full", reference ? differences(outcome, *reference) : json()}});
    if (!reference) reference = outcome;
  }
  json left_out = json::array();
  for (const auto& [model, why] : candidates.left_out) left_out.push_back({{"model", model}, {"why", why}});
  write_result(options, "compare.json",
               {{"schema", "snare-comparison/1"},
                {"version", version()},
                {"title", asked.title},
                {"kind", "motion"},
                {"interrupted", partial},
                {"models", models},
                {"left_out", left_out}});
  base::write_text(options.out / "report.html", page_of(asked.title, asked.source, models));
  if (!options.json) {
    for (const json& m : models)
      console.say(fmt::format("{:<14} {} steps, {:.3g} s, {:.3g} times real time", m["model"].get<std::string>(),
                              m["cost"]["steps"].get<long>(), m["cost"]["wall_s"].get<double>(),
                              m["cost"]["real_time_factor"].get<double>()));
    for (const auto& [model, why] : candidates.left_out) console.say(fmt::format("{:<14} left out: {}", model, why));
    console.say(fmt::format("wrote {}/compare.json, report.html", options.out.string()));
  }
  return status_of(records);
}

}  // namespace snare::app
