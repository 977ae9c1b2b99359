#pragma once

#include "results/sweep_answers.hpp"
#include "results/sweep_histories.hpp"
#include "results/watch.hpp"
#include "study/rank_work.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace snare::results {

/// Who runs the cases of a sweep.
struct SweepWorkers {
  int threads = 1;                      ///< of this process
  int all = 1;                          ///< threads of all processes
  study::RankLeader* leader = nullptr;  ///< of other processes; none: this one alone
  /// Held while a thread runs the case with this number in the journal; values: of a subset simulation, else
  /// none.
  std::function<std::shared_ptr<void>(std::uint64_t index, const std::vector<double>& values)> around{};
  /// Where histories are kept; none where the sweep keeps none.
  const SweepHistories* histories = nullptr;
};

/// Runs one case by its number in the journal and keeps its history; the line of its record. values: of a
/// subset simulation, in the units of their keys, else none. Never throws.
[[nodiscard]] std::string case_line(const SweepStudy& study, const SweepHistories* histories,
                                    std::uint64_t index, const std::vector<double>& values,
                                    const std::function<bool()>& stop);

/// How far a sweep has come.
struct SweepEnd {
  bool partial = false;                       ///< not all cases are in the journal
  std::uint64_t cases = 0;                    ///< there are, as far as is known
  std::optional<SubsetAnswer> subset;         ///< of a subset simulation that came to its end
  std::optional<study::RefinedGrid> refined;  ///< that came to its end

  /// The cases of that end, by the journal of the sweep.
  [[nodiscard]] SweepCases in(const study::Journal& journal) const {
    return {journal, cases, refined ? &*refined : nullptr};
  }
};

/// Runs the cases that the journal does not have yet, and those whose history is missing, and appends them.
/// Throws base::InputError when a field that is to be collected is not in the first result,
/// std::runtime_error when a history cannot be kept, and what the journal throws; then what was appended is
/// there.
[[nodiscard]] SweepEnd run_sweep_cases(const SweepStudy& study, study::Journal& journal,
                                       const SweepWorkers& workers, const Watch& watch);

/// What the cases in the journal say together, a sweep that is not at its end included.
[[nodiscard]] SweepAnswers sweep_answers(const SweepStudy& study, const study::Journal& journal,
                                         const SweepEnd& end);

}  // namespace snare::results
