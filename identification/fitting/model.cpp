#include "identification/fitting/model.hpp"
#include "base/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace snare::identification {

namespace {

enum class Derivative { implicit, offset, gain, rate };

Derivative kind_of(const Parameter& p) {
  if (p.key.ends_with("reading.force_offset_N")) return Derivative::offset;
  if (p.key.ends_with("reading.force_gain")) return Derivative::gain;
  if (p.key.ends_with("rate_viscosity.relaxation_time_s")) return Derivative::rate;
  return Derivative::implicit;
}

const Setting* find(const std::vector<Setting>& settings, const Parameter* p) {
  const auto at = std::find_if(settings.begin(), settings.end(), [p](const Setting& s) { return s.parameter == p; });
  return at == settings.end() ? nullptr : &*at;
}

}  // namespace

Model::Model(std::vector<Series> series, const SolverSettings& solver, bool thin)
    : series_(std::move(series)), solver_(solver), thin_(thin) {}

double Model::declared(const Parameter& p) const {
  for (const Series& s : series_) {
    if (s.name == p.only) return p.get(s.test, {});
  }
  return p.get(series_.front().test, {});
}

double Model::shown(const Setting& s) const { return s.parameter->shown(declared(*s.parameter), s.coordinate); }

double Model::lower(const Parameter& p) const {
  const double d = declared(p);
  const double c = p.coordinate(d, p.lower(series_.front().test));
  return std::isfinite(c) ? c : -50.0;
}

double Model::upper(const Parameter& p) const { return p.coordinate(declared(p), p.upper(series_.front().test)); }

Model::Applied Model::apply(const std::vector<Setting>& settings) const {
  Applied result{series_, std::vector<ReadingModel>(series_.size())};
  for (const Setting& setting : settings) {
    const Parameter& p = *setting.parameter;
    for (std::size_t k = 0; k < series_.size(); ++k) {
      if (!p.only.empty() && p.only != series_[k].name) continue;
      // Relative to what the series declares itself.
      const double own = p.get(series_[k].test, {});
      p.set(result.series[k].test, result.reading[k], p.value(own, setting.coordinate));
    }
  }
  return result;
}

Evaluation Model::predict_with(const Applied& model, const PredictionOptions& options,
                               const std::vector<std::vector<coupling::PushVariation>>& variations) const {
  const std::vector<Series>& series = model.series;
  Evaluation result;
  result.predictions.resize(series.size());
  base::parallel_for(series.size(), [&](std::size_t k) {
    PredictionOptions own = options;
    if (!variations.empty()) own.variations = variations[k];
    result.predictions[k] = predict(series[k], solver_, model.reading[k], own);
  });
  evaluations_ += static_cast<std::ptrdiff_t>(series.size());
  result.complete = true;
  for (std::size_t k = 0; k < series.size(); ++k) {
    const Prediction& p = result.predictions[k];
    const std::size_t wanted = measured_displacement(series[k]).size();
    if (p.force.size() != wanted) {
      result.complete = false;
      result.message = "series " + series[k].name + ": " + p.curve.curve.report.message;
    }
    result.force.emplace_back(Eigen::Map<const Eigen::VectorXd>(p.force.data(), static_cast<Eigen::Index>(p.force.size())));
    if (result.complete && !result.force.back().allFinite()) {
      result.complete = false;
      result.message = "series " + series[k].name + ": a computed force is not finite";
    }
  }
  return result;
}

Evaluation Model::evaluate(const std::vector<Setting>& given, const std::vector<const Parameter*>& by) const {
  std::vector<Setting> settings = given;
  for (const Parameter* p : by) {
    if (find(settings, p) == nullptr && p->parametrisation != Parametrisation::magnitude) settings.push_back({p, 0.0});
  }
  const Applied applied = apply(settings);
  const std::vector<Series>& series = applied.series;
  const bool implicit = std::all_of(series.begin(), series.end(),
                                    [](const Series& s) { return coupling::differentiable(s.test); });

  PredictionOptions options;
  options.thin = thin_;
  std::vector<std::vector<coupling::PushVariation>> variations;
  std::vector<std::size_t> column;  // of the variations, among `by`
  if (!by.empty()) {
    for (const Parameter* p : by) options.examine_rates = options.examine_rates || kind_of(*p) == Derivative::rate;
    variations.resize(series.size());
    for (std::size_t j = 0; j < by.size() && implicit; ++j) {
      const Parameter& p = *by[j];
      if (kind_of(p) != Derivative::implicit) continue;
      column.push_back(j);
      const double at = find(settings, &p)->coordinate;
      // A ratio's step moves the value itself by about that share.
      for (std::size_t k = 0; k < series.size(); ++k) {
        const double own = p.get(series_[k].test, {});
        if (!p.only.empty() && p.only != series_[k].name) {
          variations[k].push_back({nullptr, p.step});
          continue;
        }
        if (p.mount_gives && !series[k].test.mount.translational_stiffness) {
          variations[k].push_back({nullptr, p.step, 0.0, 1.0});
          continue;
        }
        variations[k].push_back({[&p, own, at](coupling::PushProblem& test, double amount) {
                                   if (p.travel != 0.0) return;
                                   ReadingModel unused;
                                   p.set(test, unused, p.value(own, at + amount));
                                 },
                                 p.step, p.travel});
      }
    }
  }
  Evaluation result = predict_with(applied, options, variations);
  if (by.empty() || !result.complete) return result;

  for (std::size_t k = 0; k < series.size(); ++k) {
    const ReadingModel& reading = applied.reading[k];
    const Prediction& p = result.predictions[k];
    const auto rows = result.force[k].size();
    Eigen::MatrixXd derivative = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(by.size()));
    const std::vector<double> speed = options.examine_rates ? speeds(series[k]) : std::vector<double>();
    for (std::size_t j = 0; j < by.size(); ++j) {
      auto out = derivative.col(static_cast<Eigen::Index>(j));
      if (!by[j]->only.empty() && by[j]->only != series[k].name) continue;
      switch (kind_of(*by[j])) {
        case Derivative::implicit: break;
        case Derivative::offset: out.setOnes(); break;
        case Derivative::gain: out = result.force[k].array() - reading.force_offset; break;
        case Derivative::rate:
          for (Eigen::Index i = 0; i < rows; ++i) {
            const auto r = static_cast<std::size_t>(i);
            out[i] = reading.force_gain * speed[r] * p.viscous_stiffness[r];
          }
      }
    }
    for (std::size_t v = 0; v < column.size(); ++v) {
      derivative.col(static_cast<Eigen::Index>(column[v])) = p.force_by.col(static_cast<Eigen::Index>(v));
    }
    result.by.push_back(std::move(derivative));
  }
  if (implicit) return result;

  // Differences of whole curves for the others.
  PredictionOptions plain;
  plain.thin = thin_;
  for (std::size_t j = 0; j < by.size(); ++j) {
    if (kind_of(*by[j]) != Derivative::implicit) continue;
    Setting& s = *std::find_if(settings.begin(), settings.end(), [&](const Setting& o) { return o.parameter == by[j]; });
    const double centre = s.coordinate;
    // Wide enough for the jumps of a section that slips vertex by vertex.
    const double h = s.parameter->parametrisation == Parametrisation::shift ? 100.0 * s.parameter->step : 2e-2;
    std::array<Evaluation, 2> sides;
    for (const int side : {0, 1}) {
      s.coordinate = std::clamp(centre + (side == 0 ? -h : h), lower(*s.parameter), upper(*s.parameter));
      sides[static_cast<std::size_t>(side)] = predict_with(apply(settings), plain, {});
    }
    const double span = std::min(centre + h, upper(*s.parameter)) - std::max(centre - h, lower(*s.parameter));
    s.coordinate = centre;
    if (!sides[0].complete || !sides[1].complete) {
      result.complete = false;
      result.message = sides[0].complete ? sides[1].message : sides[0].message;
      return result;
    }
    for (std::size_t k = 0; k < series.size(); ++k) {
      result.by[k].col(static_cast<Eigen::Index>(j)) = (sides[1].force[k] - sides[0].force[k]) / span;
    }
  }
  return result;
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
  Evaluation result = predict_with(applied, options, variations);
  for (const Prediction& p : result.predictions) result.by.push_back(p.force_by);
  return result;
}

}  // namespace snare::identification
