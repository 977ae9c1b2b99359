#include "study/case_loop.hpp"

#include "base/inputs.hpp"

#include <omp.h>

#include <chrono>
#include <thread>
#include <utility>

namespace snare::study {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

}  // namespace

Dispatcher::Dispatcher(Scheduler scheduler, std::function<void(std::uint64_t, const std::string&)> finished,
                       std::function<bool()> stop)
    : scheduler_(std::move(scheduler)), finished_(std::move(finished)), stop_(std::move(stop)) {}

std::vector<std::uint64_t> Dispatcher::take(int worker) {
  if (ended()) return {};
  const std::scoped_lock lock(mutex_);
  return scheduler_.take(worker);
}

void Dispatcher::report(int worker, std::uint64_t index, const std::string& result, double seconds) {
  const std::scoped_lock lock(mutex_);
  if (failed_) return;
  try {
    finished_(index, result);
  } catch (...) {
    failure_ = std::current_exception();
    failed_ = true;
    return;
  }
  scheduler_.finished(worker, index, seconds);
}

void Dispatcher::lost(int worker, const std::function<std::string(std::uint64_t)>& given_up) {
  const std::scoped_lock lock(mutex_);
  for (const std::uint64_t index : scheduler_.lost(worker)) finished_(index, given_up(index));
}

void Dispatcher::fail() {
  const std::scoped_lock lock(mutex_);
  if (!failure_) failure_ = std::current_exception();
  failed_ = true;
}

bool Dispatcher::over() const {
  if (ended()) return true;
  const std::scoped_lock lock(mutex_);
  return scheduler_.done();
}

void Dispatcher::rethrow() const {
  const std::scoped_lock lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

void run_cases(Dispatcher& dispatcher, int threads, const RunCase& run, Idle idle) {
  const std::shared_ptr<base::Inputs> inputs = base::current_inputs();
#pragma omp parallel num_threads(threads)
  {
    const base::InputScope scope(inputs);
    const int worker = omp_get_thread_num();
    try {
      while (!dispatcher.ended()) {
        const std::vector<std::uint64_t> mine = dispatcher.take(worker);
        if (mine.empty()) {
          if (idle == Idle::leave || dispatcher.over()) break;
          std::this_thread::sleep_for(std::chrono::milliseconds(2));
          continue;
        }
        for (const std::uint64_t index : mine) {
          if (dispatcher.ended()) break;
          const auto begin = Clock::now();
          const std::string result = run(index);
          if (dispatcher.ended()) break;  // it may have been stopped by the same
          dispatcher.report(worker, index, result, seconds_since(begin));
        }
      }
    } catch (...) {  // an exception must not leave the threads
      dispatcher.fail();
    }
  }
}

std::vector<TimedResult> run_list(std::size_t count, int threads,
                                  const std::function<std::string(std::size_t)>& run,
                                  const std::function<bool()>& stop) {
  std::vector<TimedResult> results(count);
  std::atomic<std::size_t> next{0};
  const std::shared_ptr<base::Inputs> inputs = base::current_inputs();
#pragma omp parallel num_threads(threads)
  {
    const base::InputScope scope(inputs);
    for (std::size_t k = next++; k < count && !stop(); k = next++) {
      const auto begin = Clock::now();
      std::string result;
      try {
        result = run(k);
      } catch (...) {  // run must not throw; a case without a result is run again
        result.clear();
      }
      if (stop()) break;
      results[k] = {std::move(result), seconds_since(begin)};
    }
  }
  return results;
}

}  // namespace snare::study
