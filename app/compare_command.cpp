#include "app/commands.hpp"
#include "app/compare_motions.hpp"
#include "app/experiment_input.hpp"
#include "app/interruption.hpp"
#include "app/report/compare_report.hpp"
#include "app/result_folder.hpp"
#include "base/files.hpp"
#include "base/toml_tree.hpp"
#include "results/static_comparison.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mutex>

namespace snare::app {

using namespace results;

namespace {

using reduction::CaseComparison;
using reduction::StaticCase;

void write_files(const CommonOptions& options, const StaticComparison& comparison,
                 const std::vector<CaseComparison>& results) {
  base::write_text(options.out / "report.html",
                   compare_report_html(comparison.title, results, results.size() < comparison.cases.size()));
  write_result(options, "compare.json", comparison_json(comparison, results));
}

std::string part_words(const StaticComparison& comparison, const std::vector<CaseComparison>& results) {
  return fmt::format("a part is kept, {} of {} cases", results.size(), comparison.cases.size());
}

}  // namespace

ExitStatus run_compare(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  const std::vector<base::Override> overrides = overrides_of(options);
  const base::TomlNode root = base::parse_toml(file.string(), base::read_text(file));
  const base::TomlNode* schema = root.find("schema");
  if (schema != nullptr && schema->text.starts_with("snare-scenario/"))
    return compare_motions(file, options, console);
  const StaticComparison comparison = read_static_comparison(file, overrides);

  const ResultFolder folder(options, {"compare.json", "report.html"});
  // One after the other: their cost is measured.
  std::vector<CaseComparison> results;
  std::mutex mutex;  // of results: what is finished may be asked for while a case runs
  const KeepWhenInterrupted keeping(
      [&] {
        const std::scoped_lock lock(mutex);
        write_files(options, comparison, results);
        return part_words(comparison, results);
      },
      "");
  ExitStatus status = ExitStatus::done;
  for (const StaticCase& one : comparison.cases) {
    if (interrupted()) break;
    console.progress(fmt::format("case {}", one.name));
    CaseComparison compared = reduction::compare_static(one, comparison.settings);
    const std::scoped_lock lock(mutex);
    results.push_back(std::move(compared));
    if (results.back().report.usable()) continue;
    console.complain(fmt::format("case {}: {}", one.name, results.back().report.message));
    status = ExitStatus::solver_stopped;
  }
  console.end_progress();
  begin_writing();
  write_files(options, comparison, results);
  if (results.size() < comparison.cases.size()) {
    console.complain("interrupted: " + part_words(comparison, results));
    status = ExitStatus::solver_stopped;
  }
  if (options.json) return status;
  for (const CaseComparison& one : results) {
    for (const reduction::ModelResult& m : one.models) {
      console.say(fmt::format("{:<8} {:<26} error {:>9.3g} N  measured {:>9}  {:>9.3g} s  {} numbers",
                              one.name, m.model, m.largest_error,
                              m.measured_rms ? fmt::format("{:.3g} N", *m.measured_rms) : "-", m.seconds,
                              m.parameters) +
                  (m.why.empty() ? "" : "  " + m.why));
    }
  }
  console.say(fmt::format("wrote {}/compare.json", options.out.string()));
  return status;
}

}  // namespace snare::app
