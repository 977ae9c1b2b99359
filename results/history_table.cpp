#include "results/history_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <variant>

namespace snare::results {

namespace {

/// Ends of names that are units, and how the unit is written; a longer one stands before those that it ends
/// in.
constexpr std::pair<std::string_view, std::string_view> endings[] = {
    {"rad_s", "rad/s"}, {"deg_s", "deg/s"}, {"m_s2", "m/s^2"}, {"mm_s", "mm/s"}, {"m_s", "m/s"},
    {"N_mm", "N/mm"},   {"N_m", "N/m"},     {"Nms", "N m s"},  {"Nm", "N m"},    {"Ns", "N s"},
    {"mm", "mm"},       {"deg", "deg"},     {"rad", "rad"},    {"MPa", "MPa"},   {"J", "J"},
    {"W", "W"},         {"N", "N"},         {"m", "m"},        {"s", "s"}};

}  // namespace

void HistoryTable::begin(std::vector<std::string> names) {
  names_ = std::move(names);
  const std::vector<std::string>& kept = wanted_.empty() ? names_ : wanted_;
  for (const std::string& name : kept) {
    const auto found = std::ranges::find(names_, name);
    if (found == names_.end()) {
      if (missing_.empty()) missing_ = name;
      continue;
    }
    from_.push_back(static_cast<std::size_t>(found - names_.begin()));
    history_.columns.push_back({name, {}, {}});
  }
}

void HistoryTable::row(const std::vector<base::CsvCell>& cells) {
  const auto* run = std::get_if<std::string_view>(&cells.front());
  if (run != nullptr && *run != run_) {
    run_ = *run;
    since_ = 0;
  }
  const bool kept = since_ == 0;
  since_ = (since_ + 1) % every_;
  if (!kept) return;
  for (std::size_t k = 0; k < from_.size(); ++k) {
    HistoryColumn& column = history_.columns[k];
    const base::CsvCell& cell = cells[from_[k]];
    if (const auto* text = std::get_if<std::string_view>(&cell)) {
      column.texts.emplace_back(*text);
    } else if (const auto* count = std::get_if<long long>(&cell)) {
      column.numbers.push_back(static_cast<double>(*count));
    } else if (const auto* number = std::get_if<double>(&cell)) {
      if (!std::isfinite(*number))
        throw std::domain_error(fmt::format("history: {} is {}", column.name, *number));
      column.numbers.push_back(*number);
    } else {
      column.numbers.push_back(std::numeric_limits<double>::quiet_NaN());
    }
  }
}

std::string unit_of_column(const std::string& name) {
  for (const auto& [ending, unit] : endings) {
    if (!name.ends_with(ending)) continue;
    const std::size_t before = name.size() - ending.size();
    if (before > 0 && (name[before - 1] == '_' || name[before - 1] == ' ')) return std::string(unit);
  }
  return {};
}

}  // namespace snare::results
