#include "identification/effects/effect.hpp"

#include <algorithm>
#include <cmath>

namespace snare::identification {

namespace {

Parameter creep_share() {
  return {.key = "creep.share",
          .number = member([](auto&, auto& r) -> auto& { return r.creep; }),
          .limits = [](const PushProblem&) { return between(-0.5, 0.5); },
          .step = 1e-4,
          .derivative = Derivative::record};
}

Parameter creep_time() {
  return {.key = "creep.time_s",
          .unit = "s",
          .parametrisation = Parametrisation::ratio,
          .number = member([](auto&, auto& r) -> auto& { return r.creep_time; }),
          .limits = [](const PushProblem&) { return between(1e-4, 1e7); },
          .step = 1e-3,
          .derivative = Derivative::record};
}

/// A hundredth, within times from two readings to the whole of a series.
std::vector<std::vector<double>> creep_trials(const TrialContext& context) {
  double shortest = 1e7, longest = 0.0;
  for (const Series& s : context.model->series()) {
    if (!s.readings || s.readings->time.size() < 3) continue;
    const double all = s.readings->time.back() - s.readings->time.front();
    longest = std::max(longest, all);
    shortest = std::min(shortest, 2.0 * all / static_cast<double>(s.readings->time.size()));
  }
  std::vector<std::vector<double>> result;
  const double usual = ReadingModel{}.creep_time;
  constexpr double ratio = 3.0;
  for (double at = shortest; shortest > 0.0 && at <= ratio * longest; at *= ratio)
    result.push_back({0.01, std::log(at / usual)});
  return result;
}

}  // namespace

/// The reading creeps under load: after a change of the load it continues to change, by a share of that
/// change.
Effect creep_effect() {
  return {.name = "creep",
          .channel = Channel::sensor,
          .meaning = "the reading creeps after the load has changed, in the load cell or in the wire",
          .numbers = {{creep_share(), -0.3, 0.3}, {creep_time(), 1e-4, 1e6}},
          .trials = creep_trials,
          .unobservable = needs_times,
          .independent_check = "leave a known weight on the load cell for as long as a series takes"};
}

}  // namespace snare::identification
