#pragma once

#include "base/toml_tree.hpp"
#include "scenario/world.hpp"

#include <filesystem>
#include <vector>

namespace snare::scenario {

/// Reads a scenario and the files that it names; throws InputError with everything that is wrong in them. A
/// file of the older schema is refused with what to change in it.
[[nodiscard]] Scenario read_scenario(const std::filesystem::path& file,
                                     const std::vector<base::Override>& overrides = {});

}  // namespace snare::scenario
