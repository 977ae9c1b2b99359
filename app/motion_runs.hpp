#pragma once

#include "app/console.hpp"
#include "results/motion_record.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace snare::app {

using namespace results;

/// Where checkpoints go and to what they belong.
struct CheckpointPolicy {
  std::filesystem::path file;
  std::string input;       ///< text that is equal for equal motions
  double wall_time = 0.0;  ///< least between two that are written [s], >= 0
};

/// Runs motions in turn and shows their progress. After a kill or an interruption the same call continues
/// from the last checkpoint, and ends with the same bits. An interrupted run gives fewer records than
/// motions, the last one unfinished; what has failed is told to the console.
/// docs/decisions/interruption-and-faults.md#checkpoints
[[nodiscard]] std::vector<MotionRecord> run_motions(const std::vector<scenario::NamedMotion>& motions,
                                                    const CheckpointPolicy& policy, Console& console);

/// Worst status of some records.
[[nodiscard]] ExitStatus status_of(const std::vector<MotionRecord>& records);

}  // namespace snare::app
