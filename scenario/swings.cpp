#include "scenario/swings.hpp"

#include <cmath>
#include <cstddef>
#include <optional>

namespace snare::scenario {

std::vector<Swing> swings(const std::vector<SwingSample>& samples) {
  std::vector<Swing> found;
  std::optional<double> last_zero;
  double peak = 0.0;
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    const SwingSample& a = samples[i];
    const SwingSample& b = samples[i + 1];
    const double h = b.time - a.time;
    const double da = a.deflection, db = b.deflection;
    const double va = h * a.rate, vb = h * b.rate;
    const auto cubic = [&](double s) {
      return (1 + 2 * s) * (1 - s) * (1 - s) * da + s * (1 - s) * (1 - s) * va + s * s * (3 - 2 * s) * db -
             s * s * (1 - s) * vb;
    };
    if (std::abs(da) > std::abs(peak)) peak = da;
    if (va * vb < 0.0 && da * va > 0.0) {  // an extreme between the samples
      double s = va / (va - vb);
      if (std::abs(cubic(s)) > std::abs(peak)) peak = cubic(s);
    }
    if (!((da < 0.0) != (db < 0.0))) continue;
    double low = 0.0, high = 1.0;
    for (int k = 0; k < 50; ++k) {
      const double middle = 0.5 * (low + high);
      ((cubic(middle) < 0.0) == (da < 0.0) ? low : high) = middle;
    }
    const double zero = a.time + h * low;
    if (last_zero) found.push_back({*last_zero, zero, peak});
    last_zero = zero;
    peak = 0.0;
  }
  return found;
}

}  // namespace snare::scenario
