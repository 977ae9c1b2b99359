#include "python/convert.hpp"

#include <pybind11/stl/filesystem.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string_view>
#include <utility>
#include <variant>

namespace snare::python {

namespace py = pybind11;
using nlohmann::json;

namespace {

py::object array_of(const json& array) {
  const auto all = [&array](auto is) { return !array.empty() && std::ranges::all_of(array, is); };
  if (all([](const json& one) { return one.is_number_integer(); })) {
    py::array_t<std::int64_t> whole(static_cast<py::ssize_t>(array.size()));
    for (std::size_t k = 0; k < array.size(); ++k)
      whole.mutable_at(static_cast<py::ssize_t>(k)) = array[k].get<std::int64_t>();
    return whole;
  }
  if (all([](const json& one) { return one.is_number(); })) return to_array(array.get<std::vector<double>>());
  py::list list;
  for (const json& one : array) list.append(to_python(one));
  return list;
}

}  // namespace

py::object to_python(const json& document) {
  switch (document.type()) {
    case json::value_t::object: {
      py::dict result;
      for (const auto& [key, value] : document.items()) result[py::str(key)] = to_python(value);
      return result;
    }
    case json::value_t::array:
      return array_of(document);
    case json::value_t::string:
      return py::str(document.get<std::string>());
    case json::value_t::boolean:
      return py::bool_(document.get<bool>());
    case json::value_t::number_integer:
    case json::value_t::number_unsigned:
      return py::int_(document.get<std::int64_t>());
    case json::value_t::number_float:
      return py::float_(document.get<double>());
    default:
      return py::none();
  }
}

std::filesystem::path path_of(const py::object& given, const char* name) {
  if (py::isinstance<py::str>(given) || py::isinstance<py::bytes>(given) || py::hasattr(given, "__fspath__"))
    return given.cast<std::filesystem::path>();
  throw py::type_error(std::string(name) + " = " + std::string(py::repr(given)) +
                       ", must be the path of a file: text or os.PathLike");
}

py::array_t<double> to_array(std::vector<double> numbers) {
  auto kept = std::make_unique<std::vector<double>>(std::move(numbers));
  const std::vector<double>& held = *kept;
  py::capsule owner(kept.release(), [](void* it) { delete static_cast<std::vector<double>*>(it); });
  return py::array_t<double>(static_cast<py::ssize_t>(held.size()), held.data(), owner);
}

void ColumnSink::begin(std::vector<std::string> names) {
  for (std::string& name : names) columns_.push_back({std::move(name), {}, {}});
}

void ColumnSink::row(const std::vector<base::CsvCell>& cells) {
  for (std::size_t k = 0; k < cells.size(); ++k) {
    Column& column = columns_[k];
    if (const auto* text = std::get_if<std::string_view>(&cells[k])) {
      column.texts.emplace_back(*text);
    } else if (const auto* count = std::get_if<long long>(&cells[k])) {
      column.numbers.push_back(static_cast<double>(*count));
    } else {
      const auto* number = std::get_if<double>(&cells[k]);
      column.numbers.push_back(number != nullptr ? *number : std::numeric_limits<double>::quiet_NaN());
    }
  }
}

py::dict ColumnSink::take() {
  py::dict result;
  for (Column& column : columns_) {
    if (column.texts.empty()) {
      result[py::str(column.name)] = to_array(std::move(column.numbers));
      continue;
    }
    py::list texts;
    for (const std::string& text : column.texts) texts.append(text);
    result[py::str(column.name)] = texts;
  }
  columns_.clear();
  return result;
}

}  // namespace snare::python
