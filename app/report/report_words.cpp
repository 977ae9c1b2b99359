#include "app/report/report_words.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace snare::app {

std::optional<double> known(std::optional<double> value) {
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::string measured(std::optional<double> value, const std::string& unit) {
  return known(value) ? format_significant(*value) + unit : absent;
}

std::string shown(std::optional<double> value, int digits) {
  return known(value) ? format_number(*value, digits) : absent;
}

std::string percent(std::optional<double> share) {
  if (!known(share)) return absent;
  if (*share < -1.0) return "< -100 %";
  return format_number(100.0 * *share, 2) + " %";
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
  value = known(value);
  lower = known(lower);
  upper = known(upper);
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

std::vector<Cell> value_cells(const identification::FittedNumber& number) {
  using identification::AtBound;
  std::vector<Cell> cells = value_cells(number.value, number.lower, number.upper);
  if (number.bound != AtBound::none)
    cells[0].text += number.bound == AtBound::lower ? " (its lower bound)" : " (its upper bound)";
  if (!number.identified) cells[1].text = "not determined";
  return cells;
}

}  // namespace snare::app
