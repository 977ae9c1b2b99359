#include "app/interruption.hpp"

#include "app/exit_status.hpp"
#include "app/standard_streams.hpp"
#include "base/files.hpp"
#include "base/inputs.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <semaphore.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

namespace snare::app {

namespace {

std::atomic<bool> interrupt_flag{false};
sem_t interrupt_came;  // sem_post is one of the few calls that a handler may make

extern "C" void on_signal(int number) {
  interrupt_flag.store(true);
  sem_post(&interrupt_came);
  // A second one ends the process, but for the limit of processor time, of which every further second is
  // reported.
  std::signal(number, number == SIGXCPU ? SIG_IGN : SIG_DFL);
}

/// What is left behind where work is left.
struct Work {
  std::mutex mutex;
  std::condition_variable changed;
  enum class State { working, writing, left } state = State::working;
  std::string stage = "reading the input";
  std::function<std::string()> keep;
  std::string json_schema;
  void (*before_end)() noexcept = nullptr;
};
Work& work() {
  static auto* one = new Work;  // outlives every thread
  return *one;
}

/// Ends the process from the thread that waits. Holds the lock of the work: nothing of it begins to write any
/// more.
[[noreturn]] void leave(Work& w) {
  std::string kept = "nothing was finished, nothing is kept";
  try {
    if (w.keep) kept = w.keep();
  } catch (const std::exception& error) {
    kept = std::string("what was finished cannot be kept: ") + error.what();
  }
  if (!kept.empty())
    tell(fmt::format("{}interrupted while {}: {}\n", isatty(STDERR_FILENO) != 0 ? "\r\033[K" : "", w.stage,
                     kept));
  if (!w.json_schema.empty()) {
    const nlohmann::json word{
        {"schema", w.json_schema}, {"interrupted", true}, {"stage", w.stage}, {"kept", kept}};
    const std::string text = word.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
    [[maybe_unused]] const std::size_t ignored = std::fwrite(text.data(), 1, text.size(), stdout);
  }
  std::fflush(nullptr);
  base::remove_unfinished_files();
  if (w.before_end != nullptr) w.before_end();
  ::_exit(static_cast<int>(ExitStatus::solver_stopped));
}

void wait_for_signals(const std::shared_ptr<base::Inputs>& inputs) {
  const base::InputScope scope(inputs);  // what is kept names them
  while (sem_wait(&interrupt_came) != 0) {
  }
  Work& w = work();
  std::unique_lock lock(w.mutex);
  const auto patience = std::chrono::duration<double>(patience_s);
  if (w.changed.wait_for(lock, patience, [&] { return w.state == Work::State::writing; })) return;
  w.state = Work::State::left;
  leave(w);
}

}  // namespace

bool interrupted() noexcept {
  return interrupt_flag.load();
}

void catch_interrupts(void (*before_end)() noexcept) {
  work().before_end = before_end;
  sem_init(&interrupt_came, 0, 0);
  std::thread(wait_for_signals, base::current_inputs()).detach();
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGXCPU}) {
    const auto before = std::signal(number, on_signal);
    if (number == SIGHUP && before == SIG_IGN) std::signal(number, SIG_IGN);  // started by nohup
  }
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

void set_stage(const std::string& stage) {
  const std::scoped_lock lock(work().mutex);
  work().stage = stage;
}

KeepWhenInterrupted::KeepWhenInterrupted(std::function<std::string()> keep,
                                         std::optional<std::string> json_schema) {
  const std::scoped_lock lock(work().mutex);
  keep_before_ = std::exchange(work().keep, std::move(keep));
  schema_before_ = work().json_schema;
  if (json_schema) work().json_schema = *std::move(json_schema);
}

KeepWhenInterrupted::~KeepWhenInterrupted() {
  const std::scoped_lock lock(work().mutex);
  work().keep = std::move(keep_before_);
  work().json_schema = std::move(schema_before_);
}

void begin_writing() {
  Work& w = work();
  std::unique_lock lock(w.mutex);
  if (w.state == Work::State::left)
    w.changed.wait(lock, [] { return false; });  // the process is about to end
  w.state = Work::State::writing;
  w.changed.notify_all();
}

}  // namespace snare::app
