#pragma once

#include "base/toml_tree.hpp"
#include "scenario/world.hpp"

#include <filesystem>
#include <vector>

namespace snare::scenario {

/// Reads a scenario of any kind and the files that it names; throws InputError with everything that is wrong in them.
/// Overrides whose key begins with "contact." go to the contact scenario that one of kind "arm_contact" names.
[[nodiscard]] Scenario read_scenario(const std::filesystem::path& file,
                                     const std::vector<base::Override>& overrides = {});

}  // namespace snare::scenario
