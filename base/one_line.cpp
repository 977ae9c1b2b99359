#include "base/one_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace snare::base {

namespace {

/// Whether a character of Unicode does more than to be seen.
bool acts(char32_t c) noexcept {
  return c < 0x20 || (c >= 0x7F && c <= 0x9F) || c == 0x2028 ||
         c == 0x2029 ||  // controls, separators of lines
         c == 0x061C || c == 0x200E || c == 0x200F || (c >= 0x202A && c <= 0x202E) ||
         (c >= 0x2066 && c <= 0x2069) ||                           // direction of text
         (c >= 0xFDD0 && c <= 0xFDEF) || (c & 0xFFFEu) == 0xFFFE;  // non-characters
}

/// A character of UTF-8 and how many bytes it has; 0 where they are not well-formed (Unicode 15, table 3-7).
struct Character {
  char32_t code = 0;
  std::size_t bytes = 0;
};
Character first_character(std::string_view text) noexcept {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  if (byte(0) < 0x80) return {byte(0), 1};
  const std::size_t bytes = byte(0) < 0xE0 ? 2 : byte(0) < 0xF0 ? 3 : 4;
  if (byte(0) < 0xC2 || byte(0) > 0xF4 || text.size() < bytes) return {};
  char32_t code = byte(0) & (0xFFu >> (bytes + 1));
  for (std::size_t k = 1; k < bytes; ++k) {
    if ((byte(k) & 0xC0u) != 0x80u) return {};
    code = code << 6u | (byte(k) & 0x3Fu);
  }
  constexpr char32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  if (code < least[bytes] || code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) return {};
  return {code, bytes};
}

/// The text with replacement(code, is_utf8) for every character that acts and every byte that is not UTF-8.
template <class Replacement>
std::string replaced(std::string_view text, const Replacement& replacement) {
  std::string result;
  while (!text.empty()) {
    const auto [code, bytes] = first_character(text);
    if (bytes == 0)
      result += replacement(static_cast<unsigned char>(text.front()), false);
    else
      result += acts(code) ? replacement(code, true) : std::string(text.substr(0, bytes));
    text.remove_prefix(std::max<std::size_t>(1, bytes));
  }
  return result;
}

}  // namespace

std::string one_line(std::string_view text) {
  return replaced(text, [](char32_t, bool is_utf8) { return std::string(is_utf8 ? " " : "\uFFFD"); });
}

std::string visible(std::string_view text) {
  return replaced(text, [](char32_t code, bool /*is_utf8*/) {
    const auto number = static_cast<unsigned>(code);
    return number <= 0xFF ? fmt::format("\\x{:02x}", number) : fmt::format("\\u{:04x}", number);
  });
}

std::string visible_lines(std::string_view text) {
  std::string result;
  for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
    result += visible(text.substr(0, end)) + '\n';
    text.remove_prefix(end + 1);
  }
  return result + visible(text);
}

std::string shell_word(std::string_view text) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+./:,=@%";
  if (!text.empty() && text.find_first_not_of(plain) == std::string_view::npos) return std::string(text);
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

}  // namespace snare::base
