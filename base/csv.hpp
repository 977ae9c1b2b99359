#pragma once

#include "base/csv_column.hpp"
#include "base/files.hpp"

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace snare::base {

/// The columns that were asked for, in the order in which they were asked for, in SI units.
struct CsvTable {
  std::vector<std::vector<double>> columns;  ///< a column that is optional and absent is empty
  std::size_t rows = 0;
};

/// Reads the asked columns of a CSV file of any length in one pass and with a buffer of about 1 MiB.
///
/// The first line that names all required columns is the header; lines above it (titles of a testing machine,
/// "sep=;") are passed over. Cells are separated by commas, semicolons, tabs or blanks, as the header is;
/// they may have blanks around them and stand in double quotes (no line breaks inside). The line below the
/// header may give units. `#` starts a comment, on its own line or after the cells. Blank lines, rows of
/// empty cells, empty cells after the last column, a byte order mark and line ends of CR, LF or CRLF are
/// accepted; the text must be UTF-8. Columns that nobody asked for are not looked at; one may be asked for
/// several times. Numbers are finite, with a decimal point, or all with a decimal comma that cannot be taken
/// for a separator of thousands. Throws InputError (file, line, column, text, what is allowed) with at most
/// csv_problem_limit problems.
[[nodiscard]] CsvTable read_csv(const std::filesystem::path& path, const std::vector<CsvColumn>& columns);

/// The same from text in memory; `name` stands for the file in messages.
[[nodiscard]] CsvTable parse_csv(const std::string& name, std::string_view text,
                                 const std::vector<CsvColumn>& columns);

inline constexpr std::size_t csv_problem_limit = 20;
inline constexpr std::size_t csv_line_limit = 1u << 20u;  ///< longest line [byte]

/// One cell of a result file: nothing (an empty cell), a number, a count, or text.
using CsvCell = std::variant<std::monostate, double, long long, std::string_view>;

/// Writes a result file row by row; it appears under its name with `commit()` (see AtomicFile).
/// Numbers are written with the fewest digits that read back to the same double.
class CsvWriter {
 public:
  /// `comments` become lines that start with "# ", ahead of the header.
  CsvWriter(const std::filesystem::path& path, std::vector<std::string> columns,
            const std::vector<std::string>& comments = {});

  /// As many cells as there are columns. Throws std::domain_error, naming file, row and column, when a number
  /// is not finite: a NaN never reaches a result file.
  void row(std::initializer_list<CsvCell> cells) { row(std::vector<CsvCell>(cells)); }
  void row(const std::vector<CsvCell>& cells);

  /// Waits until all rows are on the disk and gives the file its name. To be called once, no row after it;
  /// throws std::system_error.
  void commit();

 private:
  std::filesystem::path path_;
  std::vector<std::string> columns_;
  AtomicFile file_;
  std::string buffer_;
  std::size_t rows_ = 0;
};

}  // namespace snare::base
