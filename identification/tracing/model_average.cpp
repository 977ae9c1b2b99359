#include "identification/tracing/model_average.hpp"

#include "identification/fitting/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace snare::identification {

namespace {

/// Where a fit has a number, and its standard error in the coordinate, widened as Student's t is against the
/// normal distribution; absent where it has not, or its readings do not tell.
struct Place {
  double coordinate = 0.0;
  double deviation = 0.0;
};
std::optional<Place> place_of(const Fit& fit, const Parameter& number) {
  for (std::size_t k = 0; k < fit.free; ++k) {
    if (fit.settings[k].parameter != &number) continue;
    const auto i = static_cast<Eigen::Index>(k);
    if (fit.covariance.rows() <= i || !(fit.covariance(i, i) > 0.0)) return std::nullopt;
    const double widened = student_quantile(0.025, fit.noise_dof) / normal_quantile(0.025);
    return Place{fit.settings[k].coordinate, widened * std::sqrt(fit.covariance(i, i))};
  }
  return std::nullopt;
}

/// Where 95 % of the mixture lie, as much below as above; absent where there is nothing to mix.
std::optional<Interval> interval_of(const std::vector<NormalPart>& parts) {
  if (parts.size() < 2) return std::nullopt;
  return Interval{mixture_quantile(parts, 0.025), mixture_quantile(parts, 0.975)};
}

}  // namespace

double mixture_quantile(const std::vector<NormalPart>& parts, double p) {
  double weight = 0.0;
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();
  const double reach = std::abs(normal_quantile(std::min(p, 1.0 - p)));
  for (const NormalPart& part : parts) {
    weight += part.weight;
    low = std::min(low, part.mean - reach * part.deviation);
    high = std::max(high, part.mean + reach * part.deviation);
  }
  const double narrow = 1e-9 * (high - low);
  while (high - low > narrow) {
    const double middle = 0.5 * (low + high);
    double below = 0.0;
    for (const NormalPart& part : parts)
      below += part.weight * normal_tail((part.mean - middle) / part.deviation);
    (below < p * weight ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

std::optional<Interval> interval_over_rivals(const Fit& final, std::size_t which,
                                             const std::vector<RoundFits>& rounds, double inflation) {
  const Parameter& number = *final.settings[which].parameter;
  const std::optional<Place> told = place_of(final, number);
  if (!told) return std::nullopt;
  std::vector<NormalPart> parts{{1.0, told->coordinate, told->deviation}};
  for (const RoundFits& round : rounds) {
    if (round.rivals.empty()) continue;
    const Fit& leader = round.rivals.front();
    const std::optional<Place> from = place_of(leader, number);
    if (!from) continue;
    for (std::size_t k = 1; k < round.rivals.size(); ++k) {
      const std::optional<Place> to = place_of(round.rivals[k], number);
      if (!to) continue;
      parts.push_back({std::exp(-0.5 * (round.rivals[k].bic() - leader.bic()) / inflation),
                       told->coordinate + to->coordinate - from->coordinate,
                       told->deviation * to->deviation / from->deviation});
    }
  }
  return interval_of(parts);
}

std::optional<Interval> interval_over_candidates(const Fit& final, std::size_t which,
                                                 const std::vector<Candidate>& candidates) {
  const std::optional<Place> told = place_of(final, *final.settings[which].parameter);
  if (!told) return std::nullopt;
  std::vector<NormalPart> parts{{1.0, told->coordinate, told->deviation}};
  const auto seen =
      std::ranges::count_if(candidates, [](const Candidate& c) { return c.score.shift.size() > 0; });
  const double price = std::log(static_cast<double>(final.residual.size()));
  for (const Candidate& c : candidates) {
    if (c.score.shift.size() == 0) continue;
    const double shift = c.score.shift[static_cast<Eigen::Index>(which)];
    const auto numbers = static_cast<double>(
        std::ranges::count_if(c.score.effect->numbers, [](const EffectNumber& n) { return !n.optional; }));
    parts.push_back({std::exp(0.5 * (c.score.z * c.score.z - numbers * price)) / static_cast<double>(seen),
                     told->coordinate + c.score.z * shift, std::hypot(told->deviation, shift)});
  }
  return interval_of(parts);
}

}  // namespace snare::identification
