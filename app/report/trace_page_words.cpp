#include "app/report/trace_page_words.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace snare::app::trace_page {

using base::json_fields::array;
using base::json_fields::member;
using base::json_fields::texts;

void require_finite(const json& value, const std::string& key) {
  if (value.is_number_float() && !std::isfinite(value.get<double>())) {
    throw std::invalid_argument(fmt::format("{} = {}, must be finite", key, value.get<double>()));
  }
  if (!value.is_structured()) return;
  for (const auto& item : value.items()) require_finite(item.value(), value.is_object() ? item.key() : key);
}

void require(bool right, const std::string& key, const char* expected, const json& value) {
  if (!right)
    throw std::invalid_argument(fmt::format("{} is {}, must be {}", key, value.type_name(), expected));
}

const json& object(const json& parent, const std::string& key) {
  const json& value = member(parent, key);
  require(value.is_null() || value.is_object(), key, "an object", value);
  return value;
}

std::optional<bool> flag(const json& parent, const std::string& key) {
  const json& value = member(parent, key);
  require(value.is_null() || value.is_boolean(), key, "true or false", value);
  return value.is_null() ? std::nullopt : std::optional(value.get<bool>());
}

const json& objects(const json& parent, const std::string& key) {
  for (const json& value : array(parent, key))
    require(value.is_null() || value.is_object(), key, "an array of objects", value);
  return array(parent, key);
}

std::vector<Words> text_lists(const json& parent, const std::string& key) {
  std::vector<Words> lists;
  for (const json& value : array(parent, key)) lists.push_back(texts({{key, value}}, key));
  return lists;
}

std::string measured(std::optional<double> value, const std::string& unit) {
  return value ? format_significant(*value) + unit : absent;
}
std::string shown(std::optional<double> value, int digits) {
  return value ? format_number(*value, digits) : absent;
}

std::string percent(std::optional<double> share) {
  if (share && *share < -1.0) return "< -100 %";
  return share ? format_number(100.0 * *share, 2) + " %" : absent;
}

Cell yes_no(std::optional<bool> value, Tone yes, Tone no) {
  if (!value) return absent;
  return {*value ? "yes" : "no", *value ? yes : no};
}

std::string joined(const Words& words, const char* last) {
  if (words.size() < 2) return words.empty() ? "" : words.front();
  return fmt::format("{}{}{}", fmt::join(words.begin(), words.end() - 1, ", "), last, words.back());
}

std::string spaced(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

std::pair<std::string, std::string> name_and_unit(const std::string& key) {
  static const std::vector<std::pair<std::string, std::string>> units = {{"_rad_Nm", "rad/(N m)"},
                                                                         {"_kg_m3", "kg/m\u00b3"},
                                                                         {"_m_s2", "m/s\u00b2"},
                                                                         {"_Nm2", "N m\u00b2"},
                                                                         {"_m_N", "m/N"},
                                                                         {"_1_m", "1/m"},
                                                                         {"_GPa", "GPa"},
                                                                         {"_MPa", "MPa"},
                                                                         {"_deg", "\u00b0"},
                                                                         {"_mm", "mm"},
                                                                         {"_N", "N"},
                                                                         {"_s", "s"}};
  const std::string name = key.substr(key.rfind('.') + 1);
  for (const auto& [suffix, unit] : units) {
    if (name.ends_with(suffix)) return {spaced(name.substr(0, name.size() - suffix.size())), unit};
  }
  return {spaced(name), ""};
}

std::vector<Cell> value_cells(std::optional<double> value, std::optional<double> lower,
                              std::optional<double> upper) {
  const double width = lower && upper ? std::abs(*upper - *lower) : 0.0;
  const auto show = [&](double v) {
    if (v == 0.0 || width <= 0.0) return format_number(v, 4);
    const double digits = std::floor(std::log10(std::abs(v))) - std::floor(std::log10(width)) + 2.0;
    return format_significant(v, static_cast<int>(std::clamp(digits, 2.0, 9.0)));
  };
  if (!value) return {absent, absent};
  if (lower && upper) return {show(*value), show(*lower) + " to " + show(*upper)};
  return {show(*value), lower ? "from " + show(*lower) : upper ? "up to " + show(*upper) : absent};
}

Column number_column(std::string heading) {
  return {std::move(heading), ColumnKind::number};
}

}  // namespace snare::app::trace_page
