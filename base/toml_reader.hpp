#pragma once

#include "base/errors.hpp"
#include "base/range.hpp"
#include "base/toml_tree.hpp"

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace snare::base {

class TomlTable;

/// A TOML file that is being checked against what the program asks of it.
///
/// The schema is what is asked: a reader asks the tables for their keys, with kind and range, and `finish()`
/// throws one InputError with everything that was wrong, including keys that nobody asked for (with the
/// nearest key that was). A question whose answer is wrong returns a harmless value, so that reading
/// continues:
///
///     TomlDocument document(path, overrides);
///     TomlTable wire = document.root().table("wire");
///     specification.length = wire.number("length_mm", Range::above(0.0), 1e-3);
///     document.finish();  // nothing that was read may be used before
///
/// Messages address a value as `wire.length_mm`, in an array of tables `series[s40].points` by the element's
/// `name` (or its number from 1), and give its line; a value that came from an override has `--set` instead.
class TomlDocument {
 public:
  /// Reads and parses a file of at most 1 MiB. Throws InputError when it cannot be read or is not TOML.
  explicit TomlDocument(const std::filesystem::path& file, const std::vector<Override>& overrides = {});
  /// The same from text in memory; `file` stands in messages.
  TomlDocument(const std::string& file, std::string_view text, const std::vector<Override>& overrides = {});
  /// The same from what has been parsed already.
  TomlDocument(std::string file, TomlNode root, const std::vector<Override>& overrides = {});
  ~TomlDocument() = default;
  TomlDocument(const TomlDocument&) = delete;
  TomlDocument& operator=(const TomlDocument&) = delete;

  /// The table of all keys at the top of the file: with it the asking begins.
  [[nodiscard]] TomlTable root();

  /// Adds a problem found by other means, in a file that this one names for instance. The same problem is
  /// kept once.
  void add(InputProblem problem);

  /// Of what the file says after its overrides; comments and the order of keys make no difference, nor does
  /// the value of `without`, a key of a table of the root: "solver.least_advance_s".
  [[nodiscard]] std::string canonical(std::string_view without = {}) const;

  /// Throws InputError if anything was wrong. Problems of the file come first, by line, then those of
  /// overrides and those that were added.
  void finish();

  static constexpr std::size_t size_limit = 1u << 20u;  ///< [byte]
  static constexpr std::size_t problem_limit = 100;     ///< problems that are listed

 private:
  friend class TomlTable;
  struct Visit {
    std::string address;
    std::set<std::string, std::less<>> asked;
  };

  void report(const TomlNode& at, std::string key, std::string requirement);
  [[nodiscard]] std::string file_of(const TomlNode* at) const;
  void report_unknown_keys();
  [[nodiscard]] std::string suggestion(std::string_view key, const Visit& visit) const;

  std::string file_;
  TomlNode root_;
  std::map<const TomlNode*, Visit> visits_;
  std::vector<InputProblem> problems_;
  std::set<std::string> messages_;  // of the problems, to keep each once
  bool more_ = false;               // than can be listed
};

/// A value of an enumeration and the name it has in files.
template <class Value>
struct Choice {
  std::string_view name;
  Value value;
};

/// One table of a document, or nothing where the file has none. A light view: valid as long as the document.
///
/// `..._or` and `optional_...` accept that the key is absent; the others report it. After a problem a number
/// is NaN, so that comparisons with it are false; a text is empty; an integer is the least allowed. Ranges
/// are in the unit of the file; defaults and results are in SI.
class TomlTable {
 public:
  /// This table where it has the key that is asked, else `base`. Both must belong to the same document.
  [[nodiscard]] TomlTable over(const TomlTable& base) const;

  /// Has the key, whatever its value. Makes the key a known one.
  [[nodiscard]] bool has(std::string_view key) const;

  /// A number in `range`, both in the file's unit; `unit`: SI units in one of these (1e-3 for mm). The result
  /// is in SI, NaN after a problem.
  [[nodiscard]] double number(std::string_view key, Range range, double unit = 1.0) const;
  /// The same, or `otherwise` (in SI) where the key is absent.
  [[nodiscard]] double number_or(std::string_view key, double otherwise, Range range,
                                 double unit = 1.0) const;
  /// The same; nothing where the key is absent or wrong.
  [[nodiscard]] std::optional<double> optional_number(std::string_view key, Range range,
                                                      double unit = 1.0) const;
  /// A whole number from `low` to `high`; `low` after a problem.
  [[nodiscard]] int integer(std::string_view key, int low, int high) const;
  /// The same, or `otherwise` where the key is absent.
  [[nodiscard]] int integer_or(std::string_view key, int otherwise, int low, int high) const;
  /// true or false, or `otherwise` where the key is absent or wrong.
  [[nodiscard]] bool boolean_or(std::string_view key, bool otherwise) const;
  /// A text; empty after a problem.
  [[nodiscard]] std::string text(std::string_view key) const;
  /// The same, or `otherwise` where the key is absent.
  [[nodiscard]] std::string text_or(std::string_view key, std::string otherwise) const;
  /// An array of numbers, `least` to `most` of them; empty after a problem. Range in the file's unit, result
  /// in SI, see `number`.
  [[nodiscard]] std::vector<double> numbers(std::string_view key, std::size_t least, std::size_t most,
                                            Range range, double unit = 1.0) const;
  /// An array of `count` numbers, or one number for all of them; empty after a problem. In SI, see `number`.
  [[nodiscard]] std::vector<double> numbers_or_one(std::string_view key, std::size_t count, Range range,
                                                   double unit = 1.0) const;
  /// An array of texts; empty when the key is absent and after a problem.
  [[nodiscard]] std::vector<std::string> texts_or_none(std::string_view key) const;

  /// One of a few names; nothing after a problem.
  template <class Value, std::size_t count>
  [[nodiscard]] std::optional<Value> choice(std::string_view key,
                                            const Choice<Value> (&choices)[count]) const {
    std::vector<std::string_view> names;
    for (const auto& one : choices) names.push_back(one.name);
    const std::optional<std::size_t> index = choice_index(key, names);
    return index ? std::optional<Value>(choices[*index].value) : std::nullopt;
  }

  /// Whether a table is under the key.
  [[nodiscard]] bool holds_table(std::string_view key) const;
  /// The table under a key. Where there is none the result is empty: it reports the missing table when
  /// something is required of it.
  [[nodiscard]] TomlTable table(std::string_view key) const;
  /// The elements of an array of tables; none when the key is absent.
  [[nodiscard]] std::vector<TomlTable> tables(std::string_view key) const;

  /// Reports that the value of a key is wrong; an empty key stands for the table itself.
  void fail(std::string_view key, std::string requirement) const;
  /// Reports one element of the array under a key, counted from 0: `fit.free[2]`.
  void fail_element(std::string_view key, std::size_t index, std::string requirement) const;

  /// In which names of this table stand, of a file that another one includes; empty: in none.
  [[nodiscard]] std::string scope() const;

  /// "series[s40]"; empty for the root.
  [[nodiscard]] const std::string& address() const { return layers_.front().address; }

 private:
  friend class TomlDocument;
  struct Layer {
    const TomlNode* node = nullptr;  // null where the file has no such table
    std::string address;
    bool broken = false;  // there is something else in its place, which has been reported
  };
  struct Found {
    const TomlNode* node = nullptr;
    std::string address;  // of the key
  };

  TomlTable(TomlDocument& document, const TomlNode* node, std::string address, bool broken);

  [[nodiscard]] Found find(std::string_view key) const;
  void missing(std::string_view key, const std::string& requirement) const;
  [[nodiscard]] std::optional<double> checked(const Found& found, Range range, double unit) const;
  [[nodiscard]] std::optional<std::size_t> choice_index(std::string_view key,
                                                        const std::vector<std::string_view>& names) const;

  TomlDocument* document_;
  std::vector<Layer> layers_;  // the first that has a key gives it; never empty
};

/// Asks for the line `schema = "..."` with which every file says what it is; anything else is reported.
void require_schema(const TomlTable& root, std::string_view schema);

/// Runs the reader of another file that a document names; what is wrong there goes to the document, and
/// nothing comes back.
template <class Read>
auto read_beside(TomlDocument& document, const Read& read) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const InputError& error) {
    for (const InputProblem& problem : error.problems()) document.add(problem);
    return std::nullopt;
  }
}

/// The candidate nearest to `word` by edit distance (insertions, deletions, replacements, swaps of
/// neighbours), or empty when none is near: more than a third of the word would have to change.
[[nodiscard]] std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates);

/// What follows "must be one of these" in a message: "; did you mean X?", or ": " and all of them when none
/// is near.
[[nodiscard]] std::string nearest_or_all(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace snare::base
