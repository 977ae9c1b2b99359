#pragma once

#include "base/errors.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace snare::coupling {

/// Collects what is wrong with a motion.
class Complaints {
 public:
  /// Whether it is fine; if not, remembers key, value (in the unit of the key) and requirement.
  bool require(bool fine, const std::string& key, double value, const std::string& requirement) {
    if (!fine) problems_.push_back({"", 0, key, fmt::format("{}", value), requirement});
    return fine;
  }
  /// Throws InputError with all of them, if any.
  void raise() const {
    if (!problems_.empty()) throw base::InputError(problems_);
  }

 private:
  std::vector<base::InputProblem> problems_;
};

}  // namespace snare::coupling
