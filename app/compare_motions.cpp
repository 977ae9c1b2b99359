#include "app/compare_motions.hpp"

#include "app/experiment_input.hpp"
#include "app/interruption.hpp"
#include "app/motion_runs.hpp"
#include "app/report/report_page.hpp"
#include "app/report/report_words.hpp"
#include "app/result_folder.hpp"
#include "base/files.hpp"
#include "results/motion_comparison.hpp"
#include "scenario/scenario.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <string>
#include <utility>
#include <vector>

namespace snare::app {

using namespace results;

namespace {

using nlohmann::json;

std::string page_of(const std::string& title, const std::string& subtitle, const json& models,
                    bool interrupted) {
  ReportPage page(title, subtitle);
  page.doubts({}, interrupted);
  page.heading("Wire models beside the full wire");
  Table table{
      "",
      {"Model"_code, "Steps"_number, "Wall time [s]"_number, "Real-time factor"_number, "Caught"_text},
      {}};
  for (const json& m : models) {
    table.rows.push_back(
        {m["model"].get<std::string>(), std::to_string(m["cost"]["steps"].get<long>()),
         format_significant(m["cost"]["wall_s"].get<double>()),
         format_significant(m["cost"]["real_time_factor"].get<double>()),
         m["outcome"]["caught"].is_boolean() ? (m["outcome"]["caught"].get<bool>() ? "yes" : "no") : "-"});
  }
  page.table(table);
  Table contacts{"Peak forces", {"Contact"_text}, {}};
  for (const json& m : models)
    contacts.columns.push_back({m["model"].get<std::string>() + " [N]", ColumnKind::number});
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

ExitStatus compare_motions(const std::filesystem::path& file, const CommonOptions& options,
                           Console& console) {
  const scenario::Scenario asked = scenario::read_scenario(file, overrides_of(options));
  const scenario::WireMotions& motions = asked.motions;
  const ResultFolder folder(options, {"compare.json", "report.html", "checkpoint.bin"});
  const MotionComparison comparison = with_every_model(file, overrides_of(options), motions);
  const std::vector<MotionRecord> records = run_motions(
      comparison.motions.runs,
      {options.out / "checkpoint.bin", "compare\n" + motions.input, motions.output.checkpoint_wall_time},
      console);
  begin_writing();
  const json compared = comparison_json(asked, comparison, records);
  const json& models = compared["models"];
  const bool partial = compared["interrupted"].get<bool>();
  base::write_text(options.out / "report.html", page_of(asked.title, asked.source, models, partial));
  write_result(options, "compare.json", compared);
  if (partial) console.complain("interrupted: the results are a part of what was asked for");
  if (!options.json) {
    for (const json& m : models)
      console.say(fmt::format("{:<14} {} steps, {:.3g} s, {:.3g} times real time",
                              m["model"].get<std::string>(), m["cost"]["steps"].get<long>(),
                              m["cost"]["wall_s"].get<double>(),
                              m["cost"]["real_time_factor"].get<double>()));
    for (const auto& [model, why] : comparison.left_out)
      console.say(fmt::format("{:<14} left out: {}", model, why));
    console.say(fmt::format("wrote {}/compare.json, report.html", options.out.string()));
  }
  return status_of(records);
}

}  // namespace snare::app
