#pragma once

#include "base/toml_tree.hpp"

#include <filesystem>
#include <vector>

namespace snare::scenario {

/// The tree of a scenario file with the lists of the files that it includes: a part
///
///     [[include]]
///     name = "rms"
///     file = "parts/arm_with_snare.toml"
///     frame = "station"              # and a place on it: the world of the part
///
/// is a file of the composed schema that has lists alone. Its names become "rms::NAME", its world a frame
/// "rms" on `frame`, its files are sought beside it, and what it lists stands before what the including file
/// lists. Parts may include others.
///
/// Overrides of `include[NAME]` act on the list of parts and are taken out of `overrides`. Throws InputError
/// when a part cannot be read, is of another schema, has other keys than lists, or includes itself by way of
/// others.
[[nodiscard]] base::TomlNode read_with_parts(const std::filesystem::path& file,
                                             std::vector<base::Override>& overrides);

}  // namespace snare::scenario
