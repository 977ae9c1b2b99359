#include "identification/tracing/score.hpp"

#include "identification/effects/catalogue.hpp"
#include "identification/fitting/statistics.hpp"
#include "identification/tracing/projection.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace snare::identification {

namespace {

/// Share of a column that must be left after projection, else it lies in the span: derivatives carry the
/// mesh's error.
constexpr double left_over = 1e-3;
/// Change of all readings together below which nothing is seen: a thousandth of one reading's noise.
constexpr double least_change = 1e-3;

bool fitted(const Fit& fit, const Parameter* p) {
  return std::any_of(fit.settings.begin(), fit.settings.end(),
                     [p](const Setting& s) { return s.parameter == p; });
}

/// A start of a refit within bounds and not wild: where the derivative says, at most half as much or twice.
double bounded(const Model& model, const Parameter& p, double coordinate) {
  const double limit = p.parametrisation == Parametrisation::shift ? 1e300 : 0.7;
  return std::clamp(std::clamp(coordinate, -limit, limit), model.lower(p), model.upper(p));
}

/// One finite amplitude of an effect, and what it does to the curves.
struct Trial {
  double z = 0.0;
  double size = 0.0;  // |g|, in standard deviations of all readings together
  std::vector<double> coordinates;
  Eigen::VectorXd direction;
  Eigen::VectorXd shift;  // as Score::shift
};

}  // namespace

SolverSettings few_edges(const SolverSettings& asked) {
  SolverSettings few = asked;
  few.elements = std::min(64, asked.elements);
  few.extrapolate = false;
  return few;
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

namespace {

/// The scores of one fitted model.
class Scoring {
 public:
  Scoring(const Model& model, const Data& data, const Fit& current);
  [[nodiscard]] std::vector<Score> run(double significance);

 private:
  [[nodiscard]] std::vector<Score> observable_scores();
  void by_derivative(Score& score) const;
  void by_trials(Score& score) const;
  [[nodiscard]] std::vector<Trial> trials_of(const Effect& effect, bool& spanned) const;
  void choose_starts(Score& score, std::vector<Trial>& trials) const;
  [[nodiscard]] Eigen::VectorXd shift_by(const Eigen::VectorXd& column) const;

  const Model& model_;
  const Data& data_;
  const Fit& current_;
  const Eigen::VectorXd& r_;                   // whitened residual
  Projection projection_;                      // off the fitted columns
  std::vector<const Parameter*> derivatives_;  // of effects that have one at null
  Evaluation smooth_;                          // with those derivatives
  Eigen::MatrixXd columns_;
  TrialContext context_;
  Model coarse_;  // changes by finite amplitudes need fewer edges than the forces: the mesh's error drops out
  Evaluation unchanged_;
  double needed_ = 0.0;  // |g| of a size that shows: quantile of the level plus that of 90 %
};

Scoring::Scoring(const Model& model, const Data& data, const Fit& current)
    : model_(model),
      data_(data),
      current_(current),
      r_(current.residual),
      projection_(current.jacobian),
      context_(trial_context(model, current)),
      coarse_(model.series(), few_edges(model.solver())) {}

// An empty score for every effect that is not fitted already; why these data cannot show it, where they
// cannot.
std::vector<Score> Scoring::observable_scores() {
  std::vector<Score> scores;
  const std::vector<Series> now = model_.apply(current_.settings).series;
  for (const Effect& effect : catalogue()) {
    Score score;
    score.effect = &effect;
    const Parameter* first = &effect.numbers.front().parameter;
    if (fitted(current_, first)) continue;
    if (effect.unobservable != nullptr) score.unobservable = effect.unobservable(now);
    if (score.unobservable.empty() && effect.trials == nullptr) derivatives_.push_back(first);
    scores.push_back(std::move(score));
  }
  return scores;
}

// What takes away again as much of a column as the fitted numbers can.
Eigen::VectorXd Scoring::shift_by(const Eigen::VectorXd& column) const {
  return -(current_.covariance * (current_.jacobian.transpose() * column));
}

// z = g . r / |g|, g the projected derivative at null.                                     theory.md (I.4)
void Scoring::by_derivative(Score& score) const {
  const Effect& effect = *score.effect;
  const Parameter& first = effect.numbers.front().parameter;
  if (!smooth_.complete) {
    score.unobservable = "the model could not be computed with it: " + smooth_.message;
    return;
  }
  const auto j = std::find(derivatives_.begin(), derivatives_.end(), &first) - derivatives_.begin();
  const Eigen::VectorXd column = columns_.col(j);
  const Eigen::VectorXd g = projection_.without(column);
  const double norm = g.norm();
  const double range = std::abs(model_.upper(first) - model_.lower(first));
  if (!(column.norm() * range > least_change)) {
    score.unobservable = "it does not change these curves";
    return;
  }
  if (norm < left_over * column.norm() || !(norm * range > least_change)) {
    score.absorbed = true;
    score.unobservable = "the fitted numbers change the curves in the same way";
    return;
  }
  score.direction = g / norm;
  score.shift = shift_by(column) / norm;
  score.z = g.dot(r_) / norm;
  if (effect.one_sided) score.z = std::max(score.z, 0.0);
  const double dof = data_.noise.dof;
  score.p = effect.one_sided ? student_tail(score.z, dof) : 2.0 * student_tail(std::abs(score.z), dof);
  const double start = bounded(model_, first, score.z / norm);
  score.starts = {{{start}, start * norm * score.shift}};
  const double declared = model_.declared(first);
  score.detectable = first.parametrisation == Parametrisation::shift
                         ? needed_ / norm / first.unit_size
                         : first.shown(declared, needed_ / norm) - first.shown(declared, 0.0);
}

// Trials that change the curves otherwise than the fitted numbers. spanned: some change them in the same way.
std::vector<Trial> Scoring::trials_of(const Effect& effect, bool& spanned) const {
  std::vector<Trial> trials;
  for (const std::vector<double>& coordinates : effect.trials(context_)) {
    std::vector<Setting> settings = current_.settings;
    for (std::size_t k = 0; k < coordinates.size(); ++k) {
      settings.push_back({&effect.numbers[k].parameter, coordinates[k]});
    }
    const Evaluation at = coarse_.evaluate(settings);
    if (!at.complete || !unchanged_.complete) continue;
    const Eigen::VectorXd change = data_.residual(unchanged_) - data_.residual(at);
    const Eigen::VectorXd g = projection_.without(change);
    const double norm = g.norm();
    if (!(norm > least_change)) continue;
    if (norm < left_over * change.norm()) {
      spanned = true;
      continue;
    }
    trials.push_back({g.dot(r_) / norm, norm, coordinates, g / norm, shift_by(change) / norm});
  }
  return trials;
}

// The same with the change at each of a grid of finite amplitudes: the largest z counts, its p times their
// number.
void Scoring::by_trials(Score& score) const {
  const Parameter& first = score.effect->numbers.front().parameter;
  bool spanned = false;
  std::vector<Trial> trials = trials_of(*score.effect, spanned);
  if (trials.empty()) {
    score.absorbed = spanned;
    score.unobservable = spanned ? "the fitted numbers change the curves in the same way"
                                 : "no size that was tried changes these curves";
    return;
  }
  std::stable_sort(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) { return a.z > b.z; });
  score.z = std::max(trials.front().z, 0.0);
  score.direction = trials.front().direction;
  score.shift = trials.front().shift;
  score.p = std::min(1.0, static_cast<double>(trials.size()) * student_tail(score.z, data_.noise.dof));
  choose_starts(score, trials);
  const auto smallest =
      std::min_element(trials.begin(), trials.end(), [this](const Trial& a, const Trial& b) {
        const bool a_shows = a.size >= needed_;
        const bool b_shows = b.size >= needed_;
        return a_shows != b_shows ? a_shows : a.size < b.size;
      });
  if (first.parametrisation == Parametrisation::shift) {
    score.detectable = smallest->coordinates.front() * needed_ / smallest->size / first.unit_size;
  } else if (smallest->size >= needed_) {
    score.detectable = first.shown(model_.declared(first), smallest->coordinates.front());
  }
}

// From the likeliest trials, their first number brought to the size seen where it can be (a coefficient, a
// stiffness); a threshold stays as it was tried, and what it then leaves is |r - change|^2 = |r|^2 - 2 size z
// + size^2.
void Scoring::choose_starts(Score& score, std::vector<Trial>& trials) const {
  const Parameter& first = score.effect->numbers.front().parameter;
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
    // of the trial's size; where that cannot be chosen the fitted numbers wait for the threshold
    double seen = 0.0;
    if (scalable) {
      seen = std::clamp(trial.z / trial.size, 0.05, 5.0);
      start.front() = std::clamp(start.front() * seen, model_.lower(first), model_.upper(first));
    }
    score.starts.push_back({start, seen * trial.size * trial.shift});
  }
}

std::vector<Score> Scoring::run(double significance) {
  std::vector<Score> scores = observable_scores();
  smooth_ = model_.evaluate(current_.settings, derivatives_);
  if (smooth_.complete) columns_ = data_.jacobian(smooth_);
  unchanged_ = coarse_.evaluate(current_.settings);
  const auto trials_in_all = static_cast<double>(scores.size());
  needed_ = normal_quantile(significance / std::max(1.0, trials_in_all)) + normal_quantile(0.1);
  for (Score& score : scores) {
    if (!score.unobservable.empty()) continue;
    if (score.effect->trials == nullptr) {
      by_derivative(score);
    } else {
      by_trials(score);
    }
  }
  // Holm over all effects that can be seen.
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

}  // namespace

std::vector<Score> score_effects(const Model& model, const Data& data, const Fit& current,
                                 double significance) {
  return Scoring(model, data, current).run(significance);
}

}  // namespace snare::identification
