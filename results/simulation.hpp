#pragma once

#include "results/motion_record.hpp"
#include "results/watch.hpp"

#include <nlohmann/json_fwd.hpp>

#include <vector>

namespace snare::results {

/// Runs motions in turn, without checkpoints. Fewer records than motions, the last one unfinished, where
/// `watch` stops it.
[[nodiscard]] std::vector<MotionRecord> simulate_all(const std::vector<scenario::NamedMotion>& motions,
                                                     const Watch& watch = {});

/// summary.json of a scenario whose first runs have these records, at least one: the summary of the first
/// run, warnings, and whether the watch has left a part undone.
/// docs/summary_json.md
[[nodiscard]] nlohmann::json simulation_document(const scenario::Scenario& asked,
                                                 const std::vector<MotionRecord>& records,
                                                 const Watch& watch = {});

}  // namespace snare::results
