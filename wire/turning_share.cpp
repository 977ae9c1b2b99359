#include "wire/turning_share.hpp"

#include <cmath>

namespace snare::wire {

// 2 u f' = 1/(1 + u) - f,   2 u f'' = -1/(1 + u)^2 - 3 f'.
TurningShare<double> turning::of_any(double u) {
  if (u < series) return of_small(u);
  const double r = std::sqrt(u);
  const double value = std::atan(r) / r;
  const double first = (1.0 / (1.0 + u) - value) / (2.0 * u);
  return {value, first, (-1.0 / ((1.0 + u) * (1.0 + u)) - 3.0 * first) / (2.0 * u)};
}

}  // namespace snare::wire
