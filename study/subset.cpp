#include "study/subset.hpp"

#include "study/distribution.hpp"
#include "study/random_access.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
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
      for (std::size_t d = 0; d < z.size(); ++d) z[d] = std::sqrt(1.0 - step_ * step_) * from[d] + step_ * z[d];
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

// gamma of Au, Beck 2001, eq. 25-27: what the correlation of I(margin >= threshold) along the chains adds to the variance.
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
  std::vector<const State*> states;
  for (const std::vector<State>& chain : chains_)
    for (const State& state : chain) states.push_back(&state);
  std::ranges::stable_sort(states, [](const State* a, const State* b) { return a->margin > b->margin; });
  const double next = 0.5 * (states[seeds_ - 1]->margin + states[seeds_]->margin);  // seeds_ of the states are above it
  const bool last = states[seeds_ - 1]->margin >= 0.0 || !std::isfinite(next);
  const double threshold = last ? 0.0 : next;
  const auto above = std::ranges::count_if(states, [&](const State* s) { return s->margin >= threshold; });
  const double probability = static_cast<double>(above) / static_cast<double>(states.size());
  const double from = first_ ? far : threshold_;
  levels_.push_back({from, probability, variation_of(threshold, probability)});
  reached_ = last && above > 0;
  const bool stuck = !last && !first_ && !(next > threshold_);  // a margin of few values
  if (last || stuck || static_cast<int>(levels_.size()) >= settings_.most_levels) {
    asked_.clear();
    return;
  }
  std::vector<std::vector<State>> seeds;
  for (std::size_t k = 0; k < seeds_; ++k) seeds.push_back({*states[k]});
  chains_ = std::move(seeds);
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

double SubsetSimulation::variation() const noexcept {
  double squares = 0.0;
  for (const Level& level : levels_) squares += level.variation * level.variation;
  return std::sqrt(squares);
}

}  // namespace snare::study
