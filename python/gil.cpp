#include "python/gil.hpp"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace snare::python {

namespace {

// Atomic numbers alone: a process that forks takes no locked mutex with it.
std::atomic<int> working{0};    // threads without the GIL
std::atomic<pid_t> process{0};  // to which they belong
std::atomic<bool> is_closing{false};
std::atomic<std::thread::id> closer{};

/// The threads of a parent process are not those of its child.
void count(int change) {
  if (process.exchange(::getpid()) != ::getpid()) working = 0;
  working += change;
}

/// Within WithoutGil.
void hold_if_closing() {
  if (!closing()) return;
  count(-1);
  for (;;) ::pause();
}

}  // namespace

WithoutGil::WithoutGil() : state_(PyEval_SaveThread()) {
  count(1);
}

WithoutGil::~WithoutGil() noexcept(false) {
  hold_if_closing();
  PyEval_RestoreThread(state_);
  count(-1);
}

WithGil::WithGil() {
  hold_if_closing();
  state_ = PyGILState_Ensure();
}

WithGil::~WithGil() noexcept(false) {
  PyGILState_Release(state_);
}

bool closing() noexcept {
  return is_closing && closer.load() != std::this_thread::get_id();
}

void close_work(double patience_s) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds glance{5};
  closer = std::this_thread::get_id();
  is_closing = true;
  PyThreadState* state = PyEval_SaveThread();
  const Clock::time_point end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(patience_s));
  while (process == ::getpid() && working > 0 && Clock::now() < end) std::this_thread::sleep_for(glance);
  PyEval_RestoreThread(state);
}

}  // namespace snare::python
