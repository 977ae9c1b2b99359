#pragma once

#include "results/motion_record.hpp"
#include "scenario/world.hpp"

#include <nlohmann/json.hpp>

#include <vector>

namespace snare::results {

/// summary.json of a motion.                                                                  docs/summary_json.md
[[nodiscard]] nlohmann::json motion_summary(const scenario::Scenario& asked, const FinishedMotion& finished);

/// What a motion has come to: `outcome` of its summary.
[[nodiscard]] nlohmann::json outcome_json(const scenario::WireMotions& motions, const FinishedMotion& run);

}  // namespace snare::results
