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
  const auto at = std::find_if(settings.begin(), settings.end(), [p](const Setting& s) { return s.parameter == p; });
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
                                                                const std::vector<const Parameter*>& by, double widen) {
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
      if (p.mount_gives && !applied[k].test.mount.translational_stiffness) {
        variations[k].push_back({nullptr, widen * p.step, 0.0, 1.0});
        continue;
      }
      const double own = p.number.get(declared[k].test, {});
      variations[k].push_back({[&p, own, at](PushProblem& test, double amount) {
                                 if (p.travel != 0.0) return;
                                 ReadingModel unused;
                                 p.number.set(test, unused, p.value(own, at + amount));
                               },
                               widen * p.step, p.travel});
    }
  }
  return variations;
}

/// Derivatives of the recorded forces of a series, F = offset + gain (F_wire + tau v k_viscous), by every number.
Eigen::MatrixXd record_derivatives(const Series& series, const Prediction& prediction, const Eigen::VectorXd& force,
                                   const ReadingModel& reading, const std::vector<const Parameter*>& by) {
  const Eigen::Index rows = force.size();
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(by.size()));
  Eigen::Index variation = 0;  // numbers of the test in the order in which they were asked for
  for (std::size_t j = 0; j < by.size(); ++j) {
    auto out = result.col(static_cast<Eigen::Index>(j));
    const bool concerned = concerns(*by[j], series);
    switch (by[j]->derivative) {
      case Derivative::implicit:
        if (prediction.force_by.cols() > 0) out = prediction.force_by.col(variation++);
        break;
      case Derivative::force_offset:
        if (concerned) out.setOnes();
        break;
      case Derivative::force_gain:  // by the logarithm of the gain
        if (concerned) out = force.array() - reading.force_offset;
        break;
      case Derivative::rate: {
        if (!concerned) break;
        const std::vector<double> speed = speeds(series);
        for (Eigen::Index i = 0; i < rows; ++i) {
          const auto r = static_cast<std::size_t>(i);
          out[i] = reading.force_gain * speed[r] * prediction.viscous_stiffness[r];
        }
      }
    }
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

std::vector<Prediction> Model::predict_with(const Applied& model, const PredictionOptions& options,
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
    if (find(settings, p) == nullptr && p->parametrisation != Parametrisation::magnitude) settings.push_back({p, 0.0});
  }
  const Applied applied = apply(settings);
  const std::vector<Series>& series = applied.series;
  const bool implicit =
      std::all_of(series.begin(), series.end(), [](const Series& s) { return coupling::differentiable(s.test); });

  PredictionOptions options;
  options.thin = thin_;
  std::vector<const Parameter*> of_test;
  for (const Parameter* p : by) {
    options.examine_rates = options.examine_rates || p->derivative == Derivative::rate;
    if (p->derivative == Derivative::implicit) of_test.push_back(p);
  }
  std::vector<std::vector<coupling::PushVariation>> variations;
  if (implicit && !by.empty()) variations = variations_of(series_, series, settings, of_test, widen);
  std::vector<Prediction> predictions = predict_with(applied, options, variations);
  Evaluation result = forces_of(series, predictions);
  const bool derive = !by.empty() && result.complete;
  for (std::size_t k = 0; k < series.size() && derive; ++k) {
    result.by.push_back(record_derivatives(series[k], predictions[k], result.force[k], applied.reading[k], by));
    predictions[k].force_by.resize(0, 0);  // which `by` has
  }
  result.predictions = std::move(predictions);
  if (derive && !implicit) difference_curves(settings, by, widen, result);
  return result;
}

void Model::difference_curves(std::vector<Setting> settings, const std::vector<const Parameter*>& by, double widen,
                              Evaluation& result) const {
  PredictionOptions plain;
  plain.thin = thin_;
  for (std::size_t j = 0; j < by.size(); ++j) {
    if (by[j]->derivative != Derivative::implicit) continue;
    Setting& s =
        *std::find_if(settings.begin(), settings.end(), [&](const Setting& o) { return o.parameter == by[j]; });
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
  for (Prediction& p : predictions) result.by.push_back(std::move(p.force_by));
  result.predictions = std::move(predictions);
  return result;
}

}  // namespace snare::identification
