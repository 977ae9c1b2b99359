#include "identification/tracing/start_search.hpp"

#include "identification/fitting/prediction.hpp"
#include "identification/tracing/score.hpp"

#include <fmt/format.h>

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace snare::identification {

namespace {

constexpr int few_steps = 6;
constexpr double near_section = 0.2;  // of the logarithm of a stiffness: no start of its own
constexpr double far_beyond = 100.0;  // of chi2

constexpr std::size_t most_a_leg = 10;  // readings that are used
constexpr double longest_step = 1.5;    // of the logarithm of a stiffness, to first order

/// Readings of a series that are used: at most `most_a_leg` of every leg, with its ends.
std::vector<std::size_t> used(const Series& series) {
  std::vector<std::size_t> result;
  for (const Leg& leg : legs_of(measured_displacement(series))) {
    const std::size_t n = leg.end - leg.begin;
    const std::size_t take = std::min(n, most_a_leg);
    for (std::size_t k = 0; k < take; ++k)
      result.push_back(take == 1 ? leg.end - 1 : leg.begin + k * (n - 1) / (take - 1));
  }
  return result;
}

/// Series with these of their readings alone.
std::vector<Series> thinned(std::vector<Series> series, const std::vector<std::vector<std::size_t>>& kept) {
  for (std::size_t k = 0; k < series.size(); ++k) {
    Readings few;
    const Readings& all = *series[k].readings;
    for (const std::size_t i : kept[k]) {
      few.displacement.push_back(all.displacement[i]);
      few.force.push_back(all.force[i]);
      if (!all.time.empty()) few.time.push_back(all.time[i]);
    }
    series[k].readings = std::move(few);
  }
  return series;
}

/// Readings of every series that are used: a few where the noise is independent, else all.
std::vector<std::vector<std::size_t>> kept_readings(const Model& model, const Data& data) {
  const bool alone = data.noise.filter.empty() && data.placings.empty() && data.noise.published.empty();
  std::vector<std::vector<std::size_t>> kept;
  for (const Series& s : model.series()) {
    const std::size_t n = measured_displacement(s).size();
    kept.emplace_back(n);
    std::iota(kept.back().begin(), kept.back().end(), std::size_t{0});
    if (alone && n > 1) kept.back() = used(s);
  }
  return kept;
}

}  // namespace

std::vector<Setting> as_declared(std::vector<Setting> settings) {
  for (Setting& s : settings) {
    if (s.parameter->parametrisation != Parametrisation::magnitude) s.coordinate = 0.0;
  }
  return settings;
}

std::vector<Setting> as_the_section_has(const Model& model, std::vector<Setting> settings) {
  const Series& first = model.series().front();
  wire::WireSpecification section = first.test.wire;
  if (!first.modulus_declared || !(section.diameter > 0.0) || !(section.youngs_modulus > 0.0)) return {};
  section.bending_stiffness_override.reset();
  section.axial_stiffness_override.reset();
  bool other = false;
  for (Setting& s : settings) {
    const bool bends = s.parameter->key == "wire.bending_stiffness_Nm2";
    if (!bends && s.parameter->key != "wire.axial_stiffness_N") continue;
    const double stiffness = bends ? section.bending_stiffness() : section.axial_stiffness();
    const double coordinate = s.parameter->coordinate(model.declared(*s.parameter), stiffness);
    other = other || std::abs(coordinate) > near_section;
    s.coordinate = std::clamp(coordinate, model.lower(*s.parameter), model.upper(*s.parameter));
  }
  return other ? settings : std::vector<Setting>();
}

StartSearch::StartSearch(const Model& model, const Data& data, const Fit& current)
    : StartSearch(model, data, current, kept_readings(model, data)) {}

StartSearch::StartSearch(const Model& model, const Data& data, const Fit& current,
                         const std::vector<std::vector<std::size_t>>& kept)
    : coarse_(thinned(model.series(), kept), few_edges(model.solver())),
      data_(data),
      context_(trial_context(model, current)) {
  const Evaluation at = coarse_.evaluate(current.settings);
  for (std::size_t k = 0; k < kept.size() && at.complete; ++k) {
    const Eigen::VectorXd left = data.measured[k] - current.evaluation.force[k];
    data_.measured[k] = at.force[k] + left(kept[k]);
  }
  readings_ = static_cast<double>(data.rows()) / static_cast<double>(std::max<Eigen::Index>(1, data_.rows()));
  std::vector<std::vector<Setting>> bases{current.fitted(), as_declared(current.fitted()),
                                          as_the_section_has(coarse_, current.fitted())};
  for (std::vector<Setting>& base : bases) {
    if (base.empty() && !beside_.empty()) continue;
    Beside one{std::move(base), 0.0, {}, {}};
    std::vector<const Parameter*> by;
    for (const Setting& s : one.settings) by.push_back(s.parameter);
    const Evaluation here = coarse_.evaluate(one.settings, by);
    if (!here.complete) continue;
    one.chi2 = data_.residual(here).squaredNorm();
    one.jacobian = data_.jacobian(here);
    one.covariance =
        (one.jacobian.transpose() * one.jacobian).completeOrthogonalDecomposition().pseudoInverse();
    beside_.push_back(std::move(one));
  }
}

std::vector<std::vector<double>> StartSearch::sizes(const Effect& effect) const {
  if (effect.trials != nullptr) {
    // A small, a middle and a large one.
    std::vector<std::vector<double>> all = effect.trials(context_);
    constexpr std::size_t most = 3;
    if (all.size() <= most) return all;
    return {all[all.size() / 6], all[all.size() / 2], all[(5 * all.size()) / 6]};
  }
  if (effect.sizes == nullptr) return {{0.0}};
  std::vector<std::vector<double>> result;
  for (const double size : effect.sizes(coarse_.series().front().test)) result.push_back({size});
  return result;
}

// One step of the fitted numbers, with their derivatives where the effect is absent.
std::optional<SearchedStart> StartSearch::stepped(const Beside& beside, const Effect& effect,
                                                  const std::vector<double>& size) const {
  SearchedStart start{beside.settings, 0.0};
  for (std::size_t k = 0; k < size.size(); ++k) {
    const Parameter& p = effect.numbers[k].parameter;
    if (effect.numbers[k].optional && size[k] == 0.0) continue;
    start.settings.push_back({&p, std::clamp(size[k], coarse_.lower(p), coarse_.upper(p))});
  }
  const Evaluation at = coarse_.evaluate(start.settings);
  if (!at.complete) return std::nullopt;
  const Eigen::VectorXd r = data_.residual(at);
  start.chi2 = r.squaredNorm();
  const Eigen::VectorXd step = beside.covariance * (beside.jacobian.transpose() * r);
  SearchedStart moved = start;
  for (Eigen::Index k = 0; k < step.size(); ++k) {
    Setting& s = moved.settings[static_cast<std::size_t>(k)];
    const bool shift = s.parameter->parametrisation == Parametrisation::shift;
    const double most = shift ? 1e300 : longest_step;
    s.coordinate = std::clamp(s.coordinate + std::clamp(step[k], -most, most), coarse_.lower(*s.parameter),
                              coarse_.upper(*s.parameter));
  }
  const Evaluation there = coarse_.evaluate(moved.settings);
  if (!there.complete) return start;
  moved.chi2 = data_.residual(there).squaredNorm();
  return moved.chi2 < start.chi2 ? moved : start;
}

std::optional<SearchedStart> StartSearch::best(const Effect& effect, double rival, Progress& progress) const {
  const std::string stage = "where " + effect.name + " may begin";
  std::optional<SearchedStart> found;
  for (std::size_t b = 0; b < beside_.size(); ++b) {
    // For their scores, thresholds were tried at every size with the numbers of the fit; numbers far beyond
    // its error they do not mend.
    if (effect.trials != nullptr && (b == 0 || beside_[b].chi2 > far_beyond * beside_.front().chi2)) continue;
    for (const std::vector<double>& size : sizes(effect)) {
      if (!progress.go_on(stage)) return found;
      std::optional<SearchedStart> one = stepped(beside_[b], effect, size);
      if (one && (!found || one->chi2 < found->chi2)) found = std::move(one);
    }
  }
  if (!found) return found;
  // Where derivatives need whole curves, only the refit takes steps.
  const std::vector<Series> with = coarse_.apply(found->settings).series;
  const bool cheap =
      std::ranges::all_of(with, [](const Series& s) { return coupling::differentiable(s.test); });
  if (cheap) {
    FitOptions few;
    few.max_iterations = few_steps;
    few.tolerance = 1e-3;
    few.rival = rival / readings_;
    few.progress = [&](int, double) { return progress.go_on(stage); };
    const Fit reached = fit(coarse_, data_, found->settings, {}, few);
    if (reached.report.usable() && reached.chi2 < found->chi2)
      found = SearchedStart{reached.fitted(), reached.chi2};
  }
  found->chi2 *= readings_;
  return found;
}

}  // namespace snare::identification
