#pragma once

#include "results/motion_record.hpp"
#include "scenario/world.hpp"

#include <nlohmann/json.hpp>

#include <vector>

namespace snare::results {

/// summary.json of motions with wires.                                                        docs/summary_json.md
[[nodiscard]] nlohmann::json motion_summary(const scenario::Scenario& asked, const scenario::WireMotions& motions,
                                            const std::vector<FinishedMotion>& finished);

/// summary.json of an arm alone.
[[nodiscard]] nlohmann::json arm_summary(const scenario::Scenario& asked, const scenario::ArmMotion& motion,
                                         const ArmRecord& record);

/// What a composed scenario has come to: `outcome` of its summary.
[[nodiscard]] nlohmann::json outcome_json(const scenario::WireMotions& motions, const FinishedMotion& run);

}  // namespace snare::results
