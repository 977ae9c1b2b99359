#include "identification/fitting/conditions.hpp"

#include "identification/fitting/prediction.hpp"

#include <algorithm>
#include <cmath>

namespace snare::identification {

namespace {

bool same_test(const coupling::PushProblem& a, const coupling::PushProblem& b) {
  return a.contact_position == b.contact_position && a.mount.kind == b.mount.kind &&
         a.mount.span == b.mount.span && a.mount.support_radius == b.mount.support_radius &&
         a.wire.length == b.wire.length && a.wire.diameter == b.wire.diameter &&
         a.wire.bending_stiffness() == b.wire.bending_stiffness() &&
         a.wire.axial_stiffness() == b.wire.axial_stiffness() && a.pusher.radius == b.pusher.radius &&
         a.pusher.direction == b.pusher.direction && a.pusher.friction == b.pusher.friction;
}

/// Path over time of a record [m/s]; 0 without times.
double mean_speed(const Series& series) {
  double path = 0.0;
  const std::vector<double>& d = measured_displacement(series);
  if (!series.readings || series.readings->time.size() != d.size()) return 0.0;
  for (std::size_t i = 1; i < d.size(); ++i) path += std::abs(d[i] - d[i - 1]);
  const double time = series.readings->time.back() - series.readings->time.front();
  return time > 0.0 ? path / time : 0.0;
}

bool same_speed(const Series& a, const Series& b) {
  constexpr double much = 1.5;
  const double one = mean_speed(a);
  const double other = mean_speed(b);
  return one == 0.0 || other == 0.0 || std::max(one, other) <= much * std::min(one, other);
}

using Alike = bool (*)(const Series& a, const Series& b);

std::vector<std::vector<std::size_t>> groups_of(const std::vector<Series>& series, Alike alike) {
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t k = 0; k < series.size(); ++k) {
    const auto like = std::find_if(groups.begin(), groups.end(), [&](const std::vector<std::size_t>& g) {
      return alike(series[g.front()], series[k]);
    });
    if (like == groups.end())
      groups.push_back({k});
    else
      like->push_back(k);
  }
  return groups;
}

}  // namespace

std::vector<std::vector<std::size_t>> tests(const std::vector<Series>& series) {
  return groups_of(series, [](const Series& a, const Series& b) { return same_test(a.test, b.test); });
}

std::vector<std::vector<std::size_t>> conditions(const std::vector<Series>& series) {
  return groups_of(
      series, [](const Series& a, const Series& b) { return same_test(a.test, b.test) && same_speed(a, b); });
}

}  // namespace snare::identification
