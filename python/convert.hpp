#pragma once

#include "results/result_table.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace snare::python {

/// A document as Python has it: objects are dictionaries, arrays of numbers alone NumPy arrays (of whole
/// numbers where all are), other arrays lists, null None.
[[nodiscard]] pybind11::object to_python(const nlohmann::json& document);

/// The path that a text or an os.PathLike names. Throws TypeError for anything else, naming the argument.
[[nodiscard]] std::filesystem::path path_of(const pybind11::object& given, const char* name);

/// A NumPy array that takes the numbers over without a copy.
[[nodiscard]] pybind11::array_t<double> to_array(std::vector<double> numbers);

/// Keeps a table of results as columns.
class ColumnSink final : public results::TableSink {
 public:
  void begin(std::vector<std::string> names) override;
  void row(const std::vector<base::CsvCell>& cells) override;

  /// A dictionary by the columns' names: arrays, NaN where a cell is empty; lists of text.
  [[nodiscard]] pybind11::dict take();

 private:
  struct Column {
    std::string name;
    std::vector<double> numbers;
    std::vector<std::string> texts;
  };
  std::vector<Column> columns_;
};

}  // namespace snare::python
