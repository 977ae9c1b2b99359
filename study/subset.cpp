#include "study/subset.hpp"

#include "study/distribution.hpp"
#include "study/random_access.hpp"

#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace snare::study {

namespace {

constexpr double far = -std::numeric_limits<double>::infinity();

double score(std::uint64_t seed, std::uint64_t index, std::size_t dimension) {
  return normal_quantile(hashed_uniform(seed, dimension, index));
}

}  // namespace

SubsetSimulation::SubsetSimulation(const Settings& settings) : settings_(settings) {
  const auto n = static_cast<double>(settings.cases);
  length_ = std::max<std::size_t>(2, static_cast<std::size_t>(std::lround(1.0 / settings.level_probability)));
  seeds_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(n / static_cast<double>(length_))));
  ask();
}

void SubsetSimulation::ask() {
  asked_.clear();
  const std::uint64_t chains = first_ ? seeds_ * length_ : seeds_;
  for (std::uint64_t k = 0; k < chains; ++k) {
    std::vector<double> z(settings_.dimension);
    for (std::size_t d = 0; d < z.size(); ++d) z[d] = score(settings_.seed, told_ + k, d);
    if (!first_) {
      const std::vector<double>& from = chains_[k].back().scores;
      for (std::size_t d = 0; d < z.size(); ++d)
        z[d] = std::sqrt(1.0 - step_ * step_) * from[d] + step_ * z[d];
    }
    asked_.push_back(std::move(z));
  }
}

void SubsetSimulation::tell(const std::vector<std::optional<double>>& margins) {
  assert(margins.size() == asked_.size() && !finished());
  told_ += margins.size();
  if (first_) {
    chains_.clear();
    for (std::size_t k = 0; k < margins.size(); ++k)
      chains_.push_back({State{std::move(asked_[k]), margins[k].value_or(far)}});
    families_.resize(margins.size());
    std::iota(families_.begin(), families_.end(), std::size_t{0});
    end_level();
    return;
  }
  std::size_t kept = 0;
  for (std::size_t k = 0; k < margins.size(); ++k) {
    std::vector<State>& chain = chains_[k];
    const double margin = margins[k].value_or(far);
    if (margin >= threshold_) {
      chain.push_back({std::move(asked_[k]), margin});
      ++kept;
    } else {
      const State last = chain.back();
      chain.push_back(last);
    }
  }
  constexpr double wanted = 0.44;
  const double share = static_cast<double>(kept) / static_cast<double>(margins.size());
  ++steps_;
  step_ = std::clamp(step_ * std::exp((share - wanted) / std::sqrt(static_cast<double>(steps_))), 0.05, 1.0);
  if (chains_.front().size() < length_) {
    ask();
  } else {
    end_level();
  }
}

// gamma of Au, Beck 2001, eq. 25-27: what the correlation of I(margin >= threshold) along the chains adds to
// the variance.
double SubsetSimulation::variation_of(double threshold, double probability) const {
  const auto n = static_cast<double>(seeds_ * length_);
  if (!(probability > 0.0)) return 1.0;
  double gamma = 0.0;
  const std::size_t length = chains_.front().size();
  const double variance = probability * (1.0 - probability);
  for (std::size_t lag = 1; lag < length && variance > 0.0; ++lag) {
    double both = 0.0;
    for (const std::vector<State>& chain : chains_)
      for (std::size_t i = 0; i + lag < length; ++i)
        both += chain[i].margin >= threshold && chain[i + lag].margin >= threshold ? 1.0 : 0.0;
    const double pairs = static_cast<double>((length - lag) * chains_.size());
    const double correlation = (both / pairs - probability * probability) / variance;
    gamma += 2.0 * (1.0 - static_cast<double>(lag) / static_cast<double>(length)) * correlation;
  }
  return std::sqrt(std::max(0.0, (1.0 - probability) / (probability * n) * (1.0 + gamma)));
}

void SubsetSimulation::end_level() {
  std::vector<std::pair<std::size_t, const State*>> states;  // with their families
  for (std::size_t c = 0; c < chains_.size(); ++c)
    for (const State& state : chains_[c]) states.emplace_back(families_[c], &state);
  std::ranges::stable_sort(states,
                           [](const auto& a, const auto& b) { return a.second->margin > b.second->margin; });
  // seeds_ of the states are above it, more where margins are equal.
  const double next = 0.5 * (states[seeds_ - 1].second->margin + states[seeds_].second->margin);
  const double from = first_ ? far : threshold_;
  // Where the margin has few values the next threshold may leave nothing out: then the share of the event is
  // counted as it is.
  const bool stuck = !(next > states.back().second->margin);
  const bool last = states[seeds_ - 1].second->margin >= 0.0 || !std::isfinite(next) || stuck;
  const double threshold = last ? 0.0 : next;
  const auto below =
      std::ranges::find_if(states, [&](const auto& s) { return s.second->margin < threshold; });
  states.erase(below, states.end());
  const double probability = static_cast<double>(states.size()) / static_cast<double>(seeds_ * length_);
  levels_.push_back({from, probability, variation_of(threshold, probability)});
  hits_ = states.size();
  std::map<std::size_t, double> members;
  for (const auto& [family, state] : states) members[family] += 1.0;
  family_squares_ = 0.0;
  for (const auto& [family, count] : members)
    family_squares_ += std::pow(count / static_cast<double>(hits_), 2);
  threshold_interval_ = interval_of_threshold();
  reached_ = last && hits_ > 0;
  if (last || static_cast<int>(levels_.size()) >= settings_.most_levels)
    asked_.clear();
  else
    begin_level(states, threshold);
}

// Of more states than seeds, by margin, every so-manieth: their margins are distributed as those of all.
void SubsetSimulation::begin_level(const std::vector<std::pair<std::size_t, const State*>>& above,
                                   double threshold) {
  std::vector<std::vector<State>> seeds;
  std::vector<std::size_t> families;
  for (std::size_t k = 0; k < seeds_; ++k) {
    const auto& [family, state] = above[(2 * k + 1) * above.size() / (2 * seeds_)];
    seeds.push_back({*state});
    families.push_back(family);
  }
  chains_ = std::move(seeds);
  families_ = std::move(families);
  threshold_ = threshold;
  first_ = false;
  steps_ = 0;
  ask();
}

double SubsetSimulation::probability() const noexcept {
  double p = 1.0;
  for (const Level& level : levels_) p *= level.probability;
  return p;
}

// Thresholds taken as given, the probability is the mean of independent contributions, one a case of the
// first level: the cases of the last level that descend from it, w of all of them. Its relative variance is
// sum w^2 - 1/n.
double SubsetSimulation::variation() const noexcept {
  if (hits_ == 0) return 1.0;
  return std::sqrt(std::max(0.0, family_squares_ - 1.0 / static_cast<double>(seeds_ * length_)));
}

ProbabilityInterval SubsetSimulation::interval() const {
  return {reached_ ? threshold_interval_.low : 0.0, threshold_interval_.high};
}

ProbabilityInterval SubsetSimulation::interval_of_threshold() const {
  if (levels_.size() == 1) return proportion_interval(hits_, seeds_ * length_);
  if (hits_ == 0) return {0.0, threshold_interval_.high};  // no more probable than the threshold before
  constexpr double tail = 0.025;
  // the mean is over all cases of the first level and costs none of them
  const double freedom = 1.0 / family_squares_;
  const double t = boost::math::quantile(boost::math::complement(boost::math::students_t(freedom), tail));
  const double factor = std::exp(t * std::sqrt(std::log1p(variation() * variation())));
  return {probability() / factor, std::min(1.0, probability() * factor)};
}

}  // namespace snare::study
