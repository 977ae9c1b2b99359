#pragma once

#include "app/exit_status.hpp"

#include <nlohmann/json_fwd.hpp>

#include <chrono>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

namespace snare::app {

/// Options that every verb has.
struct CommonOptions {
  std::filesystem::path out;           ///< folder of the results
  int threads = 0;                     ///< 0: one a processor
  std::vector<std::string> overrides;  ///< "key=value"
  bool quiet = false;
  bool json = false;                 ///< the result on standard output
  unsigned long long only_case = 0;  ///< of a sweep: this case alone, from 1; 0: all
  std::string only_named;            ///< of a benchmark: this case alone; empty: all
  std::filesystem::path against;     ///< of a benchmark: a history that is scored on the case; empty: none
  bool archive = false;              ///< of a benchmark: its references are made anew
  std::string command;               ///< the verb and its file, as a message names them: "snare push x.toml"
};

inline constexpr double told_every_s = 10.0;

/// What the command says to a person, on standard error: messages and progress.
class Console {
 public:
  explicit Console(bool quiet);

  void say(const std::string& text);
  void complain(const std::string& text);
  /// What is doubtful about a result; it stands in the result, too.
  void warn(const std::string& text) { say("warning: " + text); }
  /// Progress: in one line that is overwritten, or where standard error is no terminal in a line every
  /// `told_every_s`, for a log. Also the stage of an interruption.
  void progress(const std::string& text);
  void end_progress();

 private:
  std::mutex mutex_;
  bool quiet_;
  bool terminal_;
  bool pending_ = false;
  std::chrono::steady_clock::time_point told_ =
      std::chrono::steady_clock::now();  ///< when progress was told to a log
};

/// Writes a result into its file in the folder of the results, and to standard output where that is asked
/// for: the last thing that a verb writes.
void write_result(const CommonOptions& options, const char* file, const nlohmann::json& result);

/// The same of a verb that writes it into no file.
void print_result(const nlohmann::json& result);

/// Text on standard output, down to where the system takes it. Throws std::system_error.
void print(const std::string& text);

}  // namespace snare::app
