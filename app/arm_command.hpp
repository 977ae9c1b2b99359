#pragma once

#include "app/console.hpp"

#include <filesystem>
#include <string>

namespace snare::app {

/// `snare arm show FILE`: chain, masses, reach, and natural frequencies in a pose, on standard output.
/// pose: name of a pose of the file, angles in degrees separated by commas, or empty for all joints at zero.
[[nodiscard]] ExitStatus run_arm_show(const std::filesystem::path& file, const std::string& pose,
                                      const CommonOptions& options, Console& console);

}  // namespace snare::app
