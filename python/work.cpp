#include "python/work.hpp"

#include "base/inputs.hpp"
#include "base/parallel.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace snare::python {

namespace py = pybind11;

namespace {

/// Shared by the thread that works and the one that waits.
struct Work {
  std::mutex mutex;
  std::condition_variable changed;
  bool done = false;
  std::exception_ptr failure;
  std::optional<std::string> stage;  // not told yet
  std::atomic<bool> stop{false};
};

std::vector<std::shared_ptr<Work>>& left_work() {
  static auto* all = new std::vector<std::shared_ptr<Work>>;  // outlives every thread
  return *all;
}

void run(Work& work, const std::function<void(const results::Watch&)>& body, int threads) {
  std::exception_ptr failure;
  try {
    base::set_thread_count(threads);  // of the loops that this thread begins
    body({[&work](const std::string& stage) {
            const std::scoped_lock lock(work.mutex);
            work.stage = stage;
          },
          [&work] { return work.stop.load(); }});
  } catch (...) {
    failure = std::current_exception();
  }
  const std::scoped_lock lock(work.mutex);
  work.failure = failure;
  work.done = true;
  work.changed.notify_all();
}

bool wait(Work& work, double seconds) {
  std::unique_lock lock(work.mutex);
  return work.changed.wait_for(lock, std::chrono::duration<double>(seconds), [&work] { return work.done; });
}

/// What Python has to say meanwhile: throws py::error_already_set for an interrupt and for what `progress` raises.
void ask_python(Work& work, const py::object& progress) {
  std::optional<std::string> stage;
  {
    const std::scoped_lock lock(work.mutex);
    stage = std::exchange(work.stage, std::nullopt);
  }
  const py::gil_scoped_acquire gil;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (stage && !progress.is_none()) progress(*stage);
}

}  // namespace

void do_work(const std::function<void(const results::Watch&)>& body, int threads, const py::object& progress) {
  constexpr int most_threads = 1024;  // as --threads; what a system does not give would end the process
  if (threads < 0 || threads > most_threads)
    throw std::invalid_argument(fmt::format("threads = {}, must be from 0 to {}", threads, most_threads));
  const auto work = std::make_shared<Work>();
  const py::gil_scoped_release release;
  std::thread thread([work, body, threads, inputs = base::current_inputs()] {
    const base::InputScope scope(inputs);
    run(*work, body, threads);
  });
  try {
    while (!wait(*work, glance_s)) ask_python(*work, progress);
    ask_python(*work, progress);
  } catch (...) {
    work->stop = true;
    if (wait(*work, patience_s)) {
      thread.join();
    } else {
      thread.detach();
      const py::gil_scoped_acquire gil;
      left_work().push_back(work);
    }
    throw;
  }
  thread.join();
  if (work->failure) std::rethrow_exception(work->failure);
}

void wait_for_left_work() {
  constexpr double patience = 5.0;  // [s]
  const py::gil_scoped_release release;
  for (const std::shared_ptr<Work>& work : left_work()) static_cast<void>(wait(*work, patience));
}

}  // namespace snare::python
