#pragma once

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

namespace snare::app {

/// Exit statuses of the command.
enum class ExitStatus : int { done = 0, failure = 1, wrong_input = 2, solver_stopped = 3, row_out_of_limit = 4 };

/// Options that every verb has.
struct CommonOptions {
  std::filesystem::path out;           ///< folder of the results
  int threads = 0;                     ///< 0: one a processor
  std::vector<std::string> overrides;  ///< "key=value"
  bool quiet = false;
  bool json = false;  ///< the result on standard output
};

/// What the command says to a person, on standard error: messages, and progress on a terminal.
class Console {
 public:
  explicit Console(bool quiet);

  void say(const std::string& text);
  void complain(const std::string& text);
  /// Progress in one line that is overwritten; nothing where standard error is no terminal.
  void progress(const std::string& text);
  void end_progress();

 private:
  std::mutex mutex_;
  bool quiet_;
  bool terminal_;
  bool pending_ = false;
};

/// Writes a result into its file in the folder of the results, and to standard output where that is asked for.
void write_result(const CommonOptions& options, const char* file, const nlohmann::json& result);

/// Set by SIGINT and SIGTERM: long work stops at its next point and keeps what it has.
[[nodiscard]] bool interrupted() noexcept;
void catch_interrupts();

}  // namespace snare::app
