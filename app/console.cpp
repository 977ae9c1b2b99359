#include "app/console.hpp"

#include "base/files.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <iostream>

namespace snare::app {

namespace {

std::atomic<bool> interrupt_flag{false};

extern "C" void on_signal(int number) {
  interrupt_flag.store(true);
  std::signal(number, SIG_DFL);  // a second one ends the process
}

}  // namespace

bool interrupted() noexcept {
  return interrupt_flag.load();
}

void catch_interrupts() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

void write_result(const CommonOptions& options, const char* file, const nlohmann::json& result) {
  const std::string text = result.dump(1) + "\n";
  base::write_text(options.out / file, text);
  if (options.json) std::cout << text;
}

Console::Console(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

void Console::say(const std::string& text) {
  if (quiet_) return;
  end_progress();
  const std::scoped_lock lock(mutex_);
  fmt::print(stderr, "{}\n", text);
}

void Console::complain(const std::string& text) {
  end_progress();
  const std::scoped_lock lock(mutex_);
  fmt::print(stderr, "{}\n", text);
}

void Console::progress(const std::string& text) {
  if (quiet_ || !terminal_) return;
  const std::scoped_lock lock(mutex_);
  fmt::print(stderr, "\r\033[K{}", text);
  std::fflush(stderr);
  pending_ = true;
}

void Console::end_progress() {
  const std::scoped_lock lock(mutex_);
  if (!pending_) return;
  fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
  pending_ = false;
}

}  // namespace snare::app
