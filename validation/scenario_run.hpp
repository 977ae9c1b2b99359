#pragma once

#include "scenario/scenario.hpp"
#include "validation/suite.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace snare::validation {

/// A run of a shipped composed scenario with some of its keys changed.
struct ScenarioRun {
  scenario::NamedMotion asked;
  coupling::MotionResult result;
  coupling::MotionSample last;  ///< as given to the observer at the last output time
  /// 0, or a value that makes its row fail: added to what is compared.
  [[nodiscard]] double usable() const { return result.report.usable() ? 0.0 : not_computed; }
};

/// The motion of a file, not yet run. settings: `key=value`, as for `--set`.
[[nodiscard]] scenario::NamedMotion motion_of(const std::filesystem::path& file,
                                              const std::vector<std::string>& settings);
/// Runs a motion; `each` is told every sample.
[[nodiscard]] ScenarioRun run_motion(scenario::NamedMotion asked,
                                     const std::function<void(const coupling::MotionSample&)>& each = {});
[[nodiscard]] ScenarioRun run_of(const std::filesystem::path& file, const std::vector<std::string>& settings,
                                 const std::function<void(const coupling::MotionSample&)>& each = {});

/// Time of the first touch of a contact [s]; `not_computed` without one.
[[nodiscard]] double first_touch(const coupling::MotionResult& result, int contact);

/// Puts strings instead of the wires of a snare called "snare".
inline const std::string as_strings = "snares[snare].wire.model=\"stretched\"";

}  // namespace snare::validation
