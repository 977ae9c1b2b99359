#include "app/commands.hpp"
#include "app/report/report_page.hpp"
#include "base/files.hpp"
#include "validation/air_table_checks.hpp"
#include "validation/arm_checks.hpp"
#include "validation/contact_law_checks.hpp"
#include "validation/distil_checks.hpp"
#include "validation/friction_checks.hpp"
#include "validation/linked_motion_checks.hpp"
#include "validation/motion_accuracy_checks.hpp"
#include "validation/motion_checks.hpp"
#include "validation/push_checks.hpp"
#include "validation/trace_checks.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdlib>

namespace snare::app {

namespace {

nlohmann::json row_json(const validation::Row& row) {
  return {{"group", row.group},
          {"name", row.name},
          {"unit", row.unit},
          {"source", row.source},
          {"reference", row.reference},
          {"value", row.value},
          {"error", row.error()},
          {"error_kind", row.kind == validation::ErrorKind::relative ? "relative" : "absolute"},
          {"limit", row.limit},
          {"verdict", row.within() ? "within" : "out"}};
}

std::string page(const std::vector<validation::Row>& rows, const std::vector<std::string>& skipped) {
  ReportPage page("Validation of snare",
                  "Every row: what was computed, beside a reference that does not come from it.");
  std::string group;
  Table table;
  const auto flush = [&] {
    if (!table.rows.empty()) page.table(table);
    table = Table{};
    table.columns = {"quantity"_text, "reference"_number, "computed"_number, "error"_number,
                     "limit"_number,  "verdict"_text,     "source"_text};
  };
  for (const validation::Row& row : rows) {
    if (row.group != group) {
      flush();
      group = row.group;
      page.heading(group);
    }
    const std::string unit = row.unit.empty() ? "" : " " + row.unit;
    table.rows.push_back({{row.name},
                          {format_significant(row.reference, 8) + unit},
                          {format_significant(row.value, 8) + unit},
                          {format_significant(row.error(), 2)},
                          {format_significant(row.limit, 2)},
                          {row.within() ? "within" : "OUT", row.within() ? Tone::good : Tone::bad},
                          {row.source}});
  }
  flush();
  if (!skipped.empty()) {
    page.heading("Left out");
    page.list(skipped);
  }
  return page.html();
}

}  // namespace

ExitStatus run_validate(const CommonOptions& options, Console& console) {
  // Measurements of others are not part of the product: they are looked for beside it.
  const char* named = std::getenv("SNARE_MEASURED_DATA");
  const std::filesystem::path measured =
      named != nullptr ? std::filesystem::path(named) : data_directory() / ".." / ".." / "shared" / "data";
  std::vector<validation::Check> checks;
  for (const std::vector<validation::Check>& some :
       {validation::static_wire_checks(), validation::distil_checks(), validation::motion_checks(),
        validation::motion_accuracy_checks(), validation::friction_checks(), validation::contact_law_checks(),
        validation::air_table_checks(), validation::arm_checks(data_directory() / "arms"),
        validation::linked_motion_checks(data_directory()), validation::tracing_checks(measured)}) {
    checks.insert(checks.end(), some.begin(), some.end());
  }
  std::vector<validation::Row> rows;
  std::vector<std::string> skipped;
  int out = 0;
  for (std::size_t i = 0; i < checks.size(); ++i) {
    if (interrupted()) {
      skipped.push_back("interrupted before: " + checks[i].name);
      break;
    }
    if (!checks[i].skipped.empty()) {
      skipped.push_back(checks[i].name + ": " + checks[i].skipped);
      console.say("skipped: " + skipped.back());
      continue;
    }
    console.progress(fmt::format("{} of {}: {}", i + 1, checks.size(), checks[i].name));
    for (validation::Row& row : checks[i].run()) {
      if (!row.within()) {
        ++out;
        console.complain(
            fmt::format("out of its limit: {}, {}: {} instead of {}", row.group, row.name, row.value, row.reference));
      }
      rows.push_back(std::move(row));
    }
  }
  console.end_progress();
  nlohmann::json result{{"schema", "snare-validation/1"},
                        {"version", version()},
                        {"rows", nlohmann::json::array()},
                        {"skipped", skipped}};
  for (const validation::Row& row : rows) result["rows"].push_back(row_json(row));
  write_result(options, "validation.json", result);
  base::write_text(options.out / "report.html", page(rows, skipped));
  std::string group;
  for (const validation::Row& row : rows) {
    if (row.group != group) console.say((group = row.group) + ":");
    console.say(fmt::format("  {:<58} {:>14.8g} {:>14.8g} {:<6} error {:.1e} of {:.0e} {}", row.name, row.reference,
                            row.value, row.unit, row.error(), row.limit, row.within() ? "" : "OUT"));
  }
  console.say(
      fmt::format("{} rows, {} out of their limit; wrote {}/validation.json", rows.size(), out, options.out.string()));
  return out == 0 ? ExitStatus::done : ExitStatus::row_out_of_limit;
}

}  // namespace snare::app
