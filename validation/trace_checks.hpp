#pragma once

#include "validation/suite.hpp"

#include <filesystem>
#include <vector>

namespace snare::validation {

/// The tracing on blind sets of the continuous wire, and on measured three-point bending of strands
/// (replicates, not made by this project): CSV files group4_*.csv and group5_*.csv in
/// `measured`/three_point_bending, a check that says it was skipped where they are absent. Takes about half a minute.
[[nodiscard]] std::vector<Check> tracing_checks(const std::filesystem::path& measured);

}  // namespace snare::validation
