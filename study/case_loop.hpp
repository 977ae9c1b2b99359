#pragma once

#include "study/scheduler.hpp"

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace snare::study {

/// A scheduler that any thread may ask, and where results go.
class Dispatcher {
 public:
  /// finished: called with the results, one at a time. What it throws ends all and comes out of `rethrow`.
  /// stop: looked at before anything is handed out.
  Dispatcher(Scheduler scheduler,
             std::function<void(std::uint64_t index, const std::string& result)> finished,
             std::function<bool()> stop);

  /// Cases for a worker; empty: there are no more.
  [[nodiscard]] std::vector<std::uint64_t> take(int worker);
  void report(int worker, std::uint64_t index, const std::string& result, double seconds);
  /// given_up: result of a case that is not handed out again.
  void lost(int worker, const std::function<std::string(std::uint64_t index)>& given_up);
  /// Ends all with the exception that is being handled.
  void fail();

  /// Was stopped, or has failed.
  [[nodiscard]] bool ended() const { return failed_.load() || (stop_ && stop_()); }
  /// Nothing more will be handed out: everything is done, or it has ended.
  [[nodiscard]] bool over() const;
  void rethrow() const;

 private:
  mutable std::mutex mutex_;
  Scheduler scheduler_;
  std::function<void(std::uint64_t, const std::string&)> finished_;
  std::function<bool()> stop_;
  std::atomic<bool> failed_{false};
  std::exception_ptr failure_;
};

/// Runs a case; its result in one line. Must not throw.
using RunCase = std::function<std::string(std::uint64_t index)>;

/// What a thread does that finds nothing to take. wait: others have cases that may come back, so that this is
/// not the end.
enum class Idle { leave, wait };

/// Runs cases on threads of this machine until nothing is left to take. A case that ran while everything
/// ended is not reported.
void run_cases(Dispatcher& dispatcher, int threads, const RunCase& run, Idle idle = Idle::leave);

/// What a case gave, and how long that took.
struct TimedResult {
  std::string result;    ///< one line; empty: it was stopped before
  double seconds = 0.0;  ///< [s]
};

/// Runs a few given cases on threads of this machine; results in their order.
[[nodiscard]] std::vector<TimedResult> run_list(std::size_t count, int threads,
                                                const std::function<std::string(std::size_t)>& run,
                                                const std::function<bool()>& stop);

}  // namespace snare::study
