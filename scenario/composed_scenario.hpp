#pragma once

#include "base/toml_reader.hpp"
#include "scenario/world.hpp"

#include <filesystem>
#include <string_view>

namespace snare::scenario {

/// What the first line of a scenario says whose file lists what there is.
inline constexpr std::string_view composed_schema = "snare-scenario/2";

/// Reads a scenario that lists what there is, with all files beside it in `folder`, and finishes the document. One run.
///                                                                                           docs/scenario_file.md
[[nodiscard]] WireMotions read_composition(base::TomlDocument& document, const std::filesystem::path& folder);

}  // namespace snare::scenario
