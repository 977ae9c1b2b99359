#include "study/benchmark_score.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace snare::study {

namespace {

void check(const Track& track) {
  if (track.x.size() < 2 || track.x.size() != track.q.size())
    throw std::invalid_argument("must have at least two rows");
  if (!std::ranges::is_sorted(track.x)) throw std::invalid_argument("must not go back in its first column");
}

/// Straight between rows; the last of rows at the same x.
double value_at(const Track& track, double x) {
  const auto above = std::ranges::upper_bound(track.x, x);
  const auto k = static_cast<std::size_t>(above - track.x.begin());
  if (k == 0) return track.q.front();
  if (k == track.x.size()) return track.q.back();
  const double share = (x - track.x[k - 1]) / (track.x[k] - track.x[k - 1]);
  return track.q[k - 1] + share * (track.q[k] - track.q[k - 1]);
}

/// The rows of a track from `low` to `high`, with rows at both.
Track part(const Track& track, double low, double high) {
  Track cut{{low}, {value_at(track, low)}};
  for (std::size_t k = 0; k < track.x.size(); ++k) {
    if (track.x[k] <= low || track.x[k] >= high) continue;
    cut.x.push_back(track.x[k]);
    cut.q.push_back(track.q[k]);
  }
  cut.x.push_back(high);
  cut.q.push_back(value_at(track, high));
  return cut;
}

double largest(const Track& track) {
  double most = 0.0;
  for (const double q : track.q) most = std::max(most, std::abs(q));
  return most;
}

/// Trapezoidal integral of f(q) over x.
template <class Function>
double integral_of(const Track& track, const Function& f) {
  double sum = 0.0;
  for (std::size_t k = 1; k < track.x.size(); ++k)
    sum += 0.5 * (track.x[k] - track.x[k - 1]) * (f(track.q[k]) + f(track.q[k - 1]));
  return sum;
}

/// a/b; nothing over nothing is nothing.
double ratio(double a, double b) {
  return a == 0.0 && b == 0.0 ? 0.0 : a / b;
}

}  // namespace

std::optional<double> first_reach(const Track& track, double threshold) {
  for (std::size_t k = 0; k < track.x.size(); ++k) {
    const double now = std::abs(track.q[k]);
    if (now < threshold) continue;
    if (k == 0) return track.x[k];
    const double before = std::abs(track.q[k - 1]);
    return track.x[k - 1] + (track.x[k] - track.x[k - 1]) * (threshold - before) / (now - before);
  }
  return std::nullopt;
}

TrackScore score_of(const Track& track, const Track& reference, std::optional<double> threshold) {
  check(track);
  check(reference);
  const double low = std::max(track.x.front(), reference.x.front()),
               high = std::min(track.x.back(), reference.x.back());
  const double range = reference.x.back() - reference.x.front();
  if (!(high > low)) throw std::invalid_argument("has nothing in the range of the reference");
  TrackScore score;
  score.covered = std::min(1.0, (high - low) / range);
  const Track mine = part(track, low, high), whole = part(reference, low, high);
  score.peak = ratio(largest(mine) - largest(whole), largest(whole));
  const auto itself = [](double q) { return q; };
  const auto size = [](double q) { return std::abs(q); };
  score.integral = ratio(integral_of(mine, itself) - integral_of(whole, itself), integral_of(whole, size));
  // On the rows of the reference and of the track.
  Track apart;
  apart.x.resize(mine.x.size() + whole.x.size());
  std::ranges::merge(mine.x, whole.x, apart.x.begin());
  for (const double x : apart.x) apart.q.push_back(value_at(mine, x) - value_at(whole, x));
  const auto square = [](double q) { return q * q; };
  score.rms = std::sqrt(ratio(integral_of(apart, square), integral_of(whole, square)));
  if (threshold) {
    const std::optional<double> touch = first_reach(mine, *threshold),
                                expected = first_reach(whole, *threshold);
    score.same_touch = touch.has_value() == expected.has_value();
    if (touch && expected) score.touch = *touch - *expected;
  }
  return score;
}

}  // namespace snare::study
