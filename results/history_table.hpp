#pragma once

#include "results/result_table.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace snare::results {

/// A column of a history: numbers, NaN where a cell is empty, or texts.
struct HistoryColumn {
  std::string name;             ///< ends in the unit, as in history.csv
  std::vector<double> numbers;  ///< in that unit, as in history.csv; none where the column is one of texts
  std::vector<std::string> texts;
};

/// What is kept of the table of a run.
struct History {
  std::vector<HistoryColumn> columns;
};

/// What a column is, for base/archive.hpp.
template <class Archive>
void fields(Archive& archive, HistoryColumn& column) {
  archive(column.name)(column.numbers)(column.texts);
}
template <class Archive>
void fields(Archive& archive, History& history) {
  archive(history.columns);
}

/// Takes some columns and rows of a table of results.
class HistoryTable final : public TableSink {
 public:
  /// columns: by name, in the order in which they are kept; none: all. every: of so many rows the first is
  /// kept, counted again where the first cell is another text than before: of a run or a series that follows
  /// another.
  HistoryTable(std::vector<std::string> columns, int every) : wanted_(std::move(columns)), every_(every) {}

  void begin(std::vector<std::string> names) override;
  /// Throws std::domain_error for a number that is not finite: none reaches a result file.
  void row(const std::vector<base::CsvCell>& cells) override;

  /// Names of all columns of the table, kept or not.
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }
  /// The first that was asked for and that the table does not have; empty: there is none.
  [[nodiscard]] const std::string& missing() const noexcept { return missing_; }
  /// What was kept.
  [[nodiscard]] History& history() noexcept { return history_; }

 private:
  std::vector<std::string> wanted_, names_;
  int every_;
  std::string missing_;
  std::vector<std::size_t> from_;  // where the kept columns are in a row
  std::string run_;                // the first cell of the rows so far
  int since_ = 0;                  // rows since the last that was kept
  History history_;
};

/// The unit that the name of a column ends in, as it is written: "m/s" of "body_vx_m_s"; empty where it ends
/// in none.
[[nodiscard]] std::string unit_of_column(const std::string& name);

}  // namespace snare::results
