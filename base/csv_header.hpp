#pragma once

#include "base/csv_column.hpp"
#include "base/errors.hpp"
#include "base/unit_names.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace snare::base {

/// The line of a CSV file that names the columns.
struct CsvHeader {
  /// Of the cells: comma, semicolon, tab, or a blank for any number of blanks and tabs.
  char separator = ',';
  std::vector<std::string> names;
};

/// The cell that starts at line[at], without blanks and quotes around it; moves `at` behind its separator, or
/// to npos behind the last cell.
[[nodiscard]] std::string_view next_cell(std::string_view line, char separator, std::size_t& at) noexcept;
/// All cells of a line.
[[nodiscard]] std::vector<std::string> cells_of(std::string_view line, char separator);

/// The separator that a first line "sep=;" declares, as spreadsheets write it.
[[nodiscard]] std::optional<char> declared_separator(std::string_view line) noexcept;
/// The header that a line is when it names all required columns. separator: the declared one; without, the
/// first that fits.
[[nodiscard]] std::optional<CsvHeader> header_of(std::string_view line, std::optional<char> separator,
                                                 std::span<const CsvColumn> columns);
/// Whether a line holds numbers alone, whatever the separator.
[[nodiscard]] bool holds_numbers(std::string_view line);

/// The first lines of a file, with their numbers, up to the first of numbers alone.
using CsvLines = std::vector<std::pair<int, std::string>>;
inline constexpr std::size_t csv_header_limit = 60;  ///< lines among which the header is looked for

/// Problems of a file of which none of the first lines names all required columns: the columns that there
/// are, the nearest one, and the change to make. file: for messages.
[[nodiscard]] std::vector<InputProblem> missing_columns(const std::string& file, const CsvLines& lines,
                                                        std::optional<char> separator,
                                                        std::span<const CsvColumn> columns);

/// What is wrong with a column by the unit that the file gives it, in the header or in the line below it;
/// nothing where the unit is that of the column's meaning, or `scale` is declared.
[[nodiscard]] std::optional<std::string> unit_problem(const CsvColumn& column, const NamedUnit& found);

}  // namespace snare::base
