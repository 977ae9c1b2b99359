#include "app/benchmark_page.hpp"
#include "app/commands.hpp"
#include "app/experiment_input.hpp"
#include "app/interruption.hpp"
#include "app/result_folder.hpp"
#include "base/errors.hpp"
#include "base/files.hpp"
#include "base/toml_reader.hpp"
#include "results/benchmark_run.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <mutex>
#include <utility>

namespace snare::app {

namespace {

/// The cases that are asked for; with a history of somebody's that is to be scored on one.
study::BenchmarkFile asked_cases(const std::filesystem::path& file, const CommonOptions& options) {
  study::BenchmarkFile all = study::read_benchmark_file(
      file.empty() ? data_directory() / "benchmark/ring.toml" : file, overrides_of(options));
  std::vector<std::string> names;
  for (const study::BenchmarkCase& c : all.cases) names.push_back(c.name);
  if (!options.only_named.empty()) {
    std::erase_if(all.cases, [&](const study::BenchmarkCase& c) { return c.name != options.only_named; });
    if (all.cases.empty()) {
      const std::string near = base::nearest_word(options.only_named, names);
      throw base::InputError({"", 0, "--case", options.only_named,
                              near.empty() ? fmt::format("must be one of {}", fmt::join(names, ", "))
                                           : fmt::format("unknown case; did you mean {}?", near)});
    }
  }
  if (!options.against.empty()) {
    if (options.only_named.empty())
      throw base::InputError(
          {"", 0, "--against", options.against.string(), "needs --case: the case that it is of"});
    if (options.archive)
      throw base::InputError({"", 0, "--against", options.against.string(), "must stand without --archive"});
    study::BenchmarkModel theirs;
    theirs.name = options.against.filename().string();
    theirs.csv = options.against;
    all.cases.front().models.insert(all.cases.front().models.begin(), std::move(theirs));
  }
  return all;
}

ExitStatus make_archive(const study::BenchmarkFile& benchmark, Console& console, const Watch& watch) {
  for (const study::BenchmarkCase& c : benchmark.cases) {
    const CaseEnd end = archive_case(benchmark, c, watch);
    console.end_progress();
    if (end.status != CaseEnd::Status::done) {
      const bool stopped = end.status == CaseEnd::Status::stopped;
      console.complain(fmt::format("{}: {}; its archive is as before", c.name,
                                   stopped ? "interrupted" : end.reason.c_str()));
      return end.status == CaseEnd::Status::refused ? ExitStatus::wrong_input : ExitStatus::solver_stopped;
    }
    console.say(fmt::format("wrote {}.csv, .json", (benchmark.references / c.name).string()));
  }
  return ExitStatus::done;
}

void write_files(const CommonOptions& options, const study::BenchmarkFile& benchmark,
                 const std::vector<BenchmarkAnswer>& answers, std::size_t asked, std::size_t done) {
  CsvSink csv(options.out / "scores.csv");
  give_scores(csv, answers);
  csv.commit();
  base::write_text(options.out / "report.html", benchmark_page(benchmark, answers, done < asked));
  write_result(options, "benchmark.json", benchmark_json(benchmark, answers, asked));
}

void tell(const BenchmarkAnswer& answer, Console& console) {
  console.say(answer.asked->title + ":");
  for (const BenchmarkRow& row : answer.rows) {
    if (row.scores.empty()) console.say(fmt::format("  {:<16} {}", row.model, row.end.reason));
    for (const auto& [name, s] : row.scores) {
      const study::TrackScore& bar = answer.reference.bars.at(name);
      console.say(fmt::format("  {:<16} {:<22} peak {:<18} integral {:<18} rms {:<18} {:>8.3g} s", row.model,
                              name, score_words(s.peak, bar.peak), score_words(s.integral, bar.integral),
                              score_words(s.rms, bar.rms), row.seconds));
    }
  }
}

}  // namespace

ExitStatus run_benchmark(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  const study::BenchmarkFile benchmark = asked_cases(file, options);
  const Watch watch{[&](const std::string& stage) { console.progress(stage); }, interrupted};
  for (const study::BenchmarkCase& c : benchmark.cases) check_benchmark_case(benchmark, c);
  if (options.archive) return make_archive(benchmark, console, watch);
  std::vector<BenchmarkAnswer> answers;
  std::size_t asked = 0, done = 0;
  std::vector<BenchmarkReference> references;
  for (const study::BenchmarkCase& c : benchmark.cases) {
    references.push_back(read_reference(benchmark, c));
    asked += c.models.size();
    if (references.back().stale)
      console.warn(
          fmt::format("{}: the archived history was made from other input than there is now", c.name));
  }
  const ResultFolder folder(options, {"benchmark.json", "scores.csv", "report.html"});
  std::mutex mutex;  // of answers and done: what is finished may be asked for while a model runs
  const auto words = [&] { return fmt::format("a part is kept, {} of {} models", done, asked); };
  const KeepWhenInterrupted keeping(
      [&] {
        const std::scoped_lock lock(mutex);
        write_files(options, benchmark, answers, asked, done);
        return words();
      },
      "");
  // One after the other: their cost is measured.
  ExitStatus status = ExitStatus::done;
  for (std::size_t k = 0; k < benchmark.cases.size() && !interrupted(); ++k) {
    const study::BenchmarkCase& c = benchmark.cases[k];
    {
      const std::scoped_lock lock(mutex);
      answers.push_back({&c, references[k], {}});
    }
    for (const study::BenchmarkModel& model : c.models) {
      console.progress(fmt::format("{} of {}: {}, {}", done + 1, asked, c.name, model.name));
      BenchmarkRow row = run_benchmark_model(c, model, references[k], watch);
      if (row.end.status == CaseEnd::Status::stopped) break;
      if (row.end.status != CaseEnd::Status::done) {
        console.complain(fmt::format("{}, {}: {}", c.name, model.name, row.end.reason));
        status = ExitStatus::solver_stopped;
      }
      const std::scoped_lock lock(mutex);
      answers.back().rows.push_back(std::move(row));
      ++done;
    }
    if (!interrupted()) tell(answers.back(), console);
  }
  console.end_progress();
  begin_writing();
  write_files(options, benchmark, answers, asked, done);
  if (done < asked) {
    console.complain("interrupted: " + words());
    return ExitStatus::solver_stopped;
  }
  console.say(fmt::format("wrote {}/benchmark.json, scores.csv, report.html", options.out.string()));
  return status;
}

}  // namespace snare::app
