#pragma once

#include "app/commands.hpp"

namespace snare::app {

/// A scenario with every model of its wires, the full one first: compare.json, report.html.
[[nodiscard]] ExitStatus compare_motions(const std::filesystem::path& file, const CommonOptions& options,
                                         Console& console);

}  // namespace snare::app
