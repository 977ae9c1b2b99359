#pragma once

#include "base/errors.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace snare::base {

/// `key=value` as given to `--set`.
struct Override {
  std::string key;    ///< dotted: "wire.length_mm", "series[s40].contact_position_mm", "series[2].points"
  std::string value;  ///< a TOML literal; anything that is none is taken as a string
};

/// Splits "key=value" at the first '='. Throws InputError when there is none, or nothing on one side of it.
[[nodiscard]] Override parse_override(std::string_view argument);

struct TomlEntry;

/// A file whose tables stand in the tree of another one.
struct TomlPart {
  std::string file;   ///< stands in messages
  std::string scope;  ///< in which its names stand: "SCOPE::name"
};

/// One value of a TOML file with the place it came from.
struct TomlNode {
  enum class Kind { table, array, text, number, boolean, other };

  Kind kind = Kind::table;
  std::vector<TomlEntry> entries;  ///< table
  std::vector<TomlNode> items;     ///< array
  std::string text;                ///< text
  double number = 0.0;             ///< number; may be NaN or infinite
  bool integer = false;            ///< the number was written as an integer (dates and times are `other`)
  bool boolean = false;            ///< boolean
  std::string written;             ///< as it stands in the file, shortened; empty for a table with a header
  int line = 0;                    ///< 1-based; 0 for an overridden value
  bool overridden = false;         ///< given by --set
  std::shared_ptr<const TomlPart> part;  ///< in which it is written; null: in the file itself

  /// Entry of a table, or null.
  [[nodiscard]] const TomlNode* find(std::string_view key) const noexcept;
};

/// A key of a table with its value, in the order of the file.
struct TomlEntry {
  std::string key;
  TomlNode node;
};

/// How an element of an array of tables is addressed: by its `name` where it has one, else by its number
/// from 1: "s40", "2".
[[nodiscard]] std::string element_label(const TomlNode& element, std::size_t index);

/// Parses TOML text. `file` stands in messages. Throws InputError with the line at which the text stops being
/// TOML (or UTF-8, or is nested too deeply).
[[nodiscard]] TomlNode parse_toml(const std::string& file, std::string_view text);

/// Replaces or adds the value that `change.key` names, with the tables on the way to it; what cannot be done
/// is added to `problems`.
void apply_override(TomlNode& root, const Override& change, std::vector<InputProblem>& problems);

/// A text that is the same for trees of the same keys and values: keys in order, numbers to the last bit, no
/// comments.
[[nodiscard]] std::string canonical_text(const TomlNode& node);

}  // namespace snare::base
