#pragma once

#include "base/toml_reader.hpp"
#include "base/toml_tree.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace snare::study {

/// A value of a file as a literal for an override; empty where it is a table.
[[nodiscard]] std::string literal_of(const base::TomlNode& node);

/// Keys of another file with their values, as a table of that name has them: `set = { "wire.length_mm" =
/// 181.0 }`. `parent`: the same table that `owner` is, as it was parsed; null: it has none. What cannot be an
/// override is reported.
[[nodiscard]] std::vector<base::Override> read_fixed_keys(const base::TomlTable& owner,
                                                          const base::TomlNode* parent,
                                                          std::string_view name);

}  // namespace snare::study
