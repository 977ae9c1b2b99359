#include "base/json_fields.hpp"

#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace snare::base::json_fields {

using nlohmann::json;

namespace {

[[noreturn]] void wrong_type(const std::string& key, const char* expected, const json& value) {
  throw std::invalid_argument(fmt::format("{} is {}, must be {}", key, value.type_name(), expected));
}

}  // namespace

const json& member(const json& object, const std::string& key) {
  static const json null;
  if (!object.is_object()) return null;
  const auto found = object.find(key);
  return found == object.end() ? null : *found;
}

std::optional<double> number(const json& object, const std::string& key) {
  const json& value = member(object, key);
  if (value.is_null()) return std::nullopt;
  if (!value.is_number()) wrong_type(key, "a number", value);
  return value.get<double>();
}

std::string text(const json& object, const std::string& key, const std::string& otherwise) {
  const json& value = member(object, key);
  if (value.is_null()) return otherwise;
  if (!value.is_string()) wrong_type(key, "a text", value);
  return value.get<std::string>();
}

const json& array(const json& object, const std::string& key) {
  static const json empty = json::array();
  const json& value = member(object, key);
  if (value.is_null()) return empty;
  if (!value.is_array()) wrong_type(key, "an array", value);
  return value;
}

std::vector<double> numbers(const json& object, const std::string& key) {
  std::vector<double> values;
  for (const json& value : array(object, key)) {
    if (value.is_null()) break;
    if (!value.is_number()) wrong_type(key, "an array of numbers", value);
    values.push_back(value.get<double>());
  }
  return values;
}

std::vector<std::string> texts(const json& object, const std::string& key) {
  std::vector<std::string> result;
  for (const json& value : array(object, key)) {
    if (value.is_null()) continue;
    if (!value.is_string()) wrong_type(key, "an array of texts", value);
    result.push_back(value.get<std::string>());
  }
  return result;
}

}  // namespace snare::base::json_fields
