#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace snare::base {

/// One thing that is wrong with what the user gave.
///
/// Printed as `data/x.toml:12: wire.diameter_mm = -1.5, must be > 0`; parts that are empty (or a line
/// of 0) are left out.
struct InputProblem {
  std::string file;         ///< as the user named it; empty when the input is not a file
  int line = 0;             ///< 1-based; 0 when unknown
  std::string key;          ///< dotted key, e.g. "wire.diameter_mm", or a column name
  std::string value;        ///< offending value as it was written; empty when it is missing
  std::string requirement;  ///< what is allowed, e.g. "must be > 0"

  /// The problem in one line, as above.
  [[nodiscard]] std::string message() const;
};

/// The input is wrong. Carries every problem found, not the first only; `what()` has one per line.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<InputProblem> problems);
  explicit InputError(InputProblem problem);

  /// Every problem, in the order in which they were given.
  [[nodiscard]] const std::vector<InputProblem>& problems() const noexcept { return problems_; }

 private:
  std::vector<InputProblem> problems_;
};

/// A library below us refused. `function` is the library's name for the call, `code` its return code.
class LibraryError : public std::runtime_error {
 public:
  LibraryError(const std::string& function, int code, const std::string& meaning);

  /// What the call returned: a number of the library's own.
  [[nodiscard]] int code() const noexcept { return code_; }

 private:
  int code_;
};

}  // namespace snare::base
