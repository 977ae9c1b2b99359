#pragma once

#include <limits>
#include <string>

namespace snare::base {

/// Admissible interval of a number, in the unit in which the user writes it. NaN is never inside; an
/// infinite bound is no bound, but infinity itself is never inside either.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool includes_low = true;

  /// Every finite number.
  [[nodiscard]] static Range finite() { return {}; }
  /// low < x <= high, both in the unit in which the user writes the number.
  [[nodiscard]] static Range above(double low, double high = std::numeric_limits<double>::infinity()) {
    return {low, high, false};
  }
  /// low <= x <= high, in the same unit.
  [[nodiscard]] static Range from(double low, double high = std::numeric_limits<double>::infinity()) {
    return {low, high, true};
  }

  /// Whether a finite value, in the same unit, lies in the interval.
  [[nodiscard]] bool contains(double value) const noexcept;

  /// "> 0 and <= 100"; empty for every finite number.
  [[nodiscard]] std::string phrase() const;
};

/// `value` written in a unit of `unit` SI units (1e-3 for mm), in SI. Divides by 1000 where the unit is
/// 1e-3, so that 180 mm is the double nearest to 0.18.
[[nodiscard]] constexpr double to_si(double value, double unit) noexcept {
  return unit < 1.0 ? value / (1.0 / unit) : value * unit;
}

}  // namespace snare::base
