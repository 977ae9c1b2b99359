#include "identification/tracing/odd_series.hpp"

#include "identification/effects/catalogue.hpp"
#include "identification/tracing/start_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

namespace snare::identification {

namespace {

Data without(const Data& data, std::size_t series) {
  Data rest = data;
  std::erase(rest.series, series);
  return rest;
}

/// The better of the fits from two starts.
Fit fit_from(const Model& model, const Data& data, const std::vector<Setting>& one,
             const std::vector<Setting>& other) {
  Fit best = fit(model, data, one);
  Fit second = fit(model, data, other);
  const bool better = second.report.usable() && (!best.report.usable() || second.chi2 < best.chi2);
  return better ? second : best;
}

/// The fit of all series where the numbers `keys` of one are its own.
Fit with_own(const Model& model, const Data& data, const Fit& rest, const std::string& name,
             std::initializer_list<std::string_view> keys) {
  std::vector<Setting> start = rest.fitted();
  for (const std::string_view key : keys) {
    const Parameter& own = parameters().at(fmt::format("series[{}].{}", name, key));
    double coordinate = 0.0;
    for (const Setting& s : rest.settings)
      if (s.parameter->key == key) coordinate = s.coordinate;
    start.push_back({&own, coordinate});
  }
  return fit(model, data, start);
}

/// The series where two have each other's place and mounts.
std::vector<Series> exchanged(std::vector<Series> series, std::size_t one, std::size_t other) {
  std::swap(series[one].test, series[other].test);
  std::swap(series[one].test.travel, series[other].test.travel);
  return series;
}

}  // namespace

std::optional<Finding> series_exchanged(const Model& model, const Data& data, const Fit& base,
                                        Progress& progress) {
  constexpr std::size_t most = 8;  // series: 28 pairs
  if (data.series.size() < 2 || data.series.size() > most || data.published()) return std::nullopt;
  std::optional<Finding> found;
  double least = base.chi2;
  for (const std::size_t i : data.series) {
    for (const std::size_t k : data.series) {
      const Series &one = model.series()[i], &other = model.series()[k];
      if (i >= k || one.test.contact_position == other.test.contact_position) continue;
      if (!progress.go_on(fmt::format("series {} and {} exchanged", one.name, other.name)))
        return std::nullopt;
      const Model now(exchanged(model.series(), i, k), model.solver());
      const Fit trial = fit_from(now, data, base.fitted(), as_declared(base.fitted()));
      if (!trial.report.usable() || !(trial.chi2 < least) || !test_residuals(now, data, trial).like_noise())
        continue;
      least = trial.chi2;
      found = Finding{.kind = FindingKind::series_exchanged, .key = "series[" + one.name + "]", .sure = true};
      found->what =
          fmt::format("series {} and {} look exchanged: each at the place of the other, chi2/dof is {:.2f}",
                      one.name, other.name, trial.chi2 / std::max(1.0, trial.dof()));
    }
  }
  return found;
}

std::optional<Finding> series_of_another_specimen(const Model& model, const Data& data, const Fit& base,
                                                  Progress& progress) {
  constexpr std::size_t fewest = 3;
  if (data.series.size() < fewest || data.published()) return std::nullopt;
  std::optional<std::size_t> odd;
  Fit rest;
  for (const std::size_t k : data.series) {
    if (!progress.go_on("without series " + model.series()[k].name)) return std::nullopt;
    const Data others = without(data, k);
    if (static_cast<double>(others.rows()) < static_cast<double>(base.free) + 5.0) continue;
    Fit one = fit_from(model, others, base.fitted(), as_declared(base.fitted()));
    if (!one.report.usable() || !test_residuals(model, others, one).like_noise()) continue;
    if (odd) return std::nullopt;
    odd = k;
    rest = std::move(one);
  }
  if (!odd) return std::nullopt;
  const std::string& name = model.series()[*odd].name;
  const Fit wire =
      with_own(model, data, rest, name, {"wire.bending_stiffness_Nm2", "wire.axial_stiffness_N"});
  if (!wire.report.usable() || !test_residuals(model, data, wire).like_noise()) return std::nullopt;
  for (const std::string_view key : {"reading.displacement_offset_mm", "contact_position.shift_mm",
                                     "wire.length_mm", "reading.force_gain", "reading.force_offset_N"}) {
    if (!progress.go_on("what sets series " + name + " apart")) return std::nullopt;
    const Fit other = with_own(model, data, rest, name, {key});
    if (other.report.usable() && other.bic() < wire.bic()) return std::nullopt;
  }
  Finding found{.kind = FindingKind::series_of_another_specimen, .key = "series[" + name + "]", .sure = true};
  const double bending = model.shown(wire.settings[rest.free]);
  const double axial = model.shown(wire.settings[rest.free + 1]);
  found.what = fmt::format(
      "series {} is of another wire: without it chi2/dof is {:.2f}, by itself it has EI = {:.3g} N m^2 and "
      "EA = {:.3g} "
      "N",
      name, rest.chi2 / std::max(1.0, rest.dof()), bending, axial);
  return found;
}

}  // namespace snare::identification
