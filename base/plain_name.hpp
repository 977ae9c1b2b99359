#pragma once

#include "base/toml_reader.hpp"

#include <string_view>

namespace snare::base {

/// Reports a name that cannot stand in addresses of keys, headings of tables, pages and names of files as it
/// is: it must be 1 to 64 letters (of any alphabet, in bytes of UTF-8), digits, spaces or "_-.+()", the first
/// of them a letter, a digit or '_'. A key that is missing is for others to report.
void require_plain_name(const TomlTable& table, std::string_view key, std::string_view name);

/// Whether a text can stand over a column of a CSV file as it is: some text without commas, quotes, number
/// signs and line breaks.
[[nodiscard]] bool names_a_column(std::string_view text);

}  // namespace snare::base
