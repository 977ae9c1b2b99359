#include "identification/effects/slip_tension.hpp"

#include <cmath>

namespace snare::identification {

std::vector<std::vector<double>> trial_slip_tensions(const TrialContext& context) {
  std::vector<std::vector<double>> result;
  for (const double share : {0.2, 0.4, 0.6, 0.75, 0.9}) {
    const double tension = share * context.highest_tension;
    if (tension > 1.02 * context.highest_compression) result.push_back({std::log(tension)});
  }
  return result;
}

std::string needs_mounts_that_hold(const std::vector<Series>& series) {
  for (const Series& s : series) {
    if (s.test.mount.slip_tension) return "a mount of this model slips already";
  }
  return needs_mounts(series);
}

}  // namespace snare::identification
