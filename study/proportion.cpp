#include "study/proportion.hpp"

#include <boost/math/distributions/beta.hpp>

namespace snare::study {

ProbabilityInterval proportion_interval(std::uint64_t hits, std::uint64_t cases) {
  constexpr double tail = 0.025;
  const auto k = static_cast<double>(hits);
  const auto n = static_cast<double>(cases);
  ProbabilityInterval interval;
  if (hits > 0 && cases > 0)
    interval.low = boost::math::quantile(boost::math::beta_distribution<>(k, n - k + 1.0), tail);
  if (hits < cases)
    interval.high = boost::math::quantile(boost::math::beta_distribution<>(k + 1.0, n - k), 1.0 - tail);
  return interval;
}

}  // namespace snare::study
