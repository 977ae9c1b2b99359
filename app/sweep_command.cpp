#include "app/commands.hpp"
#include "app/crash_note.hpp"
#include "app/experiment_input.hpp"
#include "app/interruption.hpp"
#include "app/launched_ranks.hpp"
#include "app/result_folder.hpp"
#include "app/sweep_page.hpp"
#include "base/errors.hpp"
#include "base/files.hpp"
#include "results/sweep_run.hpp"
#include "study/rank_journal.hpp"
#include "study/rank_work.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>

namespace snare::app {

namespace {

using study::Journal;

/// One case by itself, as its verb would run it.
ExitStatus run_one_case(const SweepStudy& study, const CommonOptions& options, Console& console) {
  const std::uint64_t index = options.only_case - 1;
  const study::Design& design = study.sweep().design;
  std::vector<double> values;
  if (study.count() > 0) {
    if (index >= study.count()) {
      throw base::InputError({"", 0, "--case", std::to_string(options.only_case),
                              fmt::format("must be from 1 to {}", study.count())});
    }
    values = design.values(index);
  } else {
    const std::filesystem::path file = options.out / "cases.journal";
    std::optional<std::string> line;
    if (std::filesystem::exists(file))
      line = Journal(file, study.identity(), 0, Journal::Use::look).result(index);
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
SweepAnswers write_answers(const SweepStudy& study, const Journal& journal, const SweepEnd& end,
                           const CommonOptions& options) {
  SweepAnswers answers = sweep_answers(study, journal, end);
  CsvSink csv(options.out / "cases.csv");
  give_cases(csv, study, end.in(journal));
  csv.commit();
  base::write_text(options.out / "report.html", sweep_page(study, answers));
  write_result(options, "summary.json", sweep_summary(study, answers));
  return answers;
}

void tell(const SweepAnswers& answers, bool histories, const CommonOptions& options, Console& console) {
  if (answers.inferred() > 0)
    console.say(
        fmt::format("{} of {} cases were run, the others are inferred", answers.finished, answers.cases));
  for (const FieldAnswer& f : answers.fields) {
    if (f.count == 0) continue;
    if (f.yes_or_no)
      console.say(fmt::format("{}: {} of {}", f.name, f.hits, f.count));
    else
      console.say(fmt::format("{}: mean {:.5g}, from {:.5g} to {:.5g}", f.name, f.mean, f.least, f.most));
  }
  if (answers.subset) {
    const SubsetAnswer& s = *answers.subset;
    console.say(
        s.reached ? fmt::format(
                        "probability {:.3g}, 95 % interval {:.3g} to {:.3g}, coefficient of variation {:.2g}",
                        s.probability, s.interval.low, s.interval.high, s.variation)
                  : fmt::format("the event was not reached: probability below {:.3g}", s.interval.high));
  }
  console.say(fmt::format("wrote {0}/cases.csv, summary.json, report.html{1}", options.out.string(),
                          histories ? ", histories.h5" : ""));
}

/// Everything but the first rank's work is here.
ExitStatus lead(const SweepStudy& study, int threads, const CommonOptions& options, study::RankLeader* leader,
                int ranks, Console& console) {
  const std::filesystem::path file = options.out / "cases.journal";
  Journal journal(file, study.identity(), study.count());
  if (journal.damaged() > 0)
    console.complain(
        fmt::format("{}: {} damaged lines, their cases are run again", file.string(), journal.damaged()));
  if (journal.finished() > 0)
    console.say(fmt::format("goes on from {}: {} cases are there", file.string(), journal.finished()));
  std::optional<SweepHistories> histories;
  if (study.sweep().histories) histories.emplace(study, options.out);
  if (histories && histories->damaged())
    console.complain(fmt::format("{}: is damaged, its cases are run again", histories->file().string()));
  const KeepWhenInterrupted keeping(
      [&] {
        journal.flush();
        return fmt::format("{} finished cases are kept in {}; the same command goes on", journal.finished(),
                           file.string());
      },
      std::nullopt);

  const SweepWorkers workers{
      threads, threads * ranks, leader,
      [&](std::uint64_t index, const std::vector<double>& values) -> std::shared_ptr<void> {
        return std::make_shared<CrashNote>(journal, index, values);
      },
      histories ? &*histories : nullptr};
  const SweepEnd end =
      run_sweep_cases(study, journal, workers,
                      {[&console](const std::string& stage) { console.progress(stage); }, interrupted});
  console.end_progress();
  begin_writing();
  journal.flush();

  if (end.partial)
    console.complain(fmt::format("interrupted: {} cases are finished and kept; the same command goes on",
                                 journal.finished()));
  const SweepAnswers answers = write_answers(study, journal, end, options);
  const auto done = answers.statuses.find("done");
  const std::uint64_t well = done == answers.statuses.end() ? 0 : done->second;
  if (well < answers.finished) {
    console.complain(fmt::format("{} of {} cases have no result; summary.json has the reasons",
                                 answers.finished - well, answers.finished));
  }
  if (histories && !end.partial) histories->join(journal, end.cases);
  if (!options.json) tell(answers, histories && !end.partial, options, console);
  return end.partial || well == 0 ? ExitStatus::solver_stopped : ExitStatus::done;
}

/// The work of every rank but the first.
ExitStatus help(const SweepStudy& study, study::Ranks& ranks, int threads, const CommonOptions& options) {
  std::optional<SweepHistories> histories;
  if (study.sweep().histories) histories.emplace(study, options.out);
  std::optional<Journal> faults;
  std::once_flag opened;
  const auto open = [&] {
    // Of an earlier run: the first rank has taken its cases before it sent any work.
    const std::filesystem::path file = study::rank_journal(options.out / "cases.journal", ranks.rank());
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    try {
      faults.emplace(file, study.identity(), study.count());
    } catch (const std::exception&) {
      // A machine without the folder of the results: a fault is not noted there, and its case is run again.
    }
  };
  study::follow(
      ranks, study.identity(), threads,
      [&](std::uint64_t index, const std::vector<double>& values) {
        std::call_once(opened, open);
        std::optional<CrashNote> note;
        if (faults) note.emplace(*faults, index, values);
        return case_line(study, histories ? &*histories : nullptr, index, values, interrupted);
      },
      interrupted);
  begin_writing();  // the first rank writes; this one waits for it
  return interrupted() ? ExitStatus::solver_stopped : ExitStatus::done;
}

int thread_count(const CommonOptions& options, bool ranks) {
  if (options.threads > 0) return options.threads;
  return ranks ? 1 : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

}  // namespace

ExitStatus run_sweep(const std::filesystem::path& file, const CommonOptions& options, Console& console) {
  const std::unique_ptr<study::Ranks> ranks = options.only_case == 0 ? launched_ranks() : nullptr;
  const int rank = ranks ? ranks->rank() : 0;
  /// Only the first rank prints the message of an interruption.
  std::optional<KeepWhenInterrupted> silent;
  if (rank > 0) silent.emplace([] { return std::string(); }, "");
  std::optional<ResultFolder> folder;  // until all have left: the others keep histories in it
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
  if (rank > 0) return help(*study, *ranks, threads, options);
  const std::vector<std::string> results{"cases.csv", "cases.journal", "histories.h5", "summary.json",
                                         "report.html"};
  if (!ranks || ranks->size() == 1) {
    folder.emplace(options, results);
    return lead(*study, threads, options, nullptr, 1, console);
  }
  std::optional<study::RankLeader> leader;
  leader.emplace(*ranks, study::RankLeader::Settings{.identity = study->identity(), .threads = threads});
  folder.emplace(options, results);
  const ExitStatus status = lead(*study, threads, options, &*leader, ranks->size(), console);
  if (const int lost = leader->lost(); lost > 0) {
    console.complain(
        fmt::format("{} of {} ranks were lost on the way; others ran their cases", lost, ranks->size()));
    leaving.orderly = false;  // who is gone would be waited for
  }
  if (interrupted()) leaving.orderly = false;  // a launcher that ends all ranks does not serve their leave
  leader.reset();
  if (leaving.orderly) return status;
  std::fflush(nullptr);
  base::release_result_folders();
  ::_exit(static_cast<int>(status));
}

}  // namespace snare::app
