#include "base/csv_header.hpp"

#include "base/blanks.hpp"
#include "base/toml_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string>

namespace snare::base {

namespace {

constexpr std::array separators{',', ';', '\t', ' '};
constexpr std::size_t most_shown = 12;  // columns in a message

bool is_required(const CsvColumn& column) {
  return column.presence == CsvColumn::Presence::required;
}

bool is_number(std::string text) {
  std::ranges::replace(text, ',', '.');
  const std::string_view digits =
      text.starts_with('+') ? std::string_view(text).substr(1) : std::string_view(text);
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return error == std::errc() && end == digits.data() + digits.size();
}

std::string lower(std::string_view text) {
  std::string result;
  for (const char c : text) result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

/// What testing machines call travel, force and time (English and German exports), in small letters.
constexpr std::array<std::pair<NamedUnit::Quantity, std::string_view>, 18> machine_words{{
    {NamedUnit::Quantity::length, "displacement"},
    {NamedUnit::Quantity::length, "extension"},
    {NamedUnit::Quantity::length, "crosshead"},
    {NamedUnit::Quantity::length, "position"},
    {NamedUnit::Quantity::length, "travel"},
    {NamedUnit::Quantity::length, "stroke"},
    {NamedUnit::Quantity::length, "deflection"},
    {NamedUnit::Quantity::length, "weg"},
    {NamedUnit::Quantity::length, "standardweg"},
    {NamedUnit::Quantity::length, "traverse"},
    {NamedUnit::Quantity::force, "force"},
    {NamedUnit::Quantity::force, "load"},
    {NamedUnit::Quantity::force, "kraft"},
    {NamedUnit::Quantity::force, "standardkraft"},
    {NamedUnit::Quantity::force, "last"},
    {NamedUnit::Quantity::time, "time"},
    {NamedUnit::Quantity::time, "zeit"},
    {NamedUnit::Quantity::time, "pruefzeit"},
}};

std::optional<NamedUnit::Quantity> quantity_of_word(std::string_view name) {
  const std::string word = lower(without_unit(name));
  const auto found = std::ranges::find(machine_words, word, [](const auto& one) { return one.second; });
  return found == machine_words.end() ? std::nullopt : std::optional(found->first);
}

/// A column of the file, and its unit where the file says it.
struct FoundColumn {
  std::string name;
  std::optional<NamedUnit> unit;
};

/// How near a column is to the one that is wanted: 3 the same name in other letters or with another unit, 2 a
/// word or a unit of the same quantity, 1 a slip of the pen, 0 not at all.
int nearness(const FoundColumn& found, const CsvColumn& wanted) {
  const std::string& meaning = wanted.meaning.empty() ? wanted.name : wanted.meaning;
  const std::string stem = lower(without_unit(meaning));
  if (lower(without_unit(found.name)) == stem) return 3;
  if (const auto unit = unit_in_name(meaning)) {
    if (quantity_of_word(found.name) == unit->quantity) return 2;
    if (found.unit && found.unit->quantity == unit->quantity) return 2;
  }
  return nearest_word(lower(wanted.name), {lower(found.name)}).empty() ? 0 : 1;
}

/// The nearest of the columns; nothing where none is near, or two are equally.
const FoundColumn* nearest(const std::vector<FoundColumn>& there, const CsvColumn& wanted) {
  const FoundColumn* best = nullptr;
  int highest = 0;
  for (const FoundColumn& one : there) {
    const int how = nearness(one, wanted);
    if (how < highest || how == 0) continue;
    best = how > highest ? &one : nullptr;
    highest = how;
  }
  return best;
}

/// A key or a text of TOML.
std::string toml_text(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (static_cast<unsigned char>(c) >= 0x20u) result += c;
  }
  return result + '"';
}

/// The keys by which an experiment assigns columns of a file to its quantities.
class Changes {
 public:
  void add(const FoundColumn* found, const CsvColumn& wanted) {
    const std::string name = found != nullptr ? toml_text(found->name) : "\"COLUMN\"";
    columns_.push_back(fmt::format("{} = {}", name, toml_text(wanted.meaning)));
    const auto asked = unit_in_name(wanted.meaning);
    all_near_ = all_near_ && found != nullptr;
    if (found == nullptr || !asked || !found->unit) return;
    const NamedUnit& unit = *found->unit;
    if (unit.quantity == asked->quantity && unit.si != asked->si)
      scales_.push_back(fmt::format("{} = {:.12g}", name, unit.si / asked->si));
  }
  [[nodiscard]] std::string text() const {
    if (columns_.empty()) return "";
    const std::string scale =
        scales_.empty() ? "" : fmt::format(" and scale = {{ {} }}", fmt::join(scales_, ", "));
    return fmt::format("; {} columns = {{ {} }}{}",
                       all_near_ ? "if so, write" : "name it:", fmt::join(columns_, ", "), scale);
  }

 private:
  std::vector<std::string> columns_, scales_;
  bool all_near_ = true;
};

std::string missing_column(const std::vector<FoundColumn>& there, const FoundColumn* near) {
  std::string text = "no such column; the file has ";
  const std::size_t shown = std::min(there.size(), most_shown);
  for (std::size_t i = 0; i < shown; ++i) text += (i > 0 ? ", " : "") + toml_text(there[i].name);
  if (shown < there.size()) text += fmt::format(" and {} more", there.size() - shown);
  return near == nullptr ? text : text + "; the nearest is " + toml_text(near->name);
}

/// The line that is most likely to be the header: the most columns that are near a wanted one, then the most
/// cells.
struct Likeliest {
  int line = 0;
  std::vector<FoundColumn> columns = {};
};

Likeliest likeliest_header(const CsvLines& lines, std::optional<char> separator,
                           std::span<const CsvColumn> columns) {
  Likeliest best;
  std::pair<std::size_t, std::size_t> highest{0, 0};
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (const char one : separators) {
      if (one != separator.value_or(one) || (one == ' ' && !best.columns.empty() && best.columns.size() > 1))
        continue;
      std::vector<FoundColumn> there;
      for (std::string& name : cells_of(lines[i].second, one)) {
        std::optional<NamedUnit> unit = unit_in_name(name);
        if (!name.empty()) there.push_back({std::move(name), unit});
      }
      if (i + 1 < lines.size()) {  // the line below may have the units
        const std::vector<std::string> below = cells_of(lines[i + 1].second, one);
        for (std::size_t k = 0; k < there.size() && below.size() == there.size(); ++k)
          if (!there[k].unit) there[k].unit = unit_of(below[k]);
      }
      const auto near = static_cast<std::size_t>(std::ranges::count_if(columns, [&](const CsvColumn& wanted) {
        return std::ranges::any_of(there, [&](const FoundColumn& f) { return nearness(f, wanted) > 0; });
      }));
      const std::pair score{near, std::min<std::size_t>(there.size(), 2)};
      if (!best.columns.empty() && score <= highest) continue;
      highest = score;
      best = {lines[i].first, std::move(there)};
    }
  }
  return best;
}

}  // namespace

std::string_view next_cell(std::string_view line, char separator, std::size_t& at) noexcept {
  const bool blanks = separator == ' ';
  if (blanks)
    while (at < line.size() && is_blank(line[at])) ++at;
  std::size_t end = at;
  bool quoted = false;
  for (; end < line.size(); ++end) {
    if (line[end] == '"') quoted = !quoted;
    if (!quoted && (blanks ? is_blank(line[end]) : line[end] == separator)) break;
  }
  std::string_view cell = trimmed(line.substr(at, end - at));
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"')
    cell = trimmed(cell.substr(1, cell.size() - 2));
  if (blanks)
    while (end < line.size() && is_blank(line[end])) ++end;
  const bool more = blanks ? end < line.size() : end < line.size();
  at = !more ? std::string_view::npos : (blanks ? end : end + 1);
  return cell;
}

std::vector<std::string> cells_of(std::string_view line, char separator) {
  std::vector<std::string> cells;
  for (std::size_t at = 0; at != std::string_view::npos;) cells.emplace_back(next_cell(line, separator, at));
  return cells;
}

std::optional<char> declared_separator(std::string_view line) noexcept {
  constexpr std::string_view word = "sep=";
  if (line.size() >= 2 && line.front() == '"' && line.back() == '"') line = line.substr(1, line.size() - 2);
  if (line.size() != word.size() + 1 || lower(line.substr(0, word.size())) != word) return std::nullopt;
  return line.back();
}

std::optional<CsvHeader> header_of(std::string_view line, std::optional<char> separator,
                                   std::span<const CsvColumn> columns) {
  const auto try_one = [&](char by) -> std::optional<CsvHeader> {
    std::vector<std::string> names = cells_of(line, by);
    const bool all = std::ranges::all_of(columns, [&](const CsvColumn& column) {
      return !is_required(column) || std::ranges::find(names, column.name) != names.end();
    });
    if (!all) return std::nullopt;
    return CsvHeader{by, std::move(names)};
  };
  if (separator) return try_one(*separator);
  for (const char by : separators)
    if (auto header = try_one(by)) return header;
  return std::nullopt;
}

bool holds_numbers(std::string_view line) {
  return std::ranges::any_of(separators, [&](char by) {
    std::vector<std::string> cells = cells_of(line, by);
    std::erase(cells, "");
    return !cells.empty() && std::ranges::all_of(cells, is_number);
  });
}

std::vector<InputProblem> missing_columns(const std::string& file, const CsvLines& lines,
                                          std::optional<char> separator, std::span<const CsvColumn> columns) {
  const Likeliest header = likeliest_header(lines, separator, columns);
  std::vector<InputProblem> problems;
  const auto is_there = [&](const CsvColumn& wanted) {
    return std::ranges::any_of(header.columns, [&](const FoundColumn& f) { return f.name == wanted.name; });
  };
  const bool nameless = lines.size() == 1 && holds_numbers(lines.front().second);
  Changes changes;
  for (const CsvColumn& wanted : columns) {
    if (!is_required(wanted) || is_there(wanted)) continue;
    const FoundColumn* near = nearest(header.columns, wanted);
    std::string requirement =
        nameless ? "no such column; the first line that is not a comment must name the columns"
                 : missing_column(header.columns, near);
    problems.push_back({file, header.line, wanted.name, "", std::move(requirement)});
    if (!nameless && !wanted.meaning.empty()) changes.add(near, wanted);
  }
  if (!problems.empty()) problems.back().requirement += changes.text();
  return problems;
}

std::optional<std::string> unit_problem(const CsvColumn& column, const NamedUnit& found) {
  const auto asked = column.meaning.empty() || column.scaled ? std::nullopt : unit_in_name(column.meaning);
  if (!asked) return std::nullopt;
  if (asked->quantity != found.quantity)
    return fmt::format("is in {}, must be in a unit like that of {}", found.name, column.meaning);
  if (std::abs(found.si / asked->si - 1.0) < 1e-12) return std::nullopt;
  return fmt::format("is in {}, not in that of {}: write scale = {{ {} = {:.12g} }}", found.name,
                     column.meaning, toml_text(column.name), found.si / asked->si);
}

}  // namespace snare::base
