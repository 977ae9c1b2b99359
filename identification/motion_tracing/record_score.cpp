#include "identification/motion_tracing/record_score.hpp"

#include "identification/fitting/statistics.hpp"
#include "identification/tracing/projection.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace snare::identification {

namespace {

/// Changes of the signal at trial sizes.
struct Trial {
  std::size_t effect = 0, number = 0;
  double scale = 0.0;  // of the number; the trial is a tenth of it
  bool settled = false;
  Eigen::VectorXd column;  // derivative times scale; empty: it could not be simulated
};

constexpr double trial_share = 0.1;
constexpr double least_change = 0.02, most_change = 1.0, wanted_change = 0.2;  // of the residual's norm
constexpr int most_passes = 3;

/// One pass over the trials that are not settled.
void try_sizes(const RecordModel& model, const RecordData& data, const RecordFit& fit,
               const std::vector<RecordSetting>& all, const std::vector<RecordEffect>& effects,
               std::vector<Trial>& trials) {
  std::vector<std::vector<RecordSetting>> points;
  std::vector<std::pair<std::size_t, double>> of;  // trial, step
  for (std::size_t t = 0; t < trials.size(); ++t) {
    if (trials[t].settled) continue;
    const RecordNumber& n = effects[trials[t].effect].numbers[trials[t].number];
    const double step = trial_share * trials[t].scale;
    // To one side: the refit of what is promising takes the rest.
    for (const double move : {step, -step}) {
      if (n.declared + move < n.lower || n.declared + move > n.upper) continue;
      points.push_back(all);
      points.back().push_back({n, n.declared + move});
      of.emplace_back(t, move);
      break;
    }
  }
  const auto predictions = model.predict_many(points, data.records, data.readings);
  const Eigen::VectorXd here = data.signal(fit.predictions);
  const double size = std::max(fit.residual.norm(), 1e-12 * here.norm());
  for (std::size_t t = 0; t < trials.size(); ++t) {
    if (trials[t].settled) continue;
    Eigen::VectorXd sum;
    double way = 0.0;
    for (std::size_t k = 0; k < of.size(); ++k) {
      if (of[k].first != t) continue;
      const Eigen::VectorXd there = data.signal(predictions[k]);
      if (there.size() == 0) continue;
      const Eigen::VectorXd change = (there - here) * (of[k].second < 0.0 ? -1.0 : 1.0);
      sum = sum.size() == 0 ? change : Eigen::VectorXd(sum + change);
      way += std::abs(of[k].second);
    }
    if (sum.size() == 0 || way == 0.0) {  // no motion at this size: try a smaller one
      trials[t].column.resize(0);
      trials[t].scale *= 0.1;
      continue;
    }
    trials[t].column = sum * (trials[t].scale / way);
    const double change = trial_share * trials[t].column.norm() / size;
    trials[t].settled =
        (change >= least_change && change <= most_change) || change == 0.0;  // nothing hangs on it
    if (!trials[t].settled) {
      const double factor = std::clamp(wanted_change / std::max(change, 1e-8), 1e-5, 1e5);
      trials[t].column *= factor;  // if this was the last pass
      trials[t].scale *= factor;
    }
  }
}

/// Derivatives by the fitted numbers but those that stand at a bound against which the readings push them:
/// what such a number would take beyond it is there for effects to take.
Eigen::MatrixXd free_to_move(const RecordFit& fit) {
  std::vector<Eigen::Index> moving;
  for (Eigen::Index k = 0; k < fit.jacobian.cols(); ++k) {
    const RecordSetting& s = fit.settings[static_cast<std::size_t>(k)];
    const double pull = fit.jacobian.col(k).dot(fit.residual);  // > 0: a larger number leaves less
    const bool held =
        (s.value <= s.number.lower && pull <= 0.0) || (s.value >= s.number.upper && pull >= 0.0);
    if (!held) moving.push_back(k);
  }
  return fit.jacobian(Eigen::all, moving);
}

/// Columns with the fitted ones out, of the numbers that do what neither these nor the numbers before them
/// do. Of a vector the components that change the records a hundred times less than another one are left out:
/// at sizes that show them the motion is another.
void keep_independent(const Projection& projection, const std::vector<const Trial*>& seen,
                      RecordScore& score) {
  constexpr double absorbed = 1e-3;  // of the change: below it others do the same
  constexpr double hardly = 0.01;
  std::vector<Eigen::VectorXd> kept, whole, directions;
  double most = 0.0;
  for (const Trial* t : seen) most = std::max(most, t->column.norm() / t->scale);
  for (const Trial* t : seen) {
    if (t->column.norm() < hardly * most * t->scale) continue;
    const Eigen::VectorXd own = projection.without(t->column);
    Eigen::VectorXd left = own;
    for (const Eigen::VectorXd& d : directions) left -= d.dot(left) * d;
    if (left.norm() < absorbed * t->column.norm()) continue;
    directions.push_back(left.normalized());
    kept.push_back(own);
    whole.push_back(t->column);
    score.numbers.push_back(t->number);
    score.scale.push_back(t->scale);
  }
  score.columns.resize(kept.empty() ? 0 : kept.front().size(), static_cast<Eigen::Index>(kept.size()));
  score.whole.resize(score.columns.rows(), score.columns.cols());
  for (std::size_t k = 0; k < kept.size(); ++k) {
    score.columns.col(static_cast<Eigen::Index>(k)) = kept[k];
    score.whole.col(static_cast<Eigen::Index>(k)) = whole[k];
  }
}

/// The score of one effect from its columns with the fitted ones out, and their coloured counterparts.
/// power: variance of what is left with all columns out. What smooth columns take out is missing there, and
/// an autoregression of the rest takes the noise for smaller where they are: no score has less than the
/// variance that white noise of that power would give it.
void judge(const RecordData& data, const ColouredNoise& noise, double power, const Eigen::VectorXd& residual,
           const RecordEffect& effect, RecordScore& score) {
  const Eigen::MatrixXd& g = score.columns;
  const Eigen::VectorXd u = g.transpose() * residual;
  const Eigen::MatrixXd through = coloured(data, noise, g);
  const Eigen::MatrixXd variance = through.transpose() * through;
  const Eigen::MatrixXd normal = g.transpose() * g;
  const Eigen::LDLT<Eigen::MatrixXd> by_variance(variance), by_normal(normal);
  const Eigen::VectorXd step = by_normal.solve(u);
  const double statistic = std::min(u.dot(by_variance.solve(u)), u.dot(step) / power);
  if (!(statistic >= 0.0) || !step.allFinite()) {
    score.unobservable = "its numbers cannot be told from each other";
    return;
  }
  score.fall = u.dot(step);
  score.chance = std::max(by_normal.solve(variance).trace(), static_cast<double>(u.size()) * power);
  const Eigen::Index k = u.size();
  if (k == 1) {
    const double deviate = u[0] / std::sqrt(std::max(variance(0, 0), power * normal(0, 0)));
    const double bounded = normal_tail(effect.one_sided ? deviate : std::abs(deviate));
    score.p = effect.one_sided ? bounded : std::min(1.0, 2.0 * bounded);
    score.z = deviate;
    if (effect.one_sided && deviate < 0.0) score.fall = 0.0;
  } else {
    score.p = chi_square_tail(statistic, static_cast<double>(k));
    score.z = std::sqrt(statistic);
  }
  for (Eigen::Index i = 0; i < k; ++i) {
    const RecordNumber& n = effect.numbers[score.numbers[static_cast<std::size_t>(i)]];
    const double scale = score.scale[static_cast<std::size_t>(i)];
    score.start.push_back(std::clamp(n.declared + step[i] * scale, n.lower, n.upper));
  }
}

}  // namespace

RecordScores score_motion(const RecordModel& model, const RecordData& data, const RecordFit& fit,
                          const std::vector<RecordSetting>& fixed, const std::vector<RecordEffect>& effects,
                          double significance) {
  const std::vector<RecordSetting> all = together(fit.settings, fixed);
  std::vector<Trial> trials;
  for (std::size_t e = 0; e < effects.size(); ++e)
    for (std::size_t n = 0; n < effects[e].numbers.size(); ++n)
      trials.push_back({e, n, effects[e].numbers[n].scale, false, {}});
  for (int pass = 0; pass < most_passes && !model.stopped(); ++pass)
    try_sizes(model, data, fit, all, effects, trials);

  RecordScores result;
  const Eigen::MatrixXd fitted = free_to_move(fit);
  const Projection projection(fitted);
  std::vector<Eigen::VectorXd> usable;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    RecordScore score;
    score.effect = e;
    std::vector<const Trial*> seen;
    double before = 0.0;
    bool simulated = false;
    for (const Trial& t : trials) {
      if (t.effect != e || t.column.size() == 0) continue;
      simulated = true;
      before = std::max(before, t.column.norm());
      if (t.column.norm() > 0.0) seen.push_back(&t);  // of a vector the records may show one component alone
    }
    if (!simulated) {
      score.unobservable = "the scenario cannot be simulated with it";
    } else {
      keep_independent(projection, seen, score);
      if (!(before > 0.0))
        score.unobservable = "it changes nothing in these records";
      else if (score.numbers.empty())
        score.unobservable = "the fitted numbers change the records in the same way";
    }
    if (score.unobservable.empty())
      for (Eigen::Index k = 0; k < score.columns.cols(); ++k) usable.emplace_back(score.columns.col(k));
    result.scores.push_back(std::move(score));
  }
  // Noise of what no effect can take away.
  Eigen::MatrixXd everything(data.rows, fitted.cols() + static_cast<Eigen::Index>(usable.size()));
  if (fitted.cols() > 0) everything.leftCols(fitted.cols()) = fitted;
  for (std::size_t k = 0; k < usable.size(); ++k)
    everything.col(fitted.cols() + static_cast<Eigen::Index>(k)) = usable[k];
  const Eigen::Index columns = std::min(everything.cols(), data.rows / 2);  // each takes a degree of freedom
  const Eigen::VectorXd left = Projection(everything).without(fit.residual);
  result.noise = coloured_noise(data, left, columns);
  const double power =
      std::max(1e-300, left.squaredNorm() / std::max(1.0, static_cast<double>(data.rows - columns)));

  std::vector<double> p;
  for (RecordScore& score : result.scores) {
    if (score.unobservable.empty())
      judge(data, result.noise, power, fit.residual, effects[score.effect], score);
    if (score.unobservable.empty()) p.push_back(score.p);
  }
  const std::vector<double> adjusted = holm(p);
  const double needed = normal_quantile(significance / std::max<double>(1.0, static_cast<double>(p.size()))) +
                        1.2816;  // nine of ten
  std::size_t next = 0;
  for (RecordScore& score : result.scores) {
    if (!score.unobservable.empty()) continue;
    score.adjusted_p = adjusted[next++];
    if (score.columns.cols() != 1) continue;
    const double norm = score.columns.squaredNorm();
    score.detectable =
        needed * coloured(data, result.noise, score.columns).norm() / norm * score.scale.front();
  }
  return result;
}

}  // namespace snare::identification
