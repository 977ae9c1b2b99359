#include "python/work.hpp"

#include "base/inputs.hpp"
#include "base/parallel.hpp"
#include "python/gil.hpp"

#include <fmt/format.h>

#include <unistd.h>

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
  pid_t process = ::getpid();
};

/// Work that has not ended, of this process and of those that it was forked from. Outlives every thread.
struct OpenWork {
  std::mutex mutex;
  std::vector<std::shared_ptr<Work>> all;
};

OpenWork& open_work() {
  static auto* open = new OpenWork;
  return *open;
}

void begin(const std::shared_ptr<Work>& work) {
  const std::scoped_lock lock(open_work().mutex);
  open_work().all.push_back(work);
}

void finish(const std::shared_ptr<Work>& work) {
  const std::scoped_lock lock(open_work().mutex);
  std::erase(open_work().all, work);
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

/// What Python has to say meanwhile: throws py::error_already_set for an interrupt and for what `progress`
/// raises.
void ask_python(Work& work, const py::object& progress) {
  std::optional<std::string> stage;
  {
    const std::scoped_lock lock(work.mutex);
    stage = std::exchange(work.stage, std::nullopt);
  }
  const WithGil gil;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (stage && !progress.is_none()) progress(*stage);
}

}  // namespace

void do_work(const std::function<void(const results::Watch&)>& body, int threads,
             const py::object& progress) {
  constexpr int most_threads = 1024;  // as --threads; what a system does not give would end the process
  if (threads < 0 || threads > most_threads)
    throw std::invalid_argument(fmt::format("threads = {}, must be from 0 to {}", threads, most_threads));
  const auto work = std::make_shared<Work>();
  const WithoutGil released;
  std::thread thread([work, body, threads, inputs = base::current_inputs()] {
    const base::InputScope scope(inputs);
    run(*work, body, threads);
  });
  begin(work);
  try {
    while (!wait(*work, glance_s)) ask_python(*work, progress);
    ask_python(*work, progress);
  } catch (...) {
    work->stop = true;
    if (wait(*work, patience_s)) {
      thread.join();
      finish(work);
    } else {
      thread.detach();
    }
    throw;
  }
  thread.join();
  finish(work);
  if (work->failure) std::rethrow_exception(work->failure);
}

void end_work() {
  constexpr double patience = 5.0;  // [s]
  std::vector<std::shared_ptr<Work>> open;
  {
    const std::scoped_lock lock(open_work().mutex);
    open = open_work().all;
  }
  for (const std::shared_ptr<Work>& work : open) work->stop = true;
  close_work(patience);
  const py::gil_scoped_release release;
  for (const std::shared_ptr<Work>& work : open) {
    if (work->process == ::getpid()) static_cast<void>(wait(*work, patience));
  }
}

}  // namespace snare::python
