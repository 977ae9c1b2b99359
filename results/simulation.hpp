#pragma once

#include "results/motion_record.hpp"
#include "results/watch.hpp"

#include <vector>

namespace snare::results {

/// Runs motions in turn, without checkpoints. Fewer records than motions, the last one unfinished, where `watch` stops it.
[[nodiscard]] std::vector<MotionRecord> simulate_all(const std::vector<scenario::NamedMotion>& motions,
                                                     const Watch& watch = {});

}  // namespace snare::results
