#pragma once

#include <nlohmann/json.hpp>

#include <cmath>
#include <optional>

namespace snare::results {

/// The number, in its unit, or null where there is none or none that JSON has.
[[nodiscard]] inline nlohmann::json finite(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}
[[nodiscard]] inline nlohmann::json finite(const std::optional<double>& value) {
  return value ? finite(*value) : nlohmann::json();
}

}  // namespace snare::results
