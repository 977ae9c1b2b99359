#pragma once

#include "validation/suite.hpp"

#include <filesystem>
#include <vector>

namespace snare::validation {

/// Records in time that others have measured and published, traced: the order of the published errors, the
/// effects, records held out. Takes a minute or two. `shipped`: folder with records/emps.toml and
/// pendulum.toml; `measured`: folder with emps/ and pendulum/; where a file is not there, its check says so
/// and is skipped.
[[nodiscard]] std::vector<Check> record_checks(const std::filesystem::path& shipped,
                                               const std::filesystem::path& measured);

}  // namespace snare::validation
