#pragma once

#include "scenario/motion_reader.hpp"
#include "base/toml_tree.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace snare::scenario {

/// Any bodies with any shapes among any wires: scenario of kind "contact" that lists them.     docs/scenario_file.md
struct MotionScenario {
  std::string title, source;
  std::filesystem::path file;
  std::string input;  ///< canonical text of everything that was read, meshes too: equal for equal scenarios
  coupling::Motion motion;  ///< one contact for every shape and every wire that it may touch, named "SHAPE on WIRE"
  coupling::MotionOptions options;
  MotionOutput output;
};

/// Whether a scenario lists its bodies instead of having one [body], one [wire] and one [pusher]. Throws InputError when the file cannot be
/// read.
[[nodiscard]] bool lists_bodies(const std::filesystem::path& file, const std::vector<base::Override>& overrides);

/// Reads a scenario and the meshes beside it; throws InputError with everything that is wrong in it.
[[nodiscard]] MotionScenario read_motion_scenario(const std::filesystem::path& file,
                                                  const std::vector<base::Override>& overrides = {});

}  // namespace snare::scenario
