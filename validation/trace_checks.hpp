#pragma once

#include "identification/tracing/trace.hpp"
#include "validation/blind_set.hpp"
#include "validation/suite.hpp"

#include <filesystem>
#include <vector>

namespace snare::validation {

/// Whether a trace is right about a cause that the catalogue does not have, "damage" or "drift": nothing is
/// named, or a drift of another shape in time as a drift.
[[nodiscard]] bool is_right_outside(const BlindSet& set, const identification::Trace& trace);

/// The tracing on blind sets of the continuous wire, and on measured three-point bending of strands
/// (replicates, not made by this project): CSV files group4_*.csv and group5_*.csv in
/// `measured`/three_point_bending, a check that says it was skipped where they are absent. Takes about half a
/// minute.
[[nodiscard]] std::vector<Check> tracing_checks(const std::filesystem::path& measured);

}  // namespace snare::validation
