#pragma once

#include "base/toml_reader.hpp"

#include <string_view>

namespace snare::base {

/// Reports a name that cannot stand in addresses of keys, headings of tables, pages and names of files as it is: the part behind the last
/// "::" must be 1 to 64 letters (of any alphabet), digits, spaces or "_-.+()", the first of them a letter, a digit or '_'. An empty name
/// is for others to report.
void require_plain_name(const TomlTable& table, std::string_view key, std::string_view name);

}  // namespace snare::base
