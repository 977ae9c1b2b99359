#include "base/csv.hpp"

#include "base/blanks.hpp"
#include "base/byte_order_mark.hpp"
#include "base/csv_header.hpp"
#include "base/errors.hpp"
#include "base/files.hpp"
#include "base/inputs.hpp"
#include "base/one_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

namespace snare::base {

namespace {

constexpr std::size_t chunk_size = 1u << 20u;  // bytes read at a time
constexpr std::size_t shown_cell = 40;         // of an offending cell, in bytes

bool is_ascii(std::string_view text) noexcept {
  unsigned char bits = 0;
  for (const char c : text) bits |= static_cast<unsigned char>(c);
  return bits < 0x80u;
}

/// A cell as it is shown in a message: shortened, control characters visible.
std::string shown(std::string_view cell) {
  if (cell.size() <= shown_cell) return visible(cell);
  const std::string_view cut = cell.substr(0, shown_cell);
  return visible(cut.substr(0, find_invalid_utf8(cut))) + "...";  // the cut may have split a character
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

/// Whether a number with one comma may have it between thousands: 1,234 but not 0,123, 12,5 or 1234,5.
bool may_group_thousands(std::string_view number) noexcept {
  if (!number.empty() && (number.front() == '-' || number.front() == '+')) number.remove_prefix(1);
  const std::size_t comma = number.find(',');
  return comma >= 1 && comma <= 3 && number.front() != '0' && number.size() - comma == 4;
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
    if (trimmed(text).empty() || text == "\x1A") return;  // the latter ends files of DOS
    if (!header_)
      seek_header(text);
    else if (!std::exchange(below_header_, false) || !units(text))
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
    if (problems_.empty() && !header_) report_missing_header();
    if (problems_.empty() && table_.rows == 0) fail(0, "", "", "has a header but no rows");
    if (problems_.empty() && grouped_ && !comma_is_decimal_)
      fail(grouped_->line, grouped_->key, grouped_->value,
           "may have its comma before decimals or between thousands: must have a decimal point");
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
    const bool two_bytes = line_ == 1 && (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"));
    fail(line_, "", "",
         two_bytes ? "is UTF-16, must be UTF-8: save it as CSV UTF-8"
                   : fmt::format("byte 0x{:02x} is not UTF-8: save the file as UTF-8",
                                 static_cast<unsigned char>(text[at])));
    if (!header_) stopped_ = true;
    return false;
  }

  void seek_header(std::string_view text) {
    if (first_lines_.empty() && !separator_) {
      separator_ = declared_separator(trimmed(text));
      if (separator_) return;
    }
    header_ = header_of(text, separator_, columns_);
    if (header_) return take_header();
    first_lines_.emplace_back(line_, text);
    if (holds_numbers(text) || first_lines_.size() == csv_header_limit) report_missing_header();
  }

  void report_missing_header() {
    if (first_lines_.empty()) return fail(0, "", "", "is empty, must have a header that names the columns");
    for (InputProblem& problem : missing_columns(name_, first_lines_, separator_, columns_))
      problems_.push_back(std::move(problem));
    stopped_ = true;  // what follows cannot be told apart
  }

  void take_header() {
    std::vector<std::string>& names = header_->names;
    while (names.size() > 1 && names.back().empty()) names.pop_back();
    slots_.assign(names.size(), unused);
    for (std::size_t slot = 0; slot < columns_.size(); ++slot) {
      const std::string& wanted = columns_[slot].name;
      const auto first = std::find(names.begin(), names.end(), wanted);
      if (first == names.end()) continue;
      if (std::find(first + 1, names.end(), wanted) != names.end())
        fail(line_, wanted, "", "the column is there twice");
      if (const auto unit = unit_in_name(wanted))
        if (auto problem = unit_problem(columns_[slot], *unit)) fail(line_, wanted, "", std::move(*problem));
      same_[slot] = std::exchange(slots_[static_cast<std::size_t>(first - names.begin())], slot);
    }
    stopped_ = stopped_ || !problems_.empty();  // what follows cannot be told apart
  }

  /// Whether the line below the header has units instead of numbers; they are compared with what is
  /// asked.
  bool units(std::string_view text) {
    const std::vector<std::string> cells = cells_of(text, header_->separator);
    if (cells.size() < slots_.size()) return false;
    bool any = false;
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      if (slots_[i] == unused) continue;
      if (!cells[i].empty() && !unit_of(cells[i])) return false;
      any = any || !cells[i].empty();
    }
    if (!any) return false;
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      for (std::size_t slot = slots_[i]; slot != unused && !cells[i].empty(); slot = same_[slot])
        if (auto problem = unit_problem(columns_[slot], *unit_of(cells[i])))
          fail(line_, columns_[slot].name, "", std::move(*problem));
    }
    stopped_ = stopped_ || !problems_.empty();
    return true;
  }

  void data(std::string_view text) {
    const char separator = header_->separator;
    const bool plain = separator != ' ' && text.find('"') == std::string_view::npos;
    const std::size_t problems_before = problems_.size();
    std::size_t cells = 0, filled = 0;  // how many there are; how many up to the last that is not empty
    for (std::size_t at = 0; at != std::string_view::npos; ++cells) {
      std::string_view cell;
      if (plain) {
        const std::size_t end = text.find(separator, at);
        cell = trimmed(text.substr(at, end == std::string_view::npos ? end : end - at));
        at = end == std::string_view::npos ? end : end + 1;
      } else {
        cell = next_cell(text, separator, at);
      }
      if (!cell.empty()) filled = cells + 1;
      if (cells >= slots_.size()) continue;
      for (std::size_t slot = slots_[cells]; slot != unused; slot = same_[slot]) number(cell, slot);
    }
    if (filled == 0 || filled > slots_.size() || cells < slots_.size()) {
      problems_.resize(problems_before);  // the cells were taken for the wrong columns
      stopped_ = false;
      if (filled == 0) return;
      fail(line_, "", "",
           fmt::format("the row has {} cells, must have {} as the header", cells, slots_.size()));
    }
    if (problems_.size() != problems_before) return;
    for (std::size_t slot : slots_)
      for (; slot != unused; slot = same_[slot]) table_.columns[slot].push_back(row_[slot]);
    ++table_.rows;
  }

  /// The digits with a decimal point, of a cell that has a comma; empty, after its report, where it cannot be
  /// read.
  std::string_view with_point(std::string_view cell, const CsvColumn& column) {
    const bool other = cell.find('.') != std::string_view::npos ||
                       cell.find(',', cell.find(',') + 1) != std::string_view::npos;
    if (other || point_seen_) {
      fail(line_, column.name, shown(cell),
           other ? "must be a number without separators between thousands"
                 : "has a comma, numbers before it a decimal point: must have a decimal point and no other "
                   "separator");
      return {};
    }
    if (!may_group_thousands(cell))
      comma_is_decimal_ = true;
    else if (!grouped_)
      grouped_ = {name_, line_, column.name, shown(cell), ""};
    digits_ = cell;
    digits_[cell.find(',')] = '.';
    return digits_;
  }

  void number(std::string_view cell, std::size_t slot) {
    const CsvColumn& column = columns_[slot];
    std::string_view digits = cell;
    if (cell.find(',') != std::string_view::npos) {
      digits = with_point(cell, column);
      if (digits.empty()) return;
    } else if (cell.find('.') != std::string_view::npos) {
      if (comma_is_decimal_ || grouped_)
        return fail(line_, column.name, shown(cell),
                    "has a point, numbers before it a decimal comma: must have a comma");
      point_seen_ = true;
    }
    if (digits.size() > 1 && digits.front() == '+' && digits[1] != '-') digits.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (cell.empty()) return fail(line_, column.name, "", "the cell is empty, must be a number");
    if (end != digits.data() + digits.size() || error == std::errc::invalid_argument)
      return fail(line_, column.name, shown(cell), "must be a number");
    if (error != std::errc() || !std::isfinite(value))
      return fail(line_, column.name, shown(cell), "must be a finite number");
    if (!column.range.contains(value))
      return fail(line_, column.name, shown(cell), "must be " + column.range.phrase());
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
  CsvLines first_lines_;           // while the header is sought
  std::optional<char> separator_;  // that the file declares
  std::optional<CsvHeader> header_;
  std::optional<InputProblem> grouped_;  // first number whose comma may stand between thousands
  std::string digits_;                   // of a number with a decimal comma
  int line_ = 0;
  bool below_header_ = true;
  bool point_seen_ = false;
  bool comma_is_decimal_ = false;
  bool stopped_ = false;
};

/// Feeds the complete lines of `text`, which end in CR, LF or both; `last`: what follows the last of them is
/// a line as well. Returns how many bytes they had.
std::size_t feed_lines(CsvParser& parser, std::string_view text, bool last) {
  const bool ascii = is_ascii(text);
  std::size_t at = 0;
  while (!parser.stopped() && at < text.size()) {
    std::size_t end = text.find('\n', at);
    std::size_t next = end + 1;
    const std::string_view line = text.substr(at, end == std::string_view::npos ? end : end - at);
    const std::size_t carriage = line.find('\r');
    // At the end of the buffer it may belong to a line feed that is still to come.
    if (carriage < line.size() - 1 || (carriage < line.size() && end == std::string_view::npos && last)) {
      end = at + carriage;
      next = end + 1;
    } else if (end == std::string_view::npos) {
      if (!last) break;
      end = next = text.size();
    }
    if (end - at > csv_line_limit)
      parser.too_long();
    else
      parser.line(text.substr(at, end - at), ascii);
    at = next;
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
    const bool last = count < chunk_size;
    const std::size_t used = feed_lines(parser, text, last);
    consumed += used;
    held = text.size() - used;
    if (parser.stopped()) break;
    if (held > csv_line_limit) {
      parser.too_long();
      break;
    }
    if (last) break;
    if (first && used > 0)  // rows are about equally long: one allocation instead of twenty
      parser.reserve(static_cast<std::size_t>(1.05 * static_cast<double>(parser.rows()) *
                                              static_cast<double>(file.size) / static_cast<double>(used)));
    std::memmove(buffer.data(), buffer.data() + used, held);
  }
  return parser.finish();
}

CsvTable parse_csv(const std::string& name, std::string_view text, const std::vector<CsvColumn>& columns) {
  CsvParser parser(name, columns);
  static_cast<void>(feed_lines(parser, text, true));
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
  for (const std::string& comment : comments) buffer_ += "# " + one_line(comment) + '\n';
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
        throw std::domain_error(fmt::format("{}: row {}, {} = {}: not finite, not written", path_.string(),
                                            rows_, columns_[i], *number));
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
