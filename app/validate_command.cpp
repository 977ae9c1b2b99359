#include "app/commands.hpp"
#include "app/interruption.hpp"
#include "app/report/report_page.hpp"
#include "app/result_folder.hpp"
#include "app/row_json.hpp"
#include "base/errors.hpp"
#include "base/files.hpp"
#include "base/parallel.hpp"
#include "papers/papers.hpp"
#include "validation/air_table_checks.hpp"
#include "validation/arm_checks.hpp"
#include "validation/capture_checks.hpp"
#include "validation/contact_law_checks.hpp"
#include "validation/distil_checks.hpp"
#include "validation/frequency_checks.hpp"
#include "validation/friction_checks.hpp"
#include "validation/linked_motion_checks.hpp"
#include "validation/motion_accuracy_checks.hpp"
#include "validation/motion_checks.hpp"
#include "validation/push_checks.hpp"
#include "validation/record_checks.hpp"
#include "validation/snare_checks.hpp"
#include "validation/trace_checks.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace snare::app {

namespace {

/// What was checked, and why the rest was not.
struct Validation {
  std::vector<validation::Row> rows;
  std::vector<std::string> skipped;
  std::size_t checks = 0;  ///< asked for
  std::size_t done = 0;    ///< of these, with those that were skipped
  [[nodiscard]] bool whole() const { return done == checks; }
  [[nodiscard]] auto out() const {
    return std::ranges::count_if(rows, [](const validation::Row& row) { return !row.within(); });
  }
};

/// What the checks that are done have found, in the order in which they are asked for.
Validation in_order(const std::vector<validation::Check>& checks,
                    const std::vector<std::optional<std::vector<validation::Row>>>& found) {
  Validation v;
  v.checks = checks.size();
  for (std::size_t k = 0; k < checks.size(); ++k) {
    if (!found[k]) continue;
    ++v.done;
    if (!checks[k].skipped.empty()) v.skipped.push_back(checks[k].name + ": " + checks[k].skipped);
    v.rows.insert(v.rows.end(), found[k]->begin(), found[k]->end());
  }
  return v;
}

std::string page(const Validation& v) {
  const auto& [rows, skipped, checks, done] = v;
  ReportPage page(
      "Validation of snare",
      "Every row: a computed value and its reference, whose kind says where it comes from. Rows of the kind "
      "\"convergence of this code\" compare this code with itself, all others with a reference from "
      "elsewhere.");
  page.doubts({}, !v.whole());
  page.heading("Kinds of references");
  page.paragraph(fmt::format("{} rows: {}.", rows.size(), validation::count_by_kind(rows)));
  page.list(
      {"closed form: a formula, a quadrature, the root of an equation, a balance that has to close, a state "
       "or a "
       "symmetry that has to hold; it may be evaluated with forces and masses of the run that it checks",
       "published measurement: readings of others, or their published statements about them",
       "published computation: numbers that others have computed, fits of their measurements included",
       "independent code: another formulation or program that shares no equation with the code under test",
       "convergence of this code: this code on a finer mesh, at a tighter tolerance, at another scale or by "
       "another "
       "of its routes, and the work that it needs"});
  std::string group;
  Table table;
  const auto flush = [&] {
    if (!table.rows.empty()) page.table(table);
    table = Table{};
    table.columns = {"quantity"_text,   "kind"_text,    "reference"_number,
                     "computed"_number, "error"_number, "limit"_number,
                     "verdict"_text,    "source"_text,  "why the limit is absolute"_text};
  };
  for (const validation::Row& row : rows) {
    if (row.group != group) {
      flush();
      group = row.group;
      page.heading(group);
    }
    const std::string unit = row.unit.empty() ? "" : " " + row.unit;
    table.rows.push_back({{row.name},
                          {std::string(validation::words_of(row.kind))},
                          {format_significant(row.reference, 8) + unit},
                          {format_significant(row.value, 8) + unit},
                          {format_significant(row.error(), 2)},
                          {format_significant(row.limit.value(), 2)},
                          {row.within() ? "within" : "OUT", row.within() ? Tone::good : Tone::bad},
                          {row.source},
                          {row.limit.reason()}});
  }
  flush();
  if (!skipped.empty()) {
    page.heading("Left out");
    page.list(skipped);
  }
  return page.html();
}

void write_files(const CommonOptions& options, const Validation& v) {
  nlohmann::json result{
      {"schema", "snare-validation/1"},  {"version", version()},
      {"interrupted", !v.whole()},       {"checks", {{"asked", v.checks}, {"done", v.done}}},
      {"rows", nlohmann::json::array()}, {"skipped", v.skipped}};
  for (const validation::Row& row : v.rows) result["rows"].push_back(row_json(row));
  base::write_text(options.out / "report.html", page(v));
  write_result(options, "validation.json", result);
}

std::string count_words(const Validation& v, const CommonOptions& options) {
  const std::string kinds = v.rows.empty() ? "" : fmt::format(" ({})", validation::count_by_kind(v.rows));
  return fmt::format("{}{} rows{}, {} out of their limit; wrote {}/validation.json",
                     v.whole() ? "" : fmt::format("a part, {} of {} checks: ", v.done, v.checks),
                     v.rows.size(), kinds, v.out(), options.out.string());
}

std::vector<validation::Check> all_checks() {
  // Measurements of others are not part of the product: they are looked for beside it.
  const char* named = std::getenv("SNARE_MEASURED_DATA");
  const std::filesystem::path measured =
      named != nullptr ? std::filesystem::path(named) : data_directory() / ".." / ".." / "shared" / "data";
  std::vector<validation::Check> checks;
  for (const std::vector<validation::Check>& some :
       {validation::static_wire_checks(), validation::distil_checks(), validation::motion_checks(),
        validation::motion_accuracy_checks(), validation::friction_checks(), validation::contact_law_checks(),
        validation::air_table_checks(data_directory()), validation::arm_checks(data_directory() / "arms"),
        validation::linked_motion_checks(), validation::capture_checks(data_directory()),
        validation::snare_checks(data_directory()), validation::frequency_checks(data_directory()),
        validation::tracing_checks(measured), papers::paper_checks(data_directory()),
        validation::record_checks(data_directory(), measured)}) {
    checks.insert(checks.end(), some.begin(), some.end());
  }
  return checks;
}

}  // namespace

ExitStatus run_validate(const CommonOptions& options, Console& console) {
  if (!options.overrides.empty())
    throw base::InputError(
        {"--set", 0, options.overrides.front(), "", "validate reads no file, so there is no key to set"});
  const ResultFolder folder(options, {"validation.json", "report.html"});
  const std::vector<validation::Check> checks = all_checks();
  std::vector<std::optional<std::vector<validation::Row>>> found(checks.size());
  std::mutex mutex;  // of what is found: it may be asked for while checks run
  const auto so_far = [&] {
    const std::scoped_lock lock(mutex);
    return in_order(checks, found);
  };
  const KeepWhenInterrupted keeping(
      [&] {
        const Validation part = so_far();
        write_files(options, part);
        return count_words(part, options);
      },
      "");
  std::atomic<std::size_t> begun = 0;
  base::parallel_for(checks.size(), [&](std::size_t i) {
    if (interrupted()) return;
    const std::size_t k = checks.size() - 1 - i;  // captures and records, which take longest, are the last
    console.progress(fmt::format("{} of {}: {}", ++begun, checks.size(), checks[k].name));
    std::vector<validation::Row> rows;
    if (checks[k].skipped.empty()) rows = checks[k].run();
    const std::scoped_lock lock(mutex);
    for (const validation::Row& row : rows) {
      if (!row.within())
        console.complain(fmt::format("out of its limit: {}, {}: {} instead of {}", row.group, row.name,
                                     row.value, row.reference));
    }
    found[k] = std::move(rows);
  });
  console.end_progress();
  begin_writing();
  const Validation v = so_far();
  for (const std::string& left_out : v.skipped) console.say("skipped: " + left_out);
  write_files(options, v);
  std::string group;
  for (const validation::Row& row : v.rows) {
    if (row.group != group) console.say((group = row.group) + ":");
    console.say(fmt::format("  {:<58} {:>14.8g} {:>14.8g} {:<6} error {:.1e} of {:.0e} {}", row.name,
                            row.reference, row.value, row.unit, row.error(), row.limit.value(),
                            row.within() ? "" : "OUT"));
  }
  if (!v.whole()) {
    console.complain("interrupted: " + count_words(v, options));
    return ExitStatus::solver_stopped;
  }
  console.say(count_words(v, options));
  return v.out() == 0 ? ExitStatus::done : ExitStatus::row_out_of_limit;
}

}  // namespace snare::app
