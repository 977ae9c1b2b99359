#include "base/csv.hpp"

#include "base/byte_order_mark.hpp"
#include "base/errors.hpp"
#include "base/inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>

namespace snare::base {

namespace {

constexpr std::size_t chunk_size = 1u << 20u;  // bytes read at a time
constexpr std::size_t shown_cell = 40;         // of an offending cell, in bytes

bool is_blank(char c) noexcept {
  return c == ' ' || c == '\t';
}

std::string_view trimmed(std::string_view text) noexcept {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

bool is_ascii(std::string_view text) noexcept {
  unsigned char bits = 0;
  for (const char c : text) bits |= static_cast<unsigned char>(c);
  return bits < 0x80u;
}

/// A cell as it is shown in a message: shortened, control characters visible.
std::string shown(std::string_view cell) {
  std::string text;
  for (const char c : cell.substr(0, shown_cell)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20u || byte == 0x7Fu)
      text += fmt::format("\\x{:02x}", byte);
    else
      text += c;
  }
  if (cell.size() <= shown_cell) return text;
  const std::size_t cut = find_invalid_utf8(text);  // the cut may have split a character
  if (cut != std::string::npos) text.resize(cut);
  return text + "...";
}

/// Removes a comment that no quotes enclose.
std::string_view without_comment(std::string_view line) noexcept {
  const std::size_t hash = line.find('#');
  if (hash == std::string_view::npos) return line;
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (line[i] == '#' && !quoted) return line.substr(0, i);
  }
  return line;
}

/// The cell that starts at line[at]; moves `at` behind its comma, or to npos behind the last cell.
std::string_view next_cell(std::string_view line, std::size_t& at) noexcept {
  std::size_t end = at;
  bool quoted = false;
  for (; end < line.size(); ++end) {
    if (line[end] == '"') quoted = !quoted;
    if (line[end] == ',' && !quoted) break;
  }
  std::string_view cell = trimmed(line.substr(at, end - at));
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = trimmed(cell.substr(1, cell.size() - 2));
  at = end < line.size() ? end + 1 : std::string_view::npos;
  return cell;
}

/// Takes the lines of one file, one after the other.
class CsvParser {
 public:
  CsvParser(std::string name, std::span<const CsvColumn> columns)
      : name_(std::move(name)),
        columns_(columns),
        same_(columns.size(), unused),
        previous_(columns.size(), -std::numeric_limits<double>::infinity()),
        row_(columns.size()) {
    table_.columns.resize(columns.size());
  }

  /// One line without its line feed. `known_ascii`: the caller has checked already.
  void line(std::string_view text, bool known_ascii) {
    ++line_;
    if (line_ == 1 && text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
    if (!known_ascii && !check_utf8(text)) return;
    text = without_comment(text);
    if (trimmed(text).empty()) return;
    if (!has_header_)
      header(text);
    else
      data(text);
  }

  void too_long() {
    ++line_;
    fail(line_, "", "", fmt::format("the line has more than {} bytes", csv_line_limit));
    stopped_ = true;
  }

  /// No more lines are wanted.
  [[nodiscard]] bool stopped() const noexcept { return stopped_; }

  [[nodiscard]] std::size_t rows() const noexcept { return table_.rows; }

  void reserve(std::size_t rows) {
    for (std::size_t slot : slots_)
      for (; slot != unused; slot = same_[slot]) table_.columns[slot].reserve(rows);
  }

  [[nodiscard]] CsvTable finish() {
    if (problems_.empty() && !has_header_) fail(0, "", "", "is empty, must have a header that names the columns");
    if (problems_.empty() && table_.rows == 0) fail(0, "", "", "has a header but no rows");
    if (!problems_.empty()) throw InputError(std::move(problems_));
    return std::move(table_);
  }

 private:
  static constexpr std::size_t unused = std::numeric_limits<std::size_t>::max();

  void fail(int line, std::string key, std::string value, std::string requirement) {
    if (problems_.size() == csv_problem_limit) {
      problems_.push_back({name_, line, "", "", "and more: only the first problems are listed"});
      stopped_ = true;
    }
    if (stopped_) return;
    problems_.push_back({name_, line, std::move(key), std::move(value), std::move(requirement)});
  }

  bool check_utf8(std::string_view text) {
    const std::size_t at = find_invalid_utf8(text);
    if (at == std::string_view::npos) return true;
    fail(line_, "", "", fmt::format("byte 0x{:02x} is not UTF-8", static_cast<unsigned char>(text[at])));
    if (!has_header_) stopped_ = true;
    return false;
  }

  void header(std::string_view text) {
    has_header_ = true;
    std::vector<std::string> names;
    for (std::size_t at = 0; at != std::string_view::npos;) names.emplace_back(next_cell(text, at));
    slots_.assign(names.size(), unused);
    for (std::size_t slot = 0; slot < columns_.size(); ++slot) {
      const std::string& wanted = columns_[slot].name;
      const auto first = std::find(names.begin(), names.end(), wanted);
      if (first == names.end()) {
        if (columns_[slot].presence == CsvColumn::Presence::required) missing_column(wanted, names);
        continue;
      }
      if (std::find(first + 1, names.end(), wanted) != names.end())
        fail(line_, wanted, "", "the column is there twice");
      same_[slot] = std::exchange(slots_[static_cast<std::size_t>(first - names.begin())], slot);
    }
    stopped_ = stopped_ || !problems_.empty();  // what follows cannot be told apart
  }

  void missing_column(const std::string& wanted, const std::vector<std::string>& names) {
    std::string hint;
    double number = 0.0;
    const std::string& first = names.front();
    if (names.size() == 1 && first.find_first_of(";\t\r") != std::string::npos)
      hint = first.find('\r') != std::string::npos ? "; lines must end in LF or CRLF"
                                                   : "; columns must be separated by commas";
    else if (std::from_chars(first.data(), first.data() + first.size(), number).ec == std::errc())
      hint = "; the first line that is not a comment must name the columns";
    fail(line_, wanted, "", "no such column" + hint);
  }

  void data(std::string_view text) {
    const bool plain = text.find('"') == std::string_view::npos;
    const std::size_t problems_before = problems_.size();
    std::size_t cells = 0;
    for (std::size_t at = 0; at != std::string_view::npos; ++cells) {
      std::string_view cell;
      if (plain) {
        const std::size_t comma = text.find(',', at);
        cell = trimmed(text.substr(at, comma == std::string_view::npos ? comma : comma - at));
        at = comma == std::string_view::npos ? comma : comma + 1;
      } else {
        cell = next_cell(text, at);
      }
      if (cells >= slots_.size()) continue;
      for (std::size_t slot = slots_[cells]; slot != unused; slot = same_[slot]) number(cell, slot);
    }
    if (cells != slots_.size()) {
      problems_.resize(problems_before);  // the cells were taken for the wrong columns
      stopped_ = false;
      fail(line_, "", "", fmt::format("the row has {} cells, must have {} as the header", cells, slots_.size()));
    }
    if (problems_.size() != problems_before) return;
    for (std::size_t slot : slots_)
      for (; slot != unused; slot = same_[slot]) table_.columns[slot].push_back(row_[slot]);
    ++table_.rows;
  }

  void number(std::string_view cell, std::size_t slot) {
    const CsvColumn& column = columns_[slot];
    std::string_view digits = cell;
    if (digits.size() > 1 && digits.front() == '+' && digits[1] != '-') digits.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (cell.empty()) return fail(line_, column.name, "", "the cell is empty, must be a number");
    if (end != digits.data() + digits.size() || error == std::errc::invalid_argument)
      return fail(line_, column.name, shown(cell), "must be a number");
    if (error != std::errc() || !std::isfinite(value))
      return fail(line_, column.name, shown(cell), "must be a finite number");
    if (!column.range.contains(value)) return fail(line_, column.name, shown(cell), "must be " + column.range.phrase());
    if (column.order == CsvColumn::Order::non_decreasing) {
      if (value < previous_[slot])
        return fail(line_, column.name, shown(cell),
                    fmt::format("must be >= {}, the value of the row before", previous_[slot]));
      previous_[slot] = value;
    }
    row_[slot] = to_si(value, column.unit);
  }

  std::string name_;
  std::span<const CsvColumn> columns_;
  std::vector<std::size_t> slots_;  // of each column of the file: which asked column it is
  std::vector<std::size_t> same_;   // of each asked column: another one of the same name
  std::vector<double> previous_;    // last value of each asked column, for the order
  std::vector<double> row_;
  CsvTable table_;
  std::vector<InputProblem> problems_;
  int line_ = 0;
  bool has_header_ = false;
  bool stopped_ = false;
};

/// Feeds the complete lines of `text`; returns how many bytes they had.
std::size_t feed_lines(CsvParser& parser, std::string_view text) {
  const bool ascii = is_ascii(text);
  std::size_t at = 0;
  while (!parser.stopped()) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string_view::npos) break;
    if (end - at > csv_line_limit)
      parser.too_long();
    else
      parser.line(text.substr(at, end - at), ascii);
    at = end + 1;
  }
  return at;
}

}  // namespace

CsvTable read_csv(const std::filesystem::path& path, const std::vector<CsvColumn>& columns) {
  if (current_inputs())
    return parse_csv(path.string(), read_text(path, std::numeric_limits<std::size_t>::max()), columns);
  const InputFile file = open_input(path);
  CsvParser parser(path.string(), columns);
  std::string buffer(csv_line_limit + chunk_size, '\0');  // a started line and the next chunk
  std::size_t held = 0;                                   // bytes of the started line
  std::uintmax_t consumed = 0;
  while (!parser.stopped()) {
    const std::size_t count = read_bytes(file.handle.get(), buffer.data() + held, chunk_size, path);
    const std::string_view text(buffer.data(), held + count);
    const bool first = consumed == 0;
    const std::size_t used = feed_lines(parser, text);
    consumed += used;
    held = text.size() - used;
    if (parser.stopped()) break;
    if (held > csv_line_limit) {
      parser.too_long();
      break;
    }
    if (count < chunk_size) {  // the last line may lack its line feed
      if (held > 0) parser.line(text.substr(used), false);
      break;
    }
    if (first && used > 0)  // rows are about equally long: one allocation instead of twenty
      parser.reserve(static_cast<std::size_t>(1.05 * static_cast<double>(parser.rows()) *
                                              static_cast<double>(file.size) / static_cast<double>(used)));
    std::memmove(buffer.data(), buffer.data() + used, held);
  }
  return parser.finish();
}

CsvTable parse_csv(const std::string& name, std::string_view text, const std::vector<CsvColumn>& columns) {
  CsvParser parser(name, columns);
  const std::string_view rest = text.substr(feed_lines(parser, text));
  if (!parser.stopped() && !rest.empty()) {
    if (rest.size() > csv_line_limit)
      parser.too_long();
    else
      parser.line(rest, false);
  }
  return parser.finish();
}

namespace {

void append_text(std::string& to, std::string_view text) {
  if (text.find_first_of(",\"#\n\r") == std::string_view::npos) {
    to += text;
    return;
  }
  to += '"';
  for (const char c : text) {
    if (c == '"') to += '"';
    to += c;
  }
  to += '"';
}

}  // namespace

CsvWriter::CsvWriter(const std::filesystem::path& path, std::vector<std::string> columns,
                     const std::vector<std::string>& comments)
    : path_(path), columns_(std::move(columns)), file_(path) {
  for (const std::string& comment : comments) buffer_ += "# " + comment + '\n';
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (i > 0) buffer_ += ',';
    append_text(buffer_, columns_[i]);
  }
  buffer_ += '\n';
}

void CsvWriter::row(const std::vector<CsvCell>& cells) {
  assert(cells.size() == columns_.size());
  ++rows_;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) buffer_ += ',';
    if (const double* number = std::get_if<double>(&cells[i])) {
      if (!std::isfinite(*number))
        throw std::domain_error(
            fmt::format("{}: row {}, {} = {}: not finite, not written", path_.string(), rows_, columns_[i], *number));
      fmt::format_to(std::back_inserter(buffer_), "{}", *number);
    } else if (const long long* count = std::get_if<long long>(&cells[i])) {
      fmt::format_to(std::back_inserter(buffer_), "{}", *count);
    } else if (const std::string_view* text = std::get_if<std::string_view>(&cells[i])) {
      append_text(buffer_, *text);
    }
  }
  buffer_ += '\n';
  if (buffer_.size() > chunk_size) {
    file_.write(buffer_);
    buffer_.clear();
  }
}

void CsvWriter::commit() {
  file_.write(buffer_);
  buffer_.clear();
  file_.commit();
}

}  // namespace snare::base
