#include "results/sweep_run.hpp"

#include "base/errors.hpp"
#include "study/case_loop.hpp"
#include "study/rank_journal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <stdexcept>
#include <string>

namespace snare::results {

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
  SweepRun(const SweepStudy& study, Journal& journal, const SweepWorkers& workers, const Watch& watch)
      : study_(study), journal_(journal), workers_(workers), watch_(watch) {}

  /// Cases of a design. Throws what ends all.
  void design() {
    begin();
    run_numbered(study_.count(), [](std::uint64_t) { return true; });
  }

  /// Cases of a refined grid, of which the next ones depend on the last. True when it came to its end.
  bool refined(study::RefinedGrid& grid) {
    begin();
    while (!grid.finished() && !watch_.stopped()) {
      const std::vector<std::uint64_t>& asked = grid.next();
      run_numbered(grid.told() + asked.size(),
                   [&](std::uint64_t k) { return std::ranges::binary_search(asked, k); });
      if (watch_.stopped()) return false;
      std::vector<study::Seen> seen;
      for (const std::uint64_t index : asked) {
        const std::optional<CaseRecord> record = told(index);
        if (!record) throw std::runtime_error("a case has a result that cannot be read back");
        seen.push_back(seen_of(study_, *record));
      }
      grid.tell(std::move(seen));
    }
    return grid.finished();
  }

  /// Cases of a subset simulation, of which the next ones depend on the last. True when it came to its end.
  bool subset(study::SubsetSimulation& simulation) {
    begin();
    while (!simulation.finished() && !watch_.stopped()) {
      const std::uint64_t base = simulation.told();
      const std::vector<std::vector<double>>& asked = simulation.next();
      expect(base + asked.size());
      const auto values = [&](std::uint64_t k) { return study_.sweep().design.values_of_scores(asked[k]); };
      study::Dispatcher dispatcher(
          study::Scheduler(
              {.count = asked.size(), .workers = std::max(1, workers_.all), .chunk_s = chunk_s()},
              [&](std::uint64_t k) { return finished(base + k); }),
          [&](std::uint64_t k, const std::string& line) { keep(base + k, line); }, stop_);
      run(dispatcher, values, [base](std::uint64_t k) { return base + k; });
      if (watch_.stopped()) return false;
      std::vector<std::optional<double>> margins;
      for (std::uint64_t k = 0; k < asked.size(); ++k) {
        const std::optional<CaseRecord> record = told(base + k);
        margins.push_back(record ? study_.margin_of(*record) : std::nullopt);
      }
      simulation.tell(margins);
    }
    return simulation.finished();
  }

  /// No history is missing that was when this began.
  [[nodiscard]] bool whole() const { return again_.empty(); }

 private:
  using Clock = std::chrono::steady_clock;

  /// Threads ask for a case at a time; ranks for half a second's.
  [[nodiscard]] double chunk_s() const { return workers_.leader != nullptr ? 0.5 : 0.0; }

  /// Nothing of the case is to be done any more.
  [[nodiscard]] bool finished(std::uint64_t index) const {
    return journal_.has(index) && !again_.contains(index);
  }

  /// What the journal says of a case.
  [[nodiscard]] std::optional<CaseRecord> told(std::uint64_t index) const {
    const std::optional<std::string> line = journal_.result(index);
    return line ? study::record_of(*line) : std::nullopt;
  }

  void begin() {
    study::take_rank_journals(journal_, study_.identity(), study_.count());
    if (workers_.histories != nullptr) again_ = workers_.histories->missing(journal_);
    before_ = journal_.finished() - again_.size();
    began_ = Clock::now();
    if (const auto line = before_ > 0 ? journal_.result(0) : std::nullopt; line) any_done_ = true;
  }

  /// How many cases there are as far as is known; where one of an earlier round is run again the journal has
  /// more.
  void expect(std::uint64_t cases) { total_ = std::max(cases, journal_.finished()); }

  /// Those of the design's cases that are wanted; `cases`: there are with all before.
  template <class Wanted>
  void run_numbered(std::uint64_t cases, const Wanted& wanted) {
    expect(cases);
    study::Dispatcher dispatcher(
        study::Scheduler(
            {.count = study_.count(), .workers = std::max(1, workers_.all), .chunk_s = chunk_s()},
            [&](std::uint64_t k) { return !wanted(k) || finished(k); }),
        [this](std::uint64_t index, const std::string& line) { keep(index, line); }, stop_);
    run(
        dispatcher, [](std::uint64_t) { return std::vector<double>(); }, [](std::uint64_t k) { return k; });
  }

  template <class Values, class Number>
  void run(study::Dispatcher& dispatcher, const Values& values, const Number& number) {
    const auto run_one = [&](std::uint64_t index, const std::vector<double>& given) {
      const std::shared_ptr<void> held = workers_.around ? workers_.around(index, given) : nullptr;
      return case_line(study_, workers_.histories, index, given, stop_);
    };
    if (workers_.leader != nullptr) {
      workers_.leader->run(
          dispatcher, run_one, values,
          [&](std::uint64_t k) {
            CaseRecord record{"lost", "the process that ran it ended, twice", 0.0, {}, {}};
            if (study_.count() == 0) record.values = values(k);
            return study::line_of(record);
          },
          number(0));
      study::take_rank_journals(journal_, study_.identity(), study_.count());
    } else {
      study::run_cases(dispatcher, workers_.threads,
                       [&](std::uint64_t k) { return run_one(number(k), values(k)); });
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
    if (record->status == "unkept") throw std::runtime_error(record->reason);
    any_done_ = true;
    journal_.append(index, line);
    again_.erase(index);
    if (!record->done()) ++without_;
    const std::uint64_t done = journal_.finished() - again_.size();
    const double elapsed = std::chrono::duration<double>(Clock::now() - began_).count();
    if (elapsed - shown_ < 0.1 && done < total_) return;
    shown_ = elapsed;
    const double share = static_cast<double>(done - before_) /
                         static_cast<double>(std::max<std::uint64_t>(1, total_ - before_));
    watch_.say(fmt::format("{} of {} cases{}, {} to go", done, total_,
                           without_ > 0 ? fmt::format(" ({} without a result)", without_) : "",
                           time_words(elapsed * (1.0 - share) / share)));
  }

  const SweepStudy& study_;
  Journal& journal_;
  const SweepWorkers& workers_;
  const Watch& watch_;
  const std::function<bool()> stop_{[this] { return watch_.stopped(); }};
  std::uint64_t total_ = 0, before_ = 0, without_ = 0;
  std::set<std::uint64_t> again_;  // that the journal has and whose history is missing
  bool any_done_ = false;
  double shown_ = -1.0;
  Clock::time_point began_;
};

}  // namespace

std::string case_line(const SweepStudy& study, const SweepHistories* histories, std::uint64_t index,
                      const std::vector<double>& values, const std::function<bool()>& stop) {
  std::function<void(History&)> keep;
  if (histories != nullptr) keep = [&](History& history) { histories->keep(index, history); };
  return study::line_of(study.run(values.empty() ? study.sweep().design.values(index) : values, stop, keep));
}

SweepEnd run_sweep_cases(const SweepStudy& study, Journal& journal, const SweepWorkers& workers,
                         const Watch& watch) {
  SweepRun run(study, journal, workers, watch);
  SweepEnd end;
  if (study.sweep().refine) {
    study::RefinedGrid grid(study.sweep().refine->grid);
    end.partial = !run.refined(grid) || !run.whole();
    end.cases = study.count();
    if (!end.partial) end.refined = std::move(grid);
    return end;
  }
  if (study.count() > 0) {
    run.design();
    end.cases = study.count();
    end.partial = journal.finished() < study.count() || !run.whole();
    return end;
  }
  study::SubsetSimulation simulation(study.subset_settings());
  end.partial = !run.subset(simulation);
  end.cases = simulation.told() + simulation.next().size();
  if (!end.partial)
    end.subset = {simulation.probability(), simulation.variation(), simulation.interval(),
                  simulation.reached(), simulation.levels()};
  return end;
}

SweepAnswers sweep_answers(const SweepStudy& study, const Journal& journal, const SweepEnd& end) {
  SweepAnswers answers = sweep_answers(study, end.in(journal));
  answers.subset = end.subset;
  answers.interrupted = end.partial;
  return answers;
}

}  // namespace snare::results
