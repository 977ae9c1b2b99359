#pragma once

#include "coupling/motion.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace snare::app {

/// How far a scenario of kind "contact" has come.
struct ContactProgress {
  /// A model that has been run.
  struct Model {
    std::vector<coupling::MotionSample> samples;
    coupling::MotionResult result;
  };
  std::vector<Model> finished;
  std::vector<coupling::MotionSample> samples;  ///< of the model at hand, up to its state
  std::optional<coupling::MotionState> state;   ///< of the model at hand; none before its first checkpoint
};

/// Writes a checkpoint; the file is either the old one or the new one at any time. `input`: what the progress belongs to.
/// A failure of the system throws std::system_error.
void write_contact_checkpoint(const std::filesystem::path& file, const std::string& input, ContactProgress& progress);

/// What a checkpoint says, or why it is of no use.
struct LoadedCheckpoint {
  std::optional<ContactProgress> progress;
  std::string refusal;  ///< empty also where there is no file
};

/// Reads a checkpoint that belongs to this input; never throws for what is in the file.
[[nodiscard]] LoadedCheckpoint read_contact_checkpoint(const std::filesystem::path& file, const std::string& input);

}  // namespace snare::app
