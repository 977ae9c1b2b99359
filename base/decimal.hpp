#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

namespace snare::base {

/// Whether value > limit, where one of them follows from decimal numbers by a few operations: a length of 180
/// mm less a span of 179.51 mm is 0.49 mm, but in binary 1e-17 m more. Numbers within 8 units in the last
/// place of the largest of the two and of `terms`, of which they are sums, are equal. All have one unit [m,
/// or any other]. False with a NaN.
[[nodiscard]] inline bool exceeds(double value, double limit, std::initializer_list<double> terms = {}) {
  double scale = std::max(std::abs(value), std::abs(limit));
  for (const double term : terms) scale = std::max(scale, std::abs(term));
  return value > limit + 8.0 * std::numeric_limits<double>::epsilon() * scale;
}

}  // namespace snare::base
