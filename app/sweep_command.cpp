#include "app/commands.hpp"
#include "app/crash_note.hpp"
#include "app/experiment_input.hpp"
#include "app/interruption.hpp"
#include "app/launched_ranks.hpp"
#include "app/result_folder.hpp"
#include "app/sweep_answers.hpp"
#include "app/sweep_page.hpp"
#include "base/errors.hpp"
#include "base/files.hpp"
#include "study/case_loop.hpp"
#include "study/rank_work.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>

namespace snare::app {

namespace {

using study::CaseRecord;
using study::Journal;

std::string time_words(double seconds) {
  constexpr double minute = 60.0, hour = 3600.0;
  if (seconds < 2.0 * minute) return fmt::format("{:.0f} s", seconds);
  if (seconds < 2.0 * hour) return fmt::format("{:.0f} min", seconds / minute);
  return fmt::format("{:.1f} h", seconds / hour);
}

/// Runs the cases that the journal does not have yet.
class SweepRun {
 public:
  SweepRun(const SweepStudy& study, Journal& journal, int threads, study::RankLeader* leader, Console& console)
      : study_(study), journal_(journal), threads_(threads), leader_(leader), console_(console) {}

  /// Cases of a design. Throws what ends all.
  void design() {
    const std::uint64_t count = study_.count();
    study::Scheduler scheduler({.count = count, .workers = workers(), .chunk_s = chunk_s()},
                               [this](std::uint64_t k) { return journal_.has(k); });
    total_ = count;
    begin();
    study::Dispatcher dispatcher(
        std::move(scheduler), [this](std::uint64_t index, const std::string& line) { keep(index, line); }, interrupted);
    run(
        dispatcher, [](std::uint64_t) { return std::vector<double>(); }, [](std::uint64_t k) { return k; });
  }

  /// Cases of a subset simulation, of which the next ones depend on the last. True when it came to its end.
  bool subset(study::SubsetSimulation& simulation) {
    begin();
    while (!simulation.finished() && !interrupted()) {
      const std::uint64_t base = simulation.told();
      const std::vector<std::vector<double>>& asked = simulation.next();
      total_ = base + asked.size();
      const auto values = [&](std::uint64_t k) { return study_.sweep().design.values_of_scores(asked[k]); };
      study::Dispatcher dispatcher(
          study::Scheduler({.count = asked.size(), .workers = workers(), .chunk_s = chunk_s()},
                           [&](std::uint64_t k) { return journal_.has(base + k); }),
          [&](std::uint64_t k, const std::string& line) { keep(base + k, line); }, interrupted);
      run(dispatcher, values, [base](std::uint64_t k) { return base + k; });
      if (interrupted()) return false;
      std::vector<std::optional<double>> margins;
      for (std::uint64_t k = 0; k < asked.size(); ++k) {
        const std::optional<std::string> line = journal_.result(base + k);
        const auto record = line ? study::record_of(*line) : std::nullopt;
        margins.push_back(record ? study_.margin_of(*record) : std::nullopt);
      }
      simulation.tell(margins);
    }
    return simulation.finished();
  }

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] int workers() const { return workers_; }
  /// Threads ask for a case at a time; ranks for half a second's.
  [[nodiscard]] double chunk_s() const { return leader_ != nullptr ? 0.5 : 0.0; }

 public:
  void set_workers(int workers) { workers_ = std::max(1, workers); }

 private:
  void begin() {
    before_ = journal_.finished();
    began_ = Clock::now();
    if (const auto line = before_ > 0 ? journal_.result(0) : std::nullopt; line) any_done_ = true;
  }

  template <class Values, class Number>
  void run(study::Dispatcher& dispatcher, const Values& values, const Number& number) {
    const auto run_one = [&](std::uint64_t k, const std::vector<double>& given) {
      const CrashNote note(journal_, number(k), given);
      return study::line_of(study_.run(given.empty() ? study_.sweep().design.values(number(k)) : given, interrupted));
    };
    if (leader_ != nullptr) {
      leader_->run(dispatcher, run_one, values, [&](std::uint64_t k) {
        CaseRecord record{"lost", "the process that ran it ended, twice", 0.0, {}, {}};
        if (study_.count() == 0) record.values = values(k);
        return study::line_of(record);
      });
    } else {
      study::run_cases(dispatcher, threads_, [&](std::uint64_t k) { return run_one(k, values(k)); });
      dispatcher.rethrow();
    }
  }

  /// Called for one case at a time.
  void keep(std::uint64_t index, const std::string& line) {
    const std::optional<CaseRecord> record = study::record_of(line);
    if (!record) throw std::runtime_error("a case has a result that cannot be read back");
    if (record->status == "no_field" && !any_done_) {
      throw base::InputError({study_.sweep().file.string(), 0, "collect", "", record->reason});
    }
    any_done_ = true;
    journal_.append(index, line);
    if (!record->done()) ++without_;
    const std::uint64_t done = journal_.finished();
    const double elapsed = std::chrono::duration<double>(Clock::now() - began_).count();
    if (elapsed - shown_ < 0.1 && done < total_) return;
    shown_ = elapsed;
    const double share =
        static_cast<double>(done - before_) / static_cast<double>(std::max<std::uint64_t>(1, total_ - before_));
    console_.progress(fmt::format("{} of {} cases{}, {} to go", done, total_,
                                  without_ > 0 ? fmt::format(" ({} without a result)", without_) : "",
                                  time_words(elapsed * (1.0 - share) / share)));
  }

  const SweepStudy& study_;
  Journal& journal_;
  int threads_;
  int workers_ = 1;
  study::RankLeader* leader_;
  Console& console_;
  std::uint64_t total_ = 0, before_ = 0, without_ = 0;
  bool any_done_ = false;
  double shown_ = -1.0;
  Clock::time_point began_;
};

/// One case by itself, as its verb would run it.
ExitStatus run_one_case(const SweepStudy& study, const CommonOptions& options, Console& console) {
  const std::uint64_t index = options.only_case - 1;
  const study::Design& design = study.sweep().design;
  std::vector<double> values;
  if (study.count() > 0) {
    if (index >= study.count()) {
      throw base::InputError(
          {"", 0, "--case", std::to_string(options.only_case), fmt::format("must be from 1 to {}", study.count())});
    }
    values = design.values(index);
  } else {
    const std::filesystem::path file = options.out / "cases.journal";
    std::optional<std::string> line;
    if (std::filesystem::exists(file)) line = Journal(file, study.identity(), 0).result(index);
    const auto record = line ? study::record_of(*line) : std::nullopt;
    if (!record) {
      throw base::InputError(
          {"", 0, "--case", std::to_string(options.only_case),
           "must be a case that has been run into --out: in this design cases depend on one another"});
    }
    values = record->values;
  }
  CommonOptions one = options;
  one.only_case = 0;
  one.out = options.out / fmt::format("case_{}", options.only_case);
  one.overrides.clear();
  for (const base::Override& change : study.overrides_of(values))
    one.overrides.push_back(change.key + "=" + change.value);
  console.say(study.command_of(values));
  const std::string& verb = study.runner().verb();
  const std::filesystem::path& file = study.runner().file();
  if (verb == "simulate") return run_simulate(file, one, console);
  if (verb == "push") return run_push(file, one, console);
  if (verb == "fit") return run_fit(file, one, console);
  if (verb == "trace") return run_trace(file, one, console);
  return run_distil(file, one, console);
}

/// What the cases in the journal say, into the folder.
SweepAnswers write_answers(const SweepStudy& study, const Journal& journal, std::uint64_t cases,
                           const std::optional<SubsetAnswer>& subset, bool partial, const CommonOptions& options) {
  SweepAnswers answers = sweep_answers(study, journal, cases);
  answers.subset = subset;
  answers.interrupted = partial;
  write_cases(options.out / "cases.csv", study, journal, cases);
  base::write_text(options.out / "report.html", sweep_page(study, answers));
  write_result(options, "summary.json", sweep_summary(study, answers));
  return answers;
}

void tell(const SweepAnswers& answers, const CommonOptions& options, Console& console) {
  for (const FieldAnswer& f : answers.fields) {
    if (f.count == 0) continue;
    if (f.yes_or_no)
      console.say(fmt::format("{}: {} of {}", f.name, f.hits, f.count));
    else
      console.say(fmt::format("{}: mean {:.5g}, from {:.5g} to {:.5g}", f.name, f.mean, f.least, f.most));
  }
  if (answers.subset) {
    console.say(fmt::format("probability {:.3g}, coefficient of variation {:.2g}{}", answers.subset->probability,
                            answers.subset->variation, answers.subset->reached ? "" : " (the event was not reached)"));
  }
  console.say(fmt::format("wrote {0}/cases.csv, summary.json, report.html", options.out.string()));
}

/// Everything but the first rank's work is here.
ExitStatus lead(const SweepStudy& study, int threads, const CommonOptions& options, study::RankLeader* leader,
                int ranks, Console& console) {
  const std::filesystem::path file = options.out / "cases.journal";
  const bool fresh = !std::filesystem::exists(file);
  std::optional<Journal> journal;
  journal.emplace(file, study.identity(), study.count());
  if (journal->damaged() > 0)
    console.complain(fmt::format("{}: {} damaged lines, their cases are run again", file.string(), journal->damaged()));
  if (journal->finished() > 0)
    console.say(fmt::format("goes on from {}: {} cases are there", file.string(), journal->finished()));
  const KeepWhenInterrupted keeping(
      [&] {
        journal->flush();
        return fmt::format("{} finished cases are kept in {}; the same command goes on", journal->finished(),
                           file.string());
      },
      options.json ? "snare-sweep-summary/1" : "");

  SweepRun run(study, *journal, threads, leader, console);
  run.set_workers(threads * ranks);
  std::optional<study::SubsetSimulation> simulation;
  try {
    if (study.count() > 0) {
      run.design();
    } else {
      simulation.emplace(study.subset_settings());
      run.subset(*simulation);
    }
  } catch (const base::InputError&) {
    const bool empty = journal->finished() == 0;
    journal.reset();
    std::error_code ignored;
    if (fresh && empty) std::filesystem::remove(file, ignored);
    throw;
  }
  console.end_progress();
  begin_writing();
  journal->flush();

  const std::uint64_t finished = journal->finished();
  const bool partial = study.count() > 0 ? finished < study.count() : !simulation->finished();
  if (partial)
    console.complain(fmt::format("interrupted: {} cases are finished and kept; the same command goes on", finished));
  std::optional<SubsetAnswer> subset;
  if (simulation && !partial)
    subset = {simulation->probability(), simulation->variation(), simulation->reached(), simulation->levels()};
  const std::uint64_t cases = study.count() > 0 ? study.count() : simulation->told() + simulation->next().size();
  const SweepAnswers answers = write_answers(study, *journal, cases, subset, partial, options);
  const auto done = answers.statuses.find("done");
  const std::uint64_t well = done == answers.statuses.end() ? 0 : done->second;
  if (well < answers.finished) {
    console.complain(fmt::format("{} of {} cases have no result; summary.json has the reasons", answers.finished - well,
                                 answers.finished));
  }
  if (!options.json) tell(answers, options, console);
  return partial || well == 0 ? ExitStatus::solver_stopped : ExitStatus::done;
}

int thread_count(const CommonOptions& options, bool ranks) {
  if (options.threads > 0) return options.threads;
  return ranks ? 1 : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

}  // namespace

ExitStatus run_sweep(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  const std::unique_ptr<study::Ranks> ranks = options.only_case == 0 ? launched_ranks() : nullptr;
  const int rank = ranks ? ranks->rank() : 0;
  /// All ranks meet the same mistakes; the first tells them.
  struct Leave {
    study::Ranks* ranks;
    bool orderly = true;
    explicit Leave(study::Ranks* all) : ranks(all) {}
    Leave(const Leave&) = delete;
    Leave& operator=(const Leave&) = delete;
    ~Leave() {
      if (ranks != nullptr && orderly) ranks->leave();
    }
  } leaving(ranks.get());
  std::optional<SweepStudy> study;
  try {
    study.emplace(file, overrides_of(options));
  } catch (const base::InputError&) {
    if (rank == 0) throw;
    return ExitStatus::wrong_input;
  }
  if (options.only_case > 0) return run_one_case(*study, options, console);
  const int threads = thread_count(options, ranks != nullptr);
  if (rank > 0) {
    study::follow(
        *ranks, study->identity(), threads,
        [&](std::uint64_t index, const std::vector<double>& values) {
          return study::line_of(study->run(values.empty() ? study->sweep().design.values(index) : values, interrupted));
        },
        interrupted);
    return interrupted() ? ExitStatus::solver_stopped : ExitStatus::done;
  }
  if (!ranks || ranks->size() == 1) {
    const ResultFolder folder(options, {"cases.csv", "cases.journal", "summary.json", "report.html"});
    return lead(*study, threads, options, nullptr, 1, console);
  }
  std::optional<study::RankLeader> leader;
  leader.emplace(*ranks, study::RankLeader::Settings{.identity = study->identity(), .threads = threads});
  const ResultFolder folder(options, {"cases.csv", "cases.journal", "summary.json", "report.html"});
  const ExitStatus status = lead(*study, threads, options, &*leader, ranks->size(), console);
  if (const int lost = leader->lost(); lost > 0) {
    console.complain(fmt::format("{} of {} ranks were lost on the way; others ran their cases", lost, ranks->size()));
    leaving.orderly = false;  // who is gone would be waited for
  }
  leader.reset();
  if (leaving.orderly) return status;
  std::fflush(nullptr);
  release_result_folder();
  ::_exit(static_cast<int>(status));
}

}  // namespace snare::app
