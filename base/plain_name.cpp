#include "base/plain_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace snare::base {

namespace {

constexpr std::string_view others = " -.+()";

// Bytes from 0x80 on are of letters of other alphabets; TOML has seen to it that they are UTF-8.
bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         static_cast<unsigned char>(c) >= 0x80u;
}

}  // namespace

void require_plain_name(const TomlTable& table, std::string_view key, std::string_view name) {
  constexpr std::size_t longest = 64;
  const auto fits = [](char c) { return is_letter_or_digit(c) || others.find(c) != std::string_view::npos; };
  if (name.empty() && !table.has(key)) return;
  if (!name.empty() && name.size() <= longest && std::all_of(name.begin(), name.end(), fits) &&
      is_letter_or_digit(name.front()))
    return;
  table.fail(
      key,
      fmt::format("must be 1 to {} letters, digits, spaces or \"_-.+()\", the first a letter, a digit or '_'",
                  longest));
}

bool names_a_column(std::string_view text) {
  return !text.empty() && text.find_first_of(",\"\n\r#") == std::string_view::npos;
}

}  // namespace snare::base
