#pragma once

#include "app/console.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace snare::app {

/// What `snare export` is asked for.
struct ExportOptions {
  std::filesystem::path law;          ///< law.json
  std::filesystem::path mujoco;       ///< model that takes the law
  std::string body;                   ///< of the model
  std::optional<double> position_mm;  ///< along the span; none: the law position nearest to mid-span
  std::optional<double> slack_mm;     ///< none: that of the wire
  /// Of the push in the frame of the body, three numbers; empty: its slide joint's, else y.
  std::string axis;
  std::string point_mm;  ///< that meets the wire, in the frame of the body, three numbers; empty: its origin
  double first_touch_mm = 0.0;  ///< travel from the pose of the model to first touch
  int number = 1;               ///< of the case in law.json
};

/// A law of a wire on a body of a user's model: law_mujoco.xml, law_mujoco_linear.xml and, where the wire
/// dissipates, law_mujoco_loop.xml. Throws base::InputError for wrong input, before anything is written.
[[nodiscard]] ExitStatus run_export(const ExportOptions& asked, const CommonOptions& options,
                                    Console& console);

}  // namespace snare::app
