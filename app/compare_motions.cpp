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

/// The scenario with its wires in either model.
std::vector<scenario::NamedMotion> with_models(const scenario::NamedMotion& run) {
  std::vector<scenario::NamedMotion> runs;
  for (const auto& [model, quasi_static] : {std::pair{"full", false}, {"quasi_static", true}}) {
    scenario::NamedMotion one = run;
    one.name = one.model = model;
    for (coupling::MotionWire& wire : one.motion.wires) wire.rod.quasi_static = quasi_static;
    runs.push_back(std::move(one));
  }
  return runs;
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
      if (value.is_number() && outcome[key][name].is_number())
        result[key][name] = relative(outcome[key][name].get<double>(), value.get<double>());
    }
  }
  for (const char* key : {"first_touch_s", "tight_s"}) {
    for (const auto& [name, value] : reference[key].items()) {
      if (value.is_number() && outcome[key][name].is_number())
        result[key][name] = outcome[key][name].get<double>() - value.get<double>();
    }
  }
  for (const auto& [name, value] : reference["impulse_Ns"].items()) {
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
    for (const json& m : models) row.emplace_back(format_significant(m["outcome"]["peak_force_N"][name].get<double>()));
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
  const ResultFolder folder(options, {"compare.json", "report.html", "checkpoint.bin"});
  const KeepWhenInterrupted word({}, options.json ? "snare-comparison/1" : "");
  scenario::WireMotions with = *motions;
  with.runs = with_models(motions->runs.front());
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
  write_result(options, "compare.json",
               {{"schema", "snare-comparison/1"},
                {"version", version()},
                {"title", asked.title},
                {"kind", "motion"},
                {"interrupted", partial},
                {"models", models}});
  base::write_text(options.out / "report.html", page_of(asked.title, asked.source, models));
  if (!options.json) {
    for (const json& m : models)
      console.say(fmt::format("{:<14} {} steps, {:.3g} s, {:.3g} times real time", m["model"].get<std::string>(),
                              m["cost"]["steps"].get<long>(), m["cost"]["wall_s"].get<double>(),
                              m["cost"]["real_time_factor"].get<double>()));
    console.say(fmt::format("wrote {}/compare.json, report.html", options.out.string()));
  }
  return status_of(records);
}

}  // namespace snare::app
