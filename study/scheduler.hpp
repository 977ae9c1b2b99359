#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <vector>

namespace snare::study {

/// Hands out the cases of a study to workers: threads, or processes on other machines. Pure bookkeeping: it
/// knows neither, and its callers pass the time.
/// docs/decisions/sweeps.md#cases-journal-and-ranks
///
/// A worker gets so many cases at a time that it comes back after about `chunk_s`, fewer towards the end.
/// Cases that a lost worker had not reported are handed out again one by one; one that two workers were lost
/// with is given up.
class Scheduler {
 public:
  struct Settings {
    std::uint64_t count = 0;
    int workers = 1;
    double chunk_s = 0.5;          ///< work handed out at a time [s]; 0: one case
    std::uint64_t largest = 4096;  ///< cases handed out at a time
  };
  /// has: whether a case is finished already.
  Scheduler(const Settings& settings, std::function<bool(std::uint64_t)> has);

  /// The next cases for a worker that has none; empty: there is nothing to do for now.
  [[nodiscard]] std::vector<std::uint64_t> take(int worker);
  /// A worker has finished one of its cases in `seconds`.
  void finished(int worker, std::uint64_t index, double seconds);
  /// A worker will not come back. Returns the cases that are given up.
  [[nodiscard]] std::vector<std::uint64_t> lost(int worker);

  /// Nothing is left to hand out and nothing is out.
  [[nodiscard]] bool done() const noexcept { return out_.empty() && again_.empty() && at_end(); }

 private:
  [[nodiscard]] bool at_end() const noexcept { return next_ >= settings_.count; }
  void skip_finished();

  Settings settings_;
  std::function<bool(std::uint64_t)> has_;
  std::uint64_t next_ = 0;                         // not yet handed out, nor any after it
  std::deque<std::uint64_t> again_;                // of lost workers
  std::map<int, std::vector<std::uint64_t>> out_;  // what workers have, in their order
  std::map<std::uint64_t, int> lost_with_;         // how often a case's worker was lost
  double seconds_ = 0.0;                           // of the finished cases
  std::uint64_t timed_ = 0;
};

}  // namespace snare::study
