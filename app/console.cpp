#include "app/console.hpp"

#include "app/interruption.hpp"
#include "app/standard_streams.hpp"
#include "base/files.hpp"
#include "base/one_line.hpp"
#include "results/inputs.hpp"

#include <nlohmann/json.hpp>

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace snare::app {

void write_result(const CommonOptions& options, const char* file, const nlohmann::json& result) {
  const std::string text = results::with_inputs(result).dump(1) + "\n";
  base::write_text(options.out / file, text);
  if (options.json) print(text);
}

void print_result(const nlohmann::json& result) {
  print(results::with_inputs(result).dump(1) + "\n");
}

void print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw std::system_error(errno, std::generic_category(), "standard output: cannot be written");
}

Console::Console(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

void Console::say(const std::string& text) {
  if (quiet_) return;
  end_progress();
  const std::scoped_lock lock(mutex_);
  tell(base::visible_lines(text) + "\n");
}

void Console::complain(const std::string& text) {
  end_progress();
  const std::scoped_lock lock(mutex_);
  tell(base::visible_lines(text) + "\n");
}

void Console::progress(const std::string& stage) {
  const std::string text = base::visible(stage);
  set_stage(text);
  if (quiet_) return;
  const std::scoped_lock lock(mutex_);
  if (!terminal_) {
    const auto now = std::chrono::steady_clock::now();
    if (std::chrono::duration<double>(now - told_).count() < told_every_s) return;
    told_ = now;
    tell(text + "\n");
    return;
  }
  tell("\r\033[K" + text);
  pending_ = true;
}

void Console::end_progress() {
  const std::scoped_lock lock(mutex_);
  if (!pending_) return;
  tell("\r\033[K");
  pending_ = false;
}

}  // namespace snare::app
