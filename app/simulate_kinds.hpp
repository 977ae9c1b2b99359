#pragma once

#include "app/console.hpp"

#include <filesystem>

namespace snare::app {

/// Kinds of scenario, one a file. Each reads its scenario, runs it and writes history.csv, summary.json, report.html.
/// A contact scenario with lists of bodies, wires and shapes.
[[nodiscard]] ExitStatus simulate_bodies(const std::filesystem::path& file, const CommonOptions& options, Console& console);
[[nodiscard]] ExitStatus simulate_contact(const std::filesystem::path& file, const CommonOptions& options, Console& console);
[[nodiscard]] ExitStatus simulate_arm_contact(const std::filesystem::path& file, const CommonOptions& options,
                                              Console& console);
[[nodiscard]] ExitStatus simulate_arm(const std::filesystem::path& file, const CommonOptions& options, Console& console);

}  // namespace snare::app
