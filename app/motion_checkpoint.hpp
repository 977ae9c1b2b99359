#pragma once

#include "results/motion_record.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace snare::app {

using namespace results;

/// How far some motions have come.                                                      theory.md (M.13)
struct MotionProgress {
  std::vector<MotionRecord> finished;
  std::vector<coupling::MotionSample> samples;  ///< of the motion at hand, up to its state
  std::optional<coupling::MotionState> state;   ///< of the motion at hand; none before its first checkpoint
};

/// Writes a checkpoint; the file is either the old one or the new one at any time. `input`: what the progress
/// belongs to. A failure of the system throws std::system_error.
void write_motion_checkpoint(const std::filesystem::path& file, const std::string& input,
                             MotionProgress& progress);

/// What a checkpoint says, or why it is of no use.
struct LoadedCheckpoint {
  std::optional<MotionProgress> progress;
  std::string refusal;  ///< empty also where there is no file
};

/// Reads a checkpoint that belongs to this input; never throws for what is in the file.
[[nodiscard]] LoadedCheckpoint read_motion_checkpoint(const std::filesystem::path& file,
                                                      const std::string& input);

}  // namespace snare::app
