#include "identification/tracing/score.hpp"

#include "identification/fitting/statistics.hpp"

#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace snare::identification {

namespace {

/// Share of a column that must be left after projection, else it lies in the span: derivatives carry the mesh's error.
constexpr double left_over = 1e-3;

bool fitted(const Fit& fit, const Parameter* p) {
  return std::any_of(fit.settings.begin(), fit.settings.end(), [p](const Setting& s) { return s.parameter == p; });
}

/// A start of a refit within bounds and not wild: where the derivative says, at most half as much or twice.
double bounded(const Model& model, const Parameter& p, double coordinate) {
  const double limit = p.parametrisation == Parametrisation::shift ? 1e300 : 0.7;
  return std::clamp(std::clamp(coordinate, -limit, limit), model.lower(p), model.upper(p));
}

}  // namespace

Projection::Projection(const Eigen::MatrixXd& jacobian) {
  if (jacobian.cols() == 0) return;
  Eigen::MatrixXd scaled = jacobian;
  for (Eigen::Index k = 0; k < scaled.cols(); ++k) {
    const double norm = scaled.col(k).norm();
    if (norm > 0.0) scaled.col(k) /= norm;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinU);
  Eigen::Index rank = 0;
  while (rank < svd.singularValues().size() && svd.singularValues()[rank] > 1e-9 * svd.singularValues()[0]) ++rank;
  basis_ = svd.matrixU().leftCols(rank);
}

Eigen::MatrixXd Projection::without(const Eigen::MatrixXd& columns) const {
  if (basis_.cols() == 0) return columns;
  return columns - basis_ * (basis_.transpose() * columns);
}

TrialContext trial_context(const Model& model, const Fit& current) {
  TrialContext context;
  context.model = &model;
  const std::vector<Series> series = model.apply(current.settings).series;
  context.bending_stiffness = series.front().test.wire.bending_stiffness();
  context.axial_stiffness = series.front().test.wire.axial_stiffness();
  for (std::size_t k = 0; k < series.size(); ++k) {
    double highest_force = 0.0;
    double tension = 0.0;
    for (const coupling::PushPoint& p : current.evaluation.predictions[k].curve.curve.points) {
      tension = std::max(tension, p.tension_left);
      context.highest_compression = std::max(context.highest_compression, -p.tension_left);
      highest_force = std::max(highest_force, std::abs(p.force));
    }
    context.highest_tension = std::max(context.highest_tension, tension);
    const coupling::PushProblem& t = series[k].test;
    const std::vector<double>& d = measured_displacement(series[k]);
    const double travel = *std::max_element(d.begin(), d.end());
    double curvature = 0.0;
    if (t.mount.kind == wire::MountKind::supports) {
      curvature = 12.0 * travel / (t.mount.span * t.mount.span);  // F = 48 EI w / l^3, M = F l / 4
    } else {
      // The buckled shape, and a point load on a wire under tension (or in bending, F l / 8).
      const double slack = std::max(0.0, t.wire.length / t.mount.span - 1.0);
      const double ei = context.bending_stiffness;
      const double kink = tension > 0.0 ? highest_force / (2.0 * std::sqrt(ei * tension)) : 1e300;
      curvature = 4.0 * std::numbers::pi * std::sqrt(slack) / t.mount.span +
                  std::min(kink, highest_force * t.mount.span / (8.0 * ei));
    }
    context.highest_curvature = std::max(context.highest_curvature, curvature);
  }
  return context;
}

std::vector<Score> score_effects(const Model& model, const Data& data, const Fit& current, const ScoreOptions& options) {
  std::vector<Score> scores;
  std::vector<const Parameter*> derivatives;
  const std::vector<Series> now = model.apply(current.settings).series;
  for (const Effect& effect : catalogue()) {
    Score score;
    score.effect = &effect;
    const Parameter* first = find_parameter(effect.numbers.front().key);
    if (fitted(current, first)) continue;
    if (effect.unobservable != nullptr) score.unobservable = effect.unobservable(now);
    if (score.unobservable.empty() && effect.trials == nullptr) derivatives.push_back(first);
    scores.push_back(std::move(score));
  }
  const Projection projection(current.jacobian);
  const Evaluation smooth = model.evaluate(current.settings, derivatives);
  const Eigen::MatrixXd columns = smooth.complete ? data.jacobian(smooth) : Eigen::MatrixXd();
  const TrialContext context = trial_context(model, current);
  // Changes by finite amplitudes need fewer edges than the forces themselves: the mesh's error drops out.
  SolverSettings few = model.solver();
  few.elements = std::min(64, few.elements);
  const Model coarse(model.series(), few);
  const Evaluation unchanged = coarse.evaluate(current.settings);
  // The residual of what can be explained at all, for sizes.
  const Eigen::VectorXd& r = current.residual;
  const double trials_in_all = static_cast<double>(scores.size());
  const double needed = normal_quantile(options.significance / std::max(1.0, trials_in_all)) + normal_quantile(0.1);

  for (Score& score : scores) {
    if (!score.unobservable.empty()) continue;
    const Effect& effect = *score.effect;
    const Parameter& first = parameter(effect.numbers.front().key);
    if (effect.trials == nullptr) {
      if (!smooth.complete) {
        score.unobservable = "the model could not be computed with it: " + smooth.message;
        continue;
      }
      const auto j = std::find(derivatives.begin(), derivatives.end(), &first) - derivatives.begin();
      const Eigen::VectorXd column = columns.col(j);
      const Eigen::VectorXd g = projection.without(column);
      const double norm = g.norm();
      const double range = std::abs(model.upper(first) - model.lower(first));
      if (!(column.norm() * range > 1e-3)) {
        score.unobservable = "it does not change these curves";
        continue;
      }
      if (norm < left_over * column.norm() || !(norm * range > 1e-3)) {
        score.absorbed = true;
        score.unobservable = "the fitted numbers change the curves in the same way";
        continue;
      }
      score.direction = g / norm;
      score.z = g.dot(r) / norm;
      if (effect.one_sided) score.z = std::max(score.z, 0.0);
      score.p = effect.one_sided ? normal_tail(score.z) : 2.0 * normal_tail(std::abs(score.z));
      score.starts = {{bounded(model, first, score.z / norm)}};
      score.detectable = first.parametrisation == Parametrisation::shift ? needed / norm / first.unit_size
                                                       : first.shown(model.declared(first), needed / norm) -
                                                             first.shown(model.declared(first), 0.0);
      continue;
    }
    // Finite amplitudes.
    struct Trial {
      double z = 0.0;
      double size = 0.0;
      std::vector<double> coordinates;
      Eigen::VectorXd direction;
    };
    std::vector<Trial> trials;
    bool spanned = false;
    for (const std::vector<double>& coordinates : effect.trials(context)) {
      std::vector<Setting> settings = current.settings;
      for (std::size_t k = 0; k < coordinates.size(); ++k) {
        settings.push_back({&parameter(effect.numbers[k].key), coordinates[k]});
      }
      const Evaluation at = coarse.evaluate(settings);
      if (!at.complete || !unchanged.complete) continue;
      const Eigen::VectorXd change = data.residual(unchanged) - data.residual(at);
      const Eigen::VectorXd g = projection.without(change);
      const double norm = g.norm();
      if (!(norm > 1e-3)) continue;  // a thousandth of one reading's noise
      if (norm < left_over * change.norm()) {
        spanned = true;
        continue;
      }
      Trial trial;
      trial.z = g.dot(r) / norm;
      trial.size = norm;
      trial.coordinates = coordinates;
      trial.direction = g / norm;
      trials.push_back(std::move(trial));
    }
    if (trials.empty()) {
      score.absorbed = spanned;
      score.unobservable = spanned ? "the fitted numbers change the curves in the same way"
                                   : "no size that was tried changes these curves";
      continue;
    }
    std::stable_sort(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) { return a.z > b.z; });
    score.z = std::max(trials.front().z, 0.0);
    score.direction = trials.front().direction;
    score.p = std::min(1.0, static_cast<double>(trials.size()) * normal_tail(score.z));
    // From the likeliest trials, their first number brought to the size seen where it can be (a coefficient, a stiffness);
    // a threshold stays as it was tried, and what it then leaves is |r - change|^2 = |r|^2 - 2 size z + size^2.
    const bool scalable = first.parametrisation == Parametrisation::shift;
    if (!scalable) {
      std::stable_sort(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) {
        return a.size * (2.0 * a.z - a.size) > b.size * (2.0 * b.z - b.size);
      });
    }
    for (const Trial& trial : trials) {
      if (score.starts.size() == 2) break;
      if (scalable && trial.z < 0.7 * score.z) break;
      std::vector<double> start = trial.coordinates;
      if (scalable) {
        start.front() = std::clamp(start.front() * std::clamp(trial.z / trial.size, 0.05, 5.0), model.lower(first), model.upper(first));
      }
      score.starts.push_back(start);
    }
    const auto smallest = std::min_element(trials.begin(), trials.end(), [needed](const Trial& a, const Trial& b) {
      const bool a_shows = a.size >= needed;
      const bool b_shows = b.size >= needed;
      return a_shows != b_shows ? a_shows : a.size < b.size;
    });
    if (first.parametrisation == Parametrisation::shift) {
      score.detectable = smallest->coordinates.front() * needed / smallest->size / first.unit_size;
    } else if (smallest->size >= needed) {
      score.detectable = first.shown(model.declared(first), smallest->coordinates.front());
    }
  }

  std::vector<double> p;
  for (const Score& score : scores) {
    if (score.unobservable.empty()) p.push_back(score.p);
  }
  const std::vector<double> adjusted = holm(p);
  std::size_t k = 0;
  for (Score& score : scores) {
    if (score.unobservable.empty()) score.adjusted_p = adjusted[k++];
  }
  return scores;
}

}  // namespace snare::identification
