#include "base/toml_tree.hpp"

#include "base/byte_order_mark.hpp"
#include "base/files.hpp"

#include <fmt/format.h>

// toml++ 3.3 asserts that a table header starts with a key before it finds out, and reports, that it does not
// ("[#]"): its assertions would end the program for a slip in a file. Debian's compiled library has none.
#define TOML_ASSERT(condition) static_assert(true)
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <optional>
#include <utility>

namespace snare::base {

namespace {

constexpr std::size_t shown_value = 60;  // of an offending value, in characters
constexpr std::size_t deepest_dotted_key = 32;

std::vector<std::string_view> split_lines(std::string_view text) {
  std::vector<std::string_view> lines;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

/// Characters [from, to) of a line, counted in code points from 1 as toml++ does.
std::string code_points(std::string_view line, std::size_t from, std::size_t to) {
  std::string text;
  std::size_t column = 0;
  for (const char c : line) {
    if ((static_cast<unsigned char>(c) & 0xC0u) != 0x80u) ++column;
    if (column >= to) break;
    if (column >= from && c != '\r') text += c;
  }
  return text;
}

/// The text that a node was read from.
std::string written_text(const toml::node& node, const std::vector<std::string_view>& lines) {
  const toml::source_region& region = node.source();
  if (const toml::table* table = node.as_table(); table != nullptr && !table->is_inline()) return {};
  if (node.is_array_of_tables() && !node.as_array()->empty() &&
      !node.as_array()->front().as_table()->is_inline())
    return {};
  if (region.begin.line == 0 || region.begin.line > lines.size()) return {};
  const bool one_line = region.begin.line == region.end.line;
  const std::size_t last = std::min<std::size_t>(
      one_line ? region.end.column : region.begin.column + shown_value, region.begin.column + shown_value);
  std::string text = code_points(lines[region.begin.line - 1], region.begin.column, last);
  if (!one_line || region.end.column > last) text += "...";
  return text;
}

/// Source text is copied into `written` and numbers of lines into `line`.
TomlNode converted(const toml::node& node, const std::vector<std::string_view>& lines) {
  TomlNode result;
  result.line = static_cast<int>(node.source().begin.line);
  result.written = written_text(node, lines);
  if (const toml::table* table = node.as_table()) {
    for (const auto& [key, value] : *table)
      result.entries.push_back({std::string(key.str()), converted(value, lines)});
  } else if (const toml::array* array = node.as_array()) {
    result.kind = TomlNode::Kind::array;
    for (const toml::node& item : *array) result.items.push_back(converted(item, lines));
  } else if (const auto* text = node.as_string()) {
    result.kind = TomlNode::Kind::text;
    result.text = text->get();
  } else if (const auto* integer = node.as_integer()) {
    result.kind = TomlNode::Kind::number;
    result.number = static_cast<double>(integer->get());
    result.integer = true;
  } else if (const auto* number = node.as_floating_point()) {
    result.kind = TomlNode::Kind::number;
    result.number = number->get();
  } else if (const auto* boolean = node.as_boolean()) {
    result.kind = TomlNode::Kind::boolean;
    result.boolean = boolean->get();
  } else {
    result.kind = TomlNode::Kind::other;
  }
  return result;
}

/// Moves `i` from the first quote of a string to its last, counting lines; strings that do not end go to the
/// end of their line, those in three quotes to the end of the text.
void skip_string(std::string_view text, std::size_t& i, int& line) {
  const char quote = text[i];
  const std::string three(3, quote);
  const bool multi_line = text.substr(i, 3) == three;
  for (i += multi_line ? 3 : 1; i < text.size(); ++i) {
    if (text[i] == '\n' && !multi_line) {
      --i;  // the line feed belongs to what follows
      return;
    }
    if (text[i] == '\n') ++line;
    if (text[i] == '\\' && quote == '"' && text.substr(i, 2) != "\\\n")
      ++i;
    else if (!multi_line && text[i] == quote)
      return;
    else if (multi_line && text.substr(i, 3) == three) {
      i += 2;
      for (int extra = 0; extra < 2 && text.substr(i + 1, 1) == three.substr(0, 1); ++extra) ++i;
      return;
    }
  }
}

/// Refuses, with its line, what the library cannot bear:
/// - keys with more than deepest_dotted_key dots: tables are read and destroyed recursively, so a file of
///   nothing but dots could exhaust the stack;
/// - characters outside ASCII that stand neither in a string nor in a comment, which TOML forbids: toml++ 3.3
///   (is_non_ascii_horizontal_whitespace) runs into undefined behaviour. As it reads a bare value up to the
///     next
///   blank, quotes and brackets may not follow a word directly (TOML has this in keys like a."b" only),
///     nor one
///   '=' another.
void check_outside_strings(const std::string& file, std::string_view text) {
  constexpr std::string_view openers = "\"'[{";
  constexpr std::string_view before_openers = " \t\r\n=,[]{}\"'";
  int line = 1;
  std::size_t dots = 0;
  bool in_value = false;
  const auto refuse = [&](std::string requirement) {
    throw InputError(InputProblem{file, line, "", "", std::move(requirement)});
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (i > 0 && openers.find(c) != openers.npos && before_openers.find(text[i - 1]) == before_openers.npos)
      refuse(fmt::format("not TOML: {} inside a word", c));
    if (c == '"' || c == '\'') {
      skip_string(text, i, line);
    } else if (c == '#') {
      i = std::min(text.find('\n', i), text.size()) - 1;
    } else if (static_cast<unsigned char>(c) >= 0x80u) {
      std::size_t end = i + 1;  // the text is UTF-8: up to the next byte that is no continuation
      while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0u) == 0x80u) ++end;
      refuse(fmt::format("{} must stand in quotes or in a comment", text.substr(i, end - i)));
    } else if (c == '.') {
      if (++dots > deepest_dotted_key) refuse(fmt::format("a key has more than {} dots", deepest_dotted_key));
    } else if (c == '\n' || c == ',' || c == '=' || openers.find(c) != openers.npos || c == ']' || c == '}') {
      dots = 0;
      if (c == '\n') ++line;
      if (c == '=' && in_value) refuse("not TOML: a second = after a key");
      in_value = c == '=' || (in_value && c != '\n' && c != ',' && c != '{');
    }
  }
}

void mark_overridden(TomlNode& node) {
  node.line = 0;
  node.overridden = true;
  for (TomlEntry& entry : node.entries) mark_overridden(entry.node);
  for (TomlNode& item : node.items) mark_overridden(item);
}

/// A TOML literal, or the text itself where it is none and does not look like one either.
std::optional<TomlNode> parse_value(const std::string& value) {
  try {
    TomlNode parsed = parse_toml("", "value = " + value);
    if (parsed.entries.size() == 1 && parsed.entries.front().key == "value") {
      TomlNode node = std::move(parsed.entries.front().node);
      mark_overridden(node);
      if (node.written.empty()) node.written = value;
      return node;
    }
  } catch (const InputError&) {
    if (find_invalid_utf8(value) != std::string_view::npos) return std::nullopt;
  }
  if (value.empty() || std::string_view("\"'[{").find(value.front()) != std::string_view::npos)
    return std::nullopt;
  TomlNode node;
  node.kind = TomlNode::Kind::text;
  node.text = node.written = value;
  node.overridden = true;
  return node;
}

struct PathPart {
  std::string key;
  std::string element;  // "s40" in series[s40]; empty for a plain key
};

/// "series[s40].law.to_mm" -> series[s40], law, to_mm; nothing when it is not of this form.
std::vector<PathPart> split_path(std::string_view path) {
  std::vector<PathPart> parts;
  while (parts.size() < deepest_dotted_key) {
    PathPart part;
    std::size_t at = path.find_first_of(".[");
    part.key = path.substr(0, at);
    if (part.key.empty() || part.key.find_first_of("]=\"' \t") != std::string::npos) return {};
    if (at != std::string_view::npos && path[at] == '[') {
      const std::size_t end = path.find(']', at);
      if (end == std::string_view::npos || end == at + 1) return {};
      part.element = path.substr(at + 1, end - at - 1);
      at = end + 1;
      if (at < path.size() && path[at] != '.') return {};
      if (at == path.size()) at = std::string_view::npos;
    }
    parts.push_back(std::move(part));
    if (at == std::string_view::npos) return parts;
    path.remove_prefix(at + 1);
  }
  return {};
}

TomlNode* find_entry(TomlNode& table, const std::string& key) {
  return const_cast<TomlNode*>(std::as_const(table).find(key));
}

TomlNode* find_element(TomlNode& array, const std::string& wanted) {
  for (std::size_t i = 0; i < array.items.size(); ++i)
    if (element_label(array.items[i], i) == wanted) return &array.items[i];
  std::size_t number = 0;
  const char* end = wanted.data() + wanted.size();
  const auto [stop, error] = std::from_chars(wanted.data(), end, number);
  const bool valid = error == std::errc() && stop == end && number >= 1 && number <= array.items.size();
  return valid ? &array.items[number - 1] : nullptr;
}

std::string element_list(const TomlNode& array) {
  constexpr std::size_t most = 10;
  std::string text;
  for (std::size_t i = 0; i < std::min(array.items.size(), most); ++i)
    text += (i == 0 ? "" : ", ") + element_label(array.items[i], i);
  return array.items.size() > most ? text + ", ..." : text;
}

}  // namespace

namespace {

/// Short and printable: fit to stand in a message and between brackets.
bool is_label(std::string_view text) {
  constexpr std::size_t longest = 64;
  const auto unfit = [](char c) { return static_cast<unsigned char>(c) < 0x20u || c == ']' || c == '['; };
  return !text.empty() && text.size() <= longest && std::none_of(text.begin(), text.end(), unfit);
}

}  // namespace

const TomlNode* TomlNode::find(std::string_view key) const noexcept {
  for (const TomlEntry& entry : entries)
    if (entry.key == key) return &entry.node;
  return nullptr;
}

Override parse_override(std::string_view argument) {
  const std::size_t equals = argument.find('=');
  if (equals == std::string_view::npos || equals == 0 || equals + 1 == argument.size())
    throw InputError(InputProblem{"--set", 0, std::string(argument), "", "must be key=value"});
  return {std::string(argument.substr(0, equals)), std::string(argument.substr(equals + 1))};
}

std::string element_label(const TomlNode& element, std::size_t index) {
  const TomlNode* name = element.find("name");
  const bool named = name != nullptr && name->kind == TomlNode::Kind::text && is_label(name->text);
  return named ? name->text : std::to_string(index + 1);
}

TomlNode parse_toml(const std::string& file, std::string_view text) {
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  if (const std::size_t at = find_invalid_utf8(text); at != std::string_view::npos) {
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    throw InputError(
        InputProblem{file, static_cast<int>(line), "", "",
                     fmt::format("byte 0x{:02x} is not UTF-8", static_cast<unsigned char>(text[at]))});
  }
  check_outside_strings(file, text);
  try {
    const toml::table table = toml::parse(text, std::string_view());
    TomlNode root = converted(table, split_lines(text));
    root.line = 0;  // a message about the file as a whole has no line
    return root;
  } catch (const toml::parse_error& error) {
    throw InputError(InputProblem{file, static_cast<int>(error.source().begin.line), "", "",
                                  fmt::format("not TOML: {}", error.description())});
  }
}

void apply_override(TomlNode& root, const Override& change, std::vector<InputProblem>& problems) {
  const auto fail = [&](std::string requirement) {
    problems.push_back({"--set", 0, change.key, change.value, std::move(requirement)});
  };
  const std::vector<PathPart> path = split_path(change.key);
  if (path.empty()) return fail("the key must be like wire.length_mm or series[s40].points");
  std::optional<TomlNode> value = parse_value(change.value);
  if (!value) return fail("the value must be a TOML literal or a bare word");
  TomlNode* node = &root;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const auto& [key, element] = path[i];
    if (node->kind != TomlNode::Kind::table)
      return fail(fmt::format("{} is not a table", i == 0 ? "the file" : path[i - 1].key));
    TomlNode* next = find_entry(*node, key);
    if (next == nullptr) {
      if (!element.empty()) return fail(fmt::format("there is no [[{}]] in the file", key));
      node->entries.push_back({key, {}});
      next = &node->entries.back().node;
      next->overridden = true;
    }
    if (!element.empty()) {
      if (next->kind != TomlNode::Kind::array) return fail(fmt::format("{} has no elements", key));
      TomlNode* found = find_element(*next, element);
      if (found == nullptr) return fail(fmt::format("no such {}; there are: {}", key, element_list(*next)));
      next = found;
    }
    node = next;
  }
  *node = std::move(*value);
}

std::string canonical_text(const TomlNode& node) {
  switch (node.kind) {
    case TomlNode::Kind::table: {
      std::vector<const TomlEntry*> sorted;
      for (const TomlEntry& e : node.entries) sorted.push_back(&e);
      std::sort(sorted.begin(), sorted.end(),
                [](const TomlEntry* a, const TomlEntry* b) { return a->key < b->key; });
      std::string text = "{";
      for (const TomlEntry* e : sorted)
        text += fmt::format("{}:{}={};", e->key.size(), e->key, canonical_text(e->node));
      return text + "}";
    }
    case TomlNode::Kind::array: {
      std::string text = "[";
      for (const TomlNode& item : node.items) text += canonical_text(item) + ",";
      return text + "]";
    }
    case TomlNode::Kind::text:
      return fmt::format("{}:{}", node.text.size(), node.text);
    case TomlNode::Kind::number:
      return fmt::format("{:a}", node.number);
    case TomlNode::Kind::boolean:
      return node.boolean ? "true" : "false";
    case TomlNode::Kind::other:
      break;
  }
  return node.written;
}

}  // namespace snare::base
