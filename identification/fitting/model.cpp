#include "identification/fitting/model.hpp"
#include "base/parallel.hpp"
#include "identification/fitting/shared_push.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace snare::identification {

namespace {

const Setting* find(const std::vector<Setting>& settings, const Parameter* p) {
  const auto at =
      std::find_if(settings.begin(), settings.end(), [p](const Setting& s) { return s.parameter == p; });
  return at == settings.end() ? nullptr : &*at;
}

/// Whether a number belongs to a series.
bool concerns(const Parameter& p, const Series& series) {
  return p.only.empty() || p.only == series.name;
}

/// Numbers of every series' test to differentiate by, in the order of `by`: how each moves the test.
/// declared: the series as the file gives them, from which coordinates count; applied: with the settings.
std::vector<std::vector<coupling::PushVariation>> variations_of(const std::vector<Series>& declared,
                                                                const std::vector<Series>& applied,
                                                                const std::vector<Setting>& settings,
                                                                const std::vector<const Parameter*>& by,
                                                                double widen) {
  std::vector<std::vector<coupling::PushVariation>> variations(declared.size());
  for (const Parameter* number : by) {
    const Parameter& p = *number;
    const double at = find(settings, number)->coordinate;
    // A ratio's step moves the value itself by about that share.
    for (std::size_t k = 0; k < declared.size(); ++k) {
      if (!concerns(p, declared[k])) {
        variations[k].push_back({nullptr, widen * p.step});
        continue;
      }
      if (p.mounts_give != nullptr && p.mounts_give(applied[k].test) != std::array<double, 2>{}) {
        variations[k].push_back({nullptr, widen * p.step, 0.0, p.mounts_give(applied[k].test)});
        continue;
      }
      const double own = p.number.get(declared[k].test, {});
      variations[k].push_back({[&p, own, at](PushProblem& test, double amount) {
                                 ReadingModel unused;
                                 p.number.set(test, unused, p.value(own, at + amount));
                               },
                               widen * p.step});
    }
  }
  return variations;
}

/// Change of the record of a series with its reading model: the true forces go along the curve to the changed
/// travels.
Eigen::VectorXd record_with(const Series& series, const Prediction& prediction, const ReadingModel& changed,
                            const Eigen::VectorXd& slope) {
  TrueForce wire = prediction.wire;
  if (slope.size() > 0) {
    const std::vector<double> before = true_travel(series, prediction.reading);
    const std::vector<double> after = true_travel(series, changed);
    for (std::size_t i = 0; i < wire.force.size(); ++i)
      wire.force[i] += slope[static_cast<Eigen::Index>(i)] * (after[i] - before[i]);
  }
  const std::vector<double> force = recorded_force(series, changed, wire);
  return Eigen::Map<const Eigen::VectorXd>(force.data(), static_cast<Eigen::Index>(force.size()));
}

/// Derivatives of the recorded forces of a series by every number: those of the push from the prediction,
/// whose last column is the slope of the curve where a number moves the travels; those of the record by
/// differences of the record alone.
Eigen::MatrixXd record_derivatives(const Series& declared, const Prediction& prediction,
                                   const std::vector<Setting>& settings,
                                   const std::vector<const Parameter*>& by) {
  const auto rows = static_cast<Eigen::Index>(prediction.force.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(by.size()));
  const Eigen::MatrixXd pushed =
      recorded_change(declared, prediction.reading, prediction.wire, prediction.force_by);
  Eigen::Index variation = 0;  // numbers of the push in the order in which they were asked for
  for (std::size_t j = 0; j < by.size(); ++j) {
    auto out = result.col(static_cast<Eigen::Index>(j));
    const Parameter& p = *by[j];
    if (p.derivative == Derivative::push) {
      if (pushed.cols() > 0) out = pushed.col(variation++);
      continue;
    }
    const bool moves = p.derivative == Derivative::travel;
    if (!concerns(p, declared) || (moves && pushed.cols() == 0)) continue;
    Eigen::VectorXd slope;
    if (moves) slope = prediction.force_by.rightCols(1);
    const double at = find(settings, &p)->coordinate;
    const double own = p.number.get(declared.test, {});
    const auto side = [&](double step) {
      PushProblem unused;
      ReadingModel changed = prediction.reading;
      p.number.set(unused, changed, p.value(own, at + step));
      return record_with(declared, prediction, changed, slope);
    };
    out = (side(p.step) - side(-p.step)) / (2.0 * p.step);
  }
  return result;
}

/// Forces of predictions, and whether every reading of every series has one.
Evaluation forces_of(const std::vector<Series>& series, const std::vector<Prediction>& predictions) {
  Evaluation result;
  result.complete = true;
  for (std::size_t k = 0; k < series.size(); ++k) {
    const Prediction& p = predictions[k];
    const std::size_t wanted = measured_displacement(series[k]).size();
    if (p.force.size() != wanted) {
      result.complete = false;
      result.message = "series " + series[k].name + ": " + p.curve.curve.report.message;
    }
    result.force.emplace_back(
        Eigen::Map<const Eigen::VectorXd>(p.force.data(), static_cast<Eigen::Index>(p.force.size())));
    if (result.complete && !result.force.back().allFinite()) {
      result.complete = false;
      result.message = "series " + series[k].name + ": a computed force is not finite";
    }
  }
  return result;
}

}  // namespace

Model::Model(std::vector<Series> series, const SolverSettings& solver, bool thin)
    : series_(std::move(series)), solver_(solver), thin_(thin) {}

double Model::declared(const Parameter& p) const {
  for (const Series& s : series_) {
    if (s.name == p.only) return p.number.get(s.test, {});
  }
  return p.number.get(series_.front().test, {});
}

double Model::shown(const Setting& s) const {
  return s.parameter->shown(declared(*s.parameter), s.coordinate);
}

double Model::lower(const Parameter& p) const {
  const double d = declared(p);
  const double c = p.coordinate(d, p.limits(series_.front().test).lower);
  return std::isfinite(c) ? c : -50.0;
}

double Model::upper(const Parameter& p) const {
  return p.coordinate(declared(p), p.limits(series_.front().test).upper);
}

Model::Applied Model::apply(const std::vector<Setting>& settings) const {
  Applied result{series_, std::vector<ReadingModel>(series_.size())};
  for (const Setting& setting : settings) {
    const Parameter& p = *setting.parameter;
    result.of_all = result.of_all && p.only.empty();
    for (std::size_t k = 0; k < series_.size(); ++k) {
      if (!concerns(p, series_[k])) continue;
      // Relative to what the series declares itself.
      const double own = p.number.get(series_[k].test, {});
      p.number.set(result.series[k].test, result.reading[k], p.value(own, setting.coordinate));
    }
  }
  return result;
}

std::vector<Prediction> Model::predict_with(
    const Applied& model, const PredictionOptions& options,
    const std::vector<std::vector<coupling::PushVariation>>& variations) const {
  const std::vector<Series>& series = model.series;
  std::vector<Prediction> predictions(series.size());
  // Records of one push share its curve, where no number belongs to one of them alone.
  std::vector<std::vector<std::size_t>> groups;
  if (options.thin && model.of_all) {
    groups = shared_pushes(series_, series, model.reading);
  } else {
    for (std::size_t k = 0; k < series.size(); ++k) groups.push_back({k});
  }
  base::parallel_for(groups.size(), [&](std::size_t g) {
    const std::vector<std::size_t>& group = groups[g];
    const std::size_t first = group.front();
    PredictionOptions own = options;
    if (!variations.empty()) own.variations = variations[first];
    if (group.size() == 1) {
      predictions[first] = predict(series[first], solver_, model.reading[first], own);
      return;
    }
    const Series all = merged(series, group);
    const Prediction whole = predict(all, solver_, model.reading[first], own);
    for (const std::size_t k : group) predictions[k] = part_of(whole, all, series[k]);
  });
  return predictions;
}

Evaluation Model::evaluate(const std::vector<Setting>& given, const std::vector<const Parameter*>& by,
                           double widen) const {
  std::vector<Setting> settings = given;
  for (const Parameter* p : by) {
    if (find(settings, p) == nullptr && p->parametrisation != Parametrisation::magnitude)
      settings.push_back({p, 0.0});
  }
  const Applied applied = apply(settings);
  const std::vector<Series>& series = applied.series;
  const bool implicit = std::all_of(series.begin(), series.end(),
                                    [](const Series& s) { return coupling::differentiable(s.test); });

  PredictionOptions options;
  options.thin = thin_;
  std::vector<const Parameter*> of_test;
  bool slope = false;
  for (const Parameter* p : by) {
    options.examine_rates = options.examine_rates || p->derivative == Derivative::rate;
    if (p->derivative == Derivative::push) of_test.push_back(p);
    slope = slope || p->derivative == Derivative::travel;
  }
  std::vector<std::vector<coupling::PushVariation>> variations;
  if (implicit && !by.empty()) variations = variations_of(series_, series, settings, of_test, widen);
  if (slope) {
    for (std::vector<coupling::PushVariation>& of_series : variations)
      of_series.push_back({nullptr, 1e-7, 1.0});
  }
  std::vector<Prediction> predictions = predict_with(applied, options, variations);
  Evaluation result = forces_of(series, predictions);
  const bool derive = !by.empty() && result.complete;
  for (std::size_t k = 0; k < series.size() && derive; ++k) {
    result.by.push_back(record_derivatives(series[k], predictions[k], settings, by));
    predictions[k].force_by.resize(0, 0);  // which `by` has
  }
  result.predictions = std::move(predictions);
  if (derive && !implicit) difference_curves(settings, by, widen, result);
  return result;
}

void Model::difference_curves(std::vector<Setting> settings, const std::vector<const Parameter*>& by,
                              double widen, Evaluation& result) const {
  PredictionOptions plain;
  plain.thin = thin_;
  for (std::size_t j = 0; j < by.size(); ++j) {
    if (by[j]->derivative != Derivative::push && by[j]->derivative != Derivative::travel) continue;
    Setting& s = *std::find_if(settings.begin(), settings.end(),
                               [&](const Setting& o) { return o.parameter == by[j]; });
    const double centre = s.coordinate;
    // Wide enough for the jumps of a section that slips vertex by vertex.
    const double h =
        widen * (s.parameter->parametrisation == Parametrisation::shift ? 100.0 * s.parameter->step : 2e-2);
    const auto curve_at = [&](double coordinate) {
      s.coordinate = std::clamp(coordinate, lower(*s.parameter), upper(*s.parameter));
      return forces_of(series_, predict_with(apply(settings), plain, {}));
    };
    const Evaluation below = curve_at(centre - h);
    const Evaluation above = curve_at(centre + h);
    const double span = std::min(centre + h, upper(*s.parameter)) - std::max(centre - h, lower(*s.parameter));
    s.coordinate = centre;
    if (!below.complete || !above.complete) {
      result.complete = false;
      result.message = below.complete ? above.message : below.message;
      return;
    }
    for (std::size_t k = 0; k < series_.size(); ++k) {
      result.by[k].col(static_cast<Eigen::Index>(j)) = (above.force[k] - below.force[k]) / span;
    }
  }
}

Evaluation Model::evaluate_windows(const std::vector<Setting>& settings, int windows) const {
  const Applied applied = apply(settings);
  const std::vector<Series>& series = applied.series;
  PredictionOptions options;
  options.thin = thin_;
  std::vector<std::vector<coupling::PushVariation>> variations(series.size());
  for (std::size_t k = 0; k < series.size(); ++k) {
    if (!coupling::differentiable(series[k].test)) return {};
    for (int w = 0; w < windows; ++w) {
      variations[k].push_back({[w, windows](coupling::PushProblem& test, double amount) {
                                 test.wire.bending_profile.assign(static_cast<std::size_t>(windows), 1.0);
                                 test.wire.bending_profile[static_cast<std::size_t>(w)] += amount;
                               },
                               1e-3, 0.0});
    }
  }
  std::vector<Prediction> predictions = predict_with(applied, options, variations);
  Evaluation result = forces_of(series, predictions);
  for (std::size_t k = 0; k < series.size(); ++k) {
    Prediction& p = predictions[k];
    result.by.push_back(recorded_change(series_[k], p.reading, p.wire, std::move(p.force_by)));
  }
  result.predictions = std::move(predictions);
  return result;
}

}  // namespace snare::identification
