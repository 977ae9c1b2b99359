#include "identification/fitting/legs.hpp"

#include <algorithm>
#include <cmath>

namespace snare::identification {

std::vector<std::size_t> turning_points(const std::vector<double>& d) {
  const auto [low, high] = std::minmax_element(d.begin(), d.end());
  const double threshold = 0.02 * (*high - *low);
  std::vector<std::size_t> turns{0};
  std::size_t extreme = 0;
  double sense = 0.0;
  for (std::size_t i = 1; i < d.size(); ++i) {
    if (sense == 0.0) {
      if (std::abs(d[i] - d[0]) > threshold) sense = d[i] > d[0] ? 1.0 : -1.0;
      if (sense != 0.0) extreme = i;
      continue;
    }
    if ((d[i] - d[extreme]) * sense >= 0.0)
      extreme = i;
    else if ((d[extreme] - d[i]) * sense > threshold) {
      turns.push_back(extreme);
      extreme = i;
      sense = -sense;
    }
  }
  turns.push_back(d.size() - 1);
  return turns;
}

std::vector<Leg> legs_of(const std::vector<double>& displacement) {
  const std::vector<std::size_t> turns = turning_points(displacement);
  std::vector<Leg> result;
  for (std::size_t k = 0; k + 1 < turns.size(); ++k) {
    Leg leg;
    leg.begin = k == 0 ? 0 : turns[k] + 1;
    leg.end = turns[k + 1] + 1;
    const auto [low, high] = std::minmax_element(displacement.begin() + static_cast<std::ptrdiff_t>(turns[k]),
                                                 displacement.begin() + static_cast<std::ptrdiff_t>(leg.end));
    leg.low = *low;
    leg.high = *high;
    leg.up = displacement[leg.end - 1] >= displacement[turns[k]];
    if (leg.end > leg.begin) result.push_back(leg);
  }
  return result;
}

}  // namespace snare::identification
