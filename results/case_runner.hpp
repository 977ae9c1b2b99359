#pragma once

#include "base/toml_tree.hpp"
#include "results/result_table.hpp"
#include "results/watch.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace snare::results {

/// What a case of a study has come to.
struct CaseEnd {
  enum class Status {
    done,
    failed,   ///< the solver could not finish
    refused,  ///< its input is wrong
    stopped,  ///< it was told to stop
    broken    ///< anything else: out of memory, a library that refused
  };
  Status status = Status::done;
  std::string reason;  ///< where it is not done; one line
};

/// Runs a file with some keys overridden, by the code of a verb, and gives what the verb would write as JSON.
/// Nothing is written and nothing printed; any number may run at a time.
class CaseRunner {
 public:
  /// verb: "simulate", "push", "fit", "trace" or "distil"; empty: the first that reads files of this schema.
  /// `asked_by`: the file that names both, for messages. Throws base::InputError.
  CaseRunner(std::filesystem::path file, const std::string& verb, const std::filesystem::path& asked_by);

  /// The verb whose code runs.
  [[nodiscard]] const std::string& verb() const noexcept { return verb_; }
  /// The file that is read.
  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }

  /// Whether its runs have a history: that of motions is history.csv, that of pushes, fits and traces
  /// curves.csv.
  [[nodiscard]] bool has_history() const noexcept { return verb_ != "distil"; }

  /// Reads the file as a case would. Throws base::InputError with everything that is wrong. names: gets the
  /// columns of the history that a case would have, where it has one, and no row.
  void check(const std::vector<base::Override>& overrides, TableSink* names = nullptr) const;

  /// Never throws but std::bad_alloc for the words of a failure. watch: asked often whether the case is to
  /// end. result: set where it is done. history: gets the table of a case that is done, or whose solver could
  /// not finish a motion or a push: as far as it came.
  [[nodiscard]] CaseEnd run(const std::vector<base::Override>& overrides, const Watch& watch,
                            nlohmann::json& result, TableSink* history = nullptr) const;
  /// The same, but throws what reading and computing throw: base::InputError, std::bad_alloc, what a library
  /// has refused.
  [[nodiscard]] CaseEnd run_or_throw(const std::vector<base::Override>& overrides, const Watch& watch,
                                     nlohmann::json& result, TableSink* history = nullptr) const;

 private:
  std::filesystem::path file_;
  std::string verb_;
  bool of_records_ = false;  // in time, which fit and trace read as they read experiments
};

/// Text that is equal for equal contents of a file and of all files that it and these name, in TOML and in
/// URDF. What is missing or cannot be read is passed over: readers complain of it.
[[nodiscard]] std::string contents_of_files(const std::filesystem::path& file);

}  // namespace snare::results
