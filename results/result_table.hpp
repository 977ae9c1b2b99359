#pragma once

#include "base/csv.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace snare::results {

/// Takes a table of results: the names of its columns once, then its rows.
class TableSink {
 public:
  virtual ~TableSink() = default;
  TableSink(const TableSink&) = delete;
  TableSink& operator=(const TableSink&) = delete;

  virtual void begin(std::vector<std::string> names) = 0;  ///< names of the columns, once
  /// As many cells as there are columns.
  virtual void row(const std::vector<base::CsvCell>& cells) = 0;

 protected:
  TableSink() = default;
};

/// The table as a CSV file, which appears with `commit()`.
class CsvSink final : public TableSink {
 public:
  explicit CsvSink(std::filesystem::path file) : file_(std::move(file)) {}

  void begin(std::vector<std::string> names) override { writer_.emplace(file_, std::move(names)); }
  void row(const std::vector<base::CsvCell>& cells) override { writer_->row(cells); }
  void commit() { writer_->commit(); }  ///< the file is whole

 private:
  std::filesystem::path file_;
  std::optional<base::CsvWriter> writer_;
};

}  // namespace snare::results
