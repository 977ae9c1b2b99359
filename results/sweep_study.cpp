#include "results/sweep_study.hpp"

#include "base/archive.hpp"
#include "base/errors.hpp"
#include "base/one_line.hpp"
#include "base/toml_reader.hpp"
#include "results/version.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <set>
#include <stdexcept>
#include <utility>

namespace snare::results {

namespace {

using nlohmann::json;

/// Whether the verb has a history, with the columns that are asked for.
void check_histories(const study::SweepFile& sweep, const CaseRunner& runner,
                     const std::vector<std::string>& names) {
  if (!runner.has_history()) {
    throw base::InputError({sweep.file.string(), 0, "histories", "",
                            fmt::format("must be left out: {} has no history", runner.verb())});
  }
  std::vector<base::InputProblem> problems;
  for (std::size_t k = 0; k < sweep.histories->columns.size(); ++k) {
    const std::string& asked = sweep.histories->columns[k];
    if (std::ranges::find(names, asked) != names.end()) continue;
    problems.push_back(
        {sweep.file.string(), 0, fmt::format("histories.columns[{}]", k + 1), asked,
         fmt::format("must be a column of {}{}", runner.verb() == "simulate" ? "history.csv" : "curves.csv",
                     base::nearest_or_all(asked, names))});
  }
  if (!problems.empty()) throw base::InputError(std::move(problems));
}

/// Whether any of a few cases, spread over all, is one that its reader takes; else what the first is refused
/// for. A key that does not exist is so found before anything runs, and a range of which a part is not
/// allowed is none. Returns the columns of that case's history.
std::vector<std::string> check_some(const study::SweepFile& sweep, const CaseRunner& runner) {
  const std::uint64_t count = sweep.design.count();
  std::set<std::uint64_t> some;
  constexpr std::uint64_t tried = 5;
  for (std::uint64_t k = 0; k < tried; ++k) some.insert((count - 1) / (tried - 1) * k);
  std::vector<base::InputProblem> problems;
  for (const std::uint64_t index : some) {
    try {
      HistoryTable table({}, 1);
      runner.check(study::overrides_of(sweep, sweep.design.values(index)), &table);
      return table.names();
    } catch (const base::InputError& error) {
      if (problems.empty()) problems = error.problems();
    }
  }
  // What the case's reader calls an override is a value of the sweep file.
  for (base::InputProblem& problem : problems) {
    if (problem.file == "--set") problem.file = sweep.file.string();
  }
  throw base::InputError(std::move(problems));
}

}  // namespace

SweepStudy::SweepStudy(const std::filesystem::path& file, const std::vector<base::Override>& overrides)
    : sweep_(study::read_sweep_file(file, overrides)), runner_(sweep_.case_file, sweep_.verb, sweep_.file) {
  const std::vector<std::string> columns = check_some(sweep_, runner_);
  if (sweep_.histories) check_histories(sweep_, runner_, columns);
  identity_ =
      fmt::format("{:016x} {:016x} designs {} snare {}", base::fingerprint(sweep_.canonical),
                  base::fingerprint(contents_of_files(sweep_.case_file)), study::design_version, version());
}

std::uint64_t SweepStudy::count() const noexcept {
  return sweep_.design.settings().kind == study::DesignKind::subset ? 0 : sweep_.design.count();
}

study::CaseRecord SweepStudy::run(const std::vector<double>& values, const std::function<bool()>& stop,
                                  const std::function<void(History&)>& keep) const {
  study::CaseRecord record;
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  std::atomic<bool> late{false};
  std::optional<HistoryTable> table;
  if (sweep_.histories && keep) table.emplace(sweep_.histories->columns, sweep_.histories->every);
  try {
    json result;
    const CaseEnd end = runner_.run(overrides_of(values),
                                    {{},
                                     [&] {
                                       if (elapsed() > sweep_.time_limit) late = true;
                                       return late.load() || stop();
                                     }},
                                    result, table ? &*table : nullptr);
    using Status = CaseEnd::Status;
    record.reason = end.reason;
    switch (end.status) {
      case Status::done:
        record.status = "done";
        for (const study::Collected& field : sweep_.collect)
          record.fields.push_back(study::collected(field, result));
        break;
      case Status::failed:
        record.status = "failed";
        break;
      case Status::refused:
        record.status = "refused";
        break;
      case Status::stopped:
        record.status = "stalled";
        record.reason = fmt::format("not finished within time_limit_s = {}", sweep_.time_limit);
        break;
      case Status::broken:
        record.status = "broken";
        break;
    }
    if (table && (record.done() || record.status == "failed")) {
      if (!table->missing().empty()) throw std::out_of_range("its history has no column " + table->missing());
      try {
        keep(table->history());
      } catch (const std::exception& error) {  // a full disk: this ends all
        record = {"unkept", error.what(), 0.0, {}, {}};
      }
    }
  } catch (const std::out_of_range& error) {  // no such field
    record = {"no_field", error.what(), 0.0, {}, {}};
  } catch (const std::exception& error) {
    record = {"broken", error.what(), 0.0, {}, {}};
  }
  record.seconds = elapsed();
  if (count() == 0) record.values = values;
  return record;
}

std::string SweepStudy::command_of(const std::vector<double>& values) const {
  std::string command = fmt::format("snare {} {}", runner_.verb(), base::shell_word(runner_.file().string()));
  for (const base::Override& change : overrides_of(values))
    command += " --set " + base::shell_word(change.key + "=" + change.value);
  return command;
}

std::optional<double> SweepStudy::margin_of(const study::CaseRecord& record) const {
  const study::Limit& limit = sweep_.limits.front();
  const std::optional<double> value = record.done() ? record.number(limit.field) : std::nullopt;
  if (!value) return std::nullopt;
  return limit.above ? *value - limit.bound : limit.bound - *value;
}

study::SubsetSimulation::Settings SweepStudy::subset_settings() const {
  const study::DesignSettings& design = sweep_.design.settings();
  return {sweep_.design.variables().size(), design.cases, sweep_.subset.level_probability,
          sweep_.subset.most_levels, design.seed};
}

}  // namespace snare::results
