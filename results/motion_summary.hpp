#pragma once

#include "results/motion_record.hpp"
#include "scenario/world.hpp"

#include <nlohmann/json.hpp>

#include <functional>
#include <vector>

namespace snare::results {

/// summary.json of a motion. stop: asked while the modes of a coarser mesh are looked for, where they were
/// asked for; true: they are left out.
/// docs/summary_json.md
[[nodiscard]] nlohmann::json motion_summary(const scenario::Scenario& asked, const FinishedMotion& finished,
                                            const std::function<bool()>& stop = {});

/// What a motion has come to: `outcome` of its summary.
[[nodiscard]] nlohmann::json outcome_json(const scenario::WireMotions& motions, const FinishedMotion& run);

}  // namespace snare::results
