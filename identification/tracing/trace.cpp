#include "identification/tracing/trace.hpp"

#include "identification/tracing/next_experiment.hpp"
#include "identification/tracing/trace_input.hpp"
#include "base/errors.hpp"

#include <fmt/format.h>


#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace snare::identification {

namespace {

using base::InputError;

constexpr double collinear = 0.95;      // |cos| above which effects are one class
constexpr double indistinct_bic = 6.0;  // difference of BIC below which the likelihood does not decide (Kass and Raftery 1995)
constexpr double out_of_class_bic = 30.0;  // well beyond it
constexpr double worthwhile_bic = 2.0;  // gain of BIC that an effect must bring
constexpr double one_cause = 0.9;       // share of an excess that an unknown function must carry over to rival effects
constexpr double rest_of_rival = 0.001; // P below which an effect has left something in the direction of its rival
constexpr std::size_t most_refits = 6;
// A refit gains about z^2 of chi2, more where the model bends (thresholds): effects whose z^2 is below this share of the
// best gain cannot lead and are not refitted.
constexpr double refit_share = 0.4;
constexpr double near_significance = 0.05;

/// The step of a search: fewer edges than for results.
SolverSettings for_search(const SolverSettings& asked) {
  SolverSettings search = asked;
  search.elements = std::min(128, asked.elements);
  return search;
}

std::vector<FittedNumber> numbers_of(const Model& model, const Fit& fit) {
  std::vector<FittedNumber> result;
  for (std::size_t k = 0; k < fit.free; ++k) {
    const Setting& s = fit.settings[k];
    const Parameter& p = *s.parameter;
    FittedNumber n;
    n.key = p.key;
    n.unit = p.unit;
    n.declared = p.shown(model.declared(p), 0.0);
    if (p.parametrisation == Parametrisation::magnitude) n.declared = std::numeric_limits<double>::infinity();
    n.value = model.shown(s);
    const auto i = static_cast<Eigen::Index>(k);
    if (fit.covariance.rows() > i && fit.jacobian.col(i).norm() > 0.0) {
      const double deviation = std::sqrt(std::max(0.0, fit.covariance(i, i)));
      n.standard_error = p.parametrisation == Parametrisation::shift ? deviation / p.unit_size : std::abs(n.value) * deviation;
      n.lower = model.shown({&p, s.coordinate - 1.96 * deviation});
      n.upper = model.shown({&p, s.coordinate + 1.96 * deviation});
    }
    result.push_back(n);
  }
  return result;
}

/// A trace under way.
class Tracer {
 public:
  Tracer(const Experiment& experiment, const TraceOptions& options) : experiment_(experiment), options_(options) {}
  Trace run();

 private:
  void prepare();
  [[nodiscard]] Fit fit_base();
  void settle_noise(Fit& base);
  [[nodiscard]] ModelError error_of(const Model& all, const Fit& fit, std::vector<Prediction>& predictions) const;
  [[nodiscard]] Round look(const Fit& current, Fit& better);
  [[nodiscard]] Fit refit(const Fit& current, const Score& score, double rival) const;
  void judge(const Fit& current, std::optional<double> heldout_before, Candidate& candidate, const Fit& refitted) const;
  void classify(const Fit& current, Round& round, const std::vector<Fit>& fits) const;
  [[nodiscard]] std::optional<double> heldout_rmse(const Fit& fit) const;
  [[nodiscard]] double left_out_rmse(const Fit& fit) const;
  [[nodiscard]] std::vector<ChannelFunction> rivals_outside(const Fit& base, const Fit& current,
                                                             const std::string& first_effect);
  void look_outside(const Fit& base, const Fit& current, const std::vector<std::string>& added);
  void propose();
  [[nodiscard]] bool go_on(const std::string& stage);
  void clock(const std::string& what);

  const Experiment& experiment_;
  const TraceOptions& options_;
  Trace result_;
  std::optional<Model> model_;    // of the fitted series
  std::optional<Model> heldout_;  // of the others
  std::vector<Eigen::VectorXd> heldout_measured_;
  Data data_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  std::vector<ChannelFunction> functions_;    // of the base model's residual, once asked for
  std::vector<std::vector<Fit>> rivals_;      // of each round: refits of the class that was added, best first
  std::vector<std::vector<std::string>> rival_names_;
};

bool Tracer::go_on(const std::string& stage) {
  if (!result_.interrupted && options_.progress && !options_.progress(stage)) result_.interrupted = true;
  return !result_.interrupted;
}

void Tracer::clock(const std::string& what) {
  const auto now = std::chrono::steady_clock::now();
  result_.seconds.emplace_back(what, std::chrono::duration<double>(now - last_).count());
  last_ = now;
}

void Tracer::prepare() {
  result_.series = experiment_.series;
  result_.drawn = replace_laws(result_.series, options_.draw, options_.seed);
  std::vector<Series> fitted;
  std::vector<Series> held;
  for (const Series& s : result_.series) {
    const bool out = std::find(experiment_.heldout.begin(), experiment_.heldout.end(), s.name) != experiment_.heldout.end();
    result_.heldout.push_back(out);
  }
  check_readings(experiment_.file, result_.series, result_.heldout);
  for (std::size_t k = 0; k < result_.series.size(); ++k) {
    (result_.heldout[k] ? held : fitted).push_back(result_.series[k]);
  }
  for (std::size_t k = 0; k < fitted.size(); ++k) {
    const std::vector<double>& f = fitted[k].readings->force;
    data_.series.push_back(k);
    data_.measured.emplace_back(Eigen::Map<const Eigen::VectorXd>(f.data(), static_cast<Eigen::Index>(f.size())));
  }
  for (const Series& s : held) {
    const std::vector<double>& f = s.readings->force;
    heldout_measured_.emplace_back(Eigen::Map<const Eigen::VectorXd>(f.data(), static_cast<Eigen::Index>(f.size())));
  }
  data_.noise = known_noise(fitted);
  const SolverSettings search = for_search(experiment_.solver);
  if (!held.empty()) heldout_.emplace(held, search);
  model_.emplace(std::move(fitted), search);
}

Fit Tracer::fit_base() {
  std::vector<std::string> keys = options_.free;
  if (keys.empty()) keys = experiment_.free;
  if (keys.empty()) keys = default_free(experiment_);
  std::vector<Setting> start;
  bool length = false;
  for (const std::string& key : keys) {
    const Parameter& p = parameter(key);
    const double declared = model_->declared(p);
    if (!std::isfinite(declared)) {
      throw InputError({experiment_.file.string(), 0, "fit.free", fmt::format("\"{}\"", key),
                        "is a threshold that the declared model does not have: declare a value to start from"});
    }
    start.push_back({&p, p.coordinate(declared, declared)});
    length = length || key == "wire.length_mm";
  }
  if (data_.rows() < static_cast<Eigen::Index>(keys.size()) + 3) {
    throw InputError({experiment_.file.string(), 0, "fit.free", std::to_string(keys.size()) + " keys",
                      fmt::format("must leave at least 3 of the {} readings over", data_.rows())});
  }
  if (data_.noise.sigma.empty()) data_.noise.sigma.assign(model_->series().size(), 1.0);
  FitOptions fitting;
  fitting.progress = [this](int iteration, double) { return go_on(fmt::format("base model: iteration {}", iteration)); };
  Fit best = fit(*model_, data_, start, {}, fitting);
  if (length) {
    // A loose wire that is nearly straight lies in a valley of its own.
    for (Setting& s : start) {
      if (s.parameter->key == "wire.bending_stiffness_Nm2") s.coordinate = std::log(0.05);
      if (s.parameter->key == "wire.axial_stiffness_N") s.coordinate = std::log(0.3);
      if (s.parameter->key == "wire.length_mm") {
        s.coordinate = s.parameter->coordinate(model_->declared(*s.parameter), 1.002 * model_->series().front().test.mount.span);
      }
    }
    const Fit other = fit(*model_, data_, start, {}, fitting);
    if (other.report.usable() && (!best.report.usable() || other.chi2 < best.chi2)) best = other;
  }
  return best;
}

void Tracer::settle_noise(Fit& base) {
  if (!data_.noise.source.empty()) return;
  std::vector<Eigen::VectorXd> residuals;
  for (std::size_t k = 0; k < data_.measured.size(); ++k) residuals.push_back(data_.measured[k] - base.evaluation.force[k]);
  data_.noise = noise_from_residuals(model_->series(), residuals);
  const std::vector<Setting> start(base.settings.begin(), base.settings.begin() + static_cast<std::ptrdiff_t>(base.free));
  base = fit(*model_, data_, start);
}

ModelError Tracer::error_of(const Model& all, const Fit& fit, std::vector<Prediction>& predictions) const {
  ModelError error;
  predictions = all.evaluate(fit.settings).predictions;
  double squares = 0.0;
  double count = 0.0;
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();
  for (std::size_t k = 0; k < result_.series.size(); ++k) {
    const std::vector<double>& measured = result_.series[k].readings->force;
    const Misfit m = misfit(measured, predictions[k].force);
    error.series_rmse.push_back(m.rmse);
    if (result_.heldout[k]) continue;
    const auto n = static_cast<double>(std::min(measured.size(), predictions[k].force.size()));
    squares += n * m.rmse * m.rmse;
    count += n;
    low = std::min(low, *std::min_element(measured.begin(), measured.end()));
    high = std::max(high, *std::max_element(measured.begin(), measured.end()));
  }
  error.rmse = count > 0.0 ? std::sqrt(squares / count) : 0.0;
  error.nrmse = error.rmse / (high - low);
  error.chi2_dof = fit.chi2 / std::max(1.0, fit.dof());
  error.numbers = numbers_of(*model_, fit);
  return error;
}

Fit Tracer::refit(const Fit& current, const Score& score, double rival) const {
  Fit best;
  best.chi2 = std::numeric_limits<double>::max();
  best.free = current.free;
  best.report.termination = numerics::Termination::step_too_small;
  for (const std::vector<double>& coordinates : score.starts) {
    std::vector<Setting> start = current.fitted();
    for (std::size_t k = 0; k < coordinates.size(); ++k) {
      const EffectNumber& number = score.effect->numbers[k];
      if (number.optional && coordinates[k] == 0.0) continue;
      start.push_back({&parameter(number.key), coordinates[k]});
    }
    FitOptions fitting;
    fitting.max_iterations = 30;
    fitting.tolerance = 1e-4;
    fitting.rival = rival;
    Fit one = fit(*model_, data_, start, {}, fitting);
    if (one.report.usable() && one.bic() < best.bic()) best = std::move(one);
  }
  return best;
}

void Tracer::judge(const Fit& current, std::optional<double> heldout_before, Candidate& candidate,
                   const Fit& refitted) const {
  candidate.refitted = refitted.report.usable();
  if (!candidate.refitted) return;
  double squares = 0.0;
  for (const std::size_t k : data_.series) squares += (data_.measured[k] - refitted.evaluation.force[k]).squaredNorm();
  candidate.rmse = std::sqrt(squares / static_cast<double>(data_.rows()));
  candidate.delta_bic = refitted.bic() - current.bic();
  const std::vector<FittedNumber> all = numbers_of(*model_, refitted);
  candidate.numbers.assign(all.begin() + static_cast<std::ptrdiff_t>(current.free), all.end());
  const Effect& effect = *candidate.score.effect;
  for (std::size_t k = 0; k < candidate.numbers.size(); ++k) {
    const FittedNumber& n = candidate.numbers[k];
    const EffectNumber& range = *std::find_if(effect.numbers.begin(), effect.numbers.end(),
                                              [&n](const EffectNumber& e) { return e.key == n.key; });
    const Parameter& p = parameter(n.key);
    const double coordinate = refitted.settings[current.free + k].coordinate;
    const double width = model_->upper(p) - model_->lower(p);
    const bool at_bound = coordinate - model_->lower(p) < 1e-6 * width || model_->upper(p) - coordinate < 1e-6 * width;
    if (n.value < range.plausible_lower || n.value > range.plausible_upper) {
      candidate.plausible = false;
      candidate.why_implausible = fmt::format("{} = {:.4g} {}, plausible is {:g} to {:g}", n.key, n.value, n.unit,
                                              range.plausible_lower, range.plausible_upper);
    } else if (at_bound && !(effect.one_sided && coordinate - model_->lower(p) < 1e-6 * width)) {
      candidate.plausible = false;
      candidate.why_implausible = fmt::format("{} = {:.4g} {} is at the end of what it may be", n.key, n.value, n.unit);
    }
  }
  if (heldout_) {
    const std::optional<double> after = heldout_rmse(refitted);
    // At the noise already it need not improve any more.
    const double sigma = data_.noise.mean_sigma(model_->series());
    candidate.heldout_improves = heldout_before && after && (*after < *heldout_before || *after < 1.1 * sigma);
  }
}

std::optional<double> Tracer::heldout_rmse(const Fit& fit) const {
  if (!heldout_) return std::nullopt;
  const Evaluation at = heldout_->evaluate(fit.settings);
  if (!at.complete) return std::nullopt;
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t k = 0; k < heldout_measured_.size(); ++k) {
    squares += (heldout_measured_[k] - at.force[k]).squaredNorm();
    count += static_cast<double>(heldout_measured_[k].size());
  }
  return std::sqrt(squares / count);
}

// Every series predicted by a fit to the others, to first order: theory.md (I.5).
double Tracer::left_out_rmse(const Fit& fit) const {
  double squares = 0.0;
  Eigen::Index row = 0;
  for (const std::size_t k : data_.series) {
    const Eigen::Index n = data_.measured[k].size();
    Eigen::MatrixXd rest(fit.jacobian.rows() - n, fit.jacobian.cols());
    rest << fit.jacobian.topRows(row), fit.jacobian.bottomRows(fit.jacobian.rows() - row - n);
    Eigen::VectorXd r(rest.rows());
    r << fit.residual.head(row), fit.residual.tail(fit.residual.size() - row - n);
    const Eigen::VectorXd step = covariance_of(rest) * (rest.transpose() * r);
    Eigen::VectorXd left = fit.residual.segment(row, n) - fit.jacobian.middleRows(row, n) * step;
    // Numbers of this series alone (its zero) only it can tell.
    std::vector<Eigen::Index> own;
    for (std::size_t j = 0; j < fit.free; ++j) {
      if (fit.settings[j].parameter->only == model_->series()[k].name) own.push_back(static_cast<Eigen::Index>(j));
    }
    if (!own.empty()) left = Projection(fit.jacobian(Eigen::all, own).middleRows(row, n)).without(left);
    squares += left.squaredNorm() * data_.noise.sigma[k] * data_.noise.sigma[k];
    row += n;
  }
  return std::sqrt(squares / static_cast<double>(data_.rows()));
}

// Classes: the leading effect with all that the data cannot tell from it, then the others by their directions.
void Tracer::classify(const Fit& current, Round& round, const std::vector<Fit>& fits) const {
  std::vector<Candidate>& all = round.candidates;
  std::vector<bool> placed(all.size(), false);
  const auto alike = [&](const Candidate& a, const Candidate& b) {
    if (a.score.direction.size() == 0 || b.score.direction.size() == 0) return false;
    return std::abs(a.score.direction.dot(b.score.direction)) > collinear;
  };
  const auto absorbed = [](const Candidate& c) { return c.score.absorbed; };
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (placed[i]) continue;
    std::vector<std::string> names;
    const bool with_base = absorbed(all[i]);
    if (with_base) {
      for (std::size_t k = 0; k < current.free; ++k) {
        for (const Effect& e : catalogue()) {
          if (e.numbers.front().key == current.settings[k].parameter->key) names.push_back(e.name);
        }
      }
    }
    for (std::size_t j = i; j < all.size(); ++j) {
      if (placed[j]) continue;
      const bool leads = i == 0 && all[i].refitted && all[j].refitted && all[j].plausible && j < fits.size() &&
                         all[j].delta_bic - all[i].delta_bic < indistinct_bic && all[i].delta_bic < -worthwhile_bic;
      const bool same = j == i || (with_base ? absorbed(all[j]) : !absorbed(all[j]) && (leads || alike(all[i], all[j])));
      if (!same) continue;
      placed[j] = true;
      all[j].class_index = round.classes.size();
      names.push_back(all[j].score.effect->name);
    }
    round.classes.push_back(names);
  }
}

// One round: scores, refits of the best, ranking, classes; `better` is the model with the effect added, if any.
Round Tracer::look(const Fit& current, Fit& better) {
  Round round;
  const std::string number = fmt::format("round {}", result_.rounds.size() + 1);
  ScoreOptions scoring;
  scoring.significance = result_.rounds.empty() ? options_.significance : options_.further_significance;
  std::vector<Score> scores = score_effects(*model_, data_, current, scoring);
  clock(number + ": scores");
  std::stable_sort(scores.begin(), scores.end(), [](const Score& a, const Score& b) {
    if (a.unobservable.empty() != b.unobservable.empty()) return a.unobservable.empty();
    return a.z * a.z > b.z * b.z;
  });
  for (Score& s : scores) {
    Candidate c;
    c.score = std::move(s);
    round.candidates.push_back(std::move(c));
  }
  // Refit the significant ones and what is nearly in their direction.
  std::vector<Fit> fits(round.candidates.size());
  const std::optional<double> before = heldout_rmse(current);
  std::size_t refits = 0;
  double best_gain = 0.0;
  for (std::size_t i = 0; i < round.candidates.size() && refits < most_refits; ++i) {
    Candidate& c = round.candidates[i];
    if (!c.score.unobservable.empty() || c.score.adjusted_p > near_significance) continue;
    if (refits > 0 && c.score.z * c.score.z < refit_share * best_gain - 10.0) continue;
    if (!go_on(number + ": refit with " + c.score.effect->name)) break;
    // What cannot come near the best so far is not followed to its own bottom.
    fits[i] = refit(current, c.score, best_gain > 0.0 ? current.chi2 - best_gain + out_of_class_bic : 0.0);
    judge(current, before, c, fits[i]);
    if (c.refitted && c.plausible) best_gain = std::max(best_gain, current.chi2 - fits[i].chi2);
    ++refits;
  }
  clock(number + ": refits");
  const auto eligible = [&](const Candidate& c) {
    return c.refitted && c.plausible && c.score.adjusted_p < scoring.significance && c.delta_bic < -worthwhile_bic &&
           c.heldout_improves.value_or(true);
  };
  // Eligible first, by BIC; then the other refitted ones; then by score as they stand.
  std::vector<std::size_t> order(round.candidates.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const Candidate& x = round.candidates[a];
    const Candidate& y = round.candidates[b];
    if (eligible(x) != eligible(y)) return eligible(x);
    if (x.refitted != y.refitted) return x.refitted;
    return x.refitted && x.delta_bic < y.delta_bic;
  });
  std::vector<Candidate> ranked;
  std::vector<Fit> ranked_fits;
  for (const std::size_t i : order) {
    ranked.push_back(std::move(round.candidates[i]));
    ranked_fits.push_back(std::move(fits[i]));
  }
  round.candidates = std::move(ranked);
  classify(current, round, ranked_fits);

  const Candidate* first = round.candidates.empty() ? nullptr : &round.candidates.front();
  if (first != nullptr && eligible(*first)) {
    round.added = first->score.effect->name;
    round.reason = fmt::format("its score has p = {:.2g} (all effects counted), the refit lowers BIC by {:.4g}",
                               first->score.adjusted_p, -first->delta_bic);
    better = ranked_fits.front();
    // To the bottom.
    const Fit polished = fit(*model_, data_, better.fitted());
    if (polished.report.usable() && polished.chi2 <= better.chi2) better = polished;
    std::vector<Fit> rivals;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < round.candidates.size(); ++i) {
      const Candidate& c = round.candidates[i];
      if (c.class_index != first->class_index || !c.refitted || !c.plausible) continue;
      rivals.push_back(ranked_fits[i]);
      names.push_back(c.score.effect->name);
    }
    // Alone in its class: the runner-up is what a next experiment should shut out.
    if (rivals.size() == 1 && round.candidates.size() > 1 && round.candidates[1].refitted) {
      rivals.push_back(ranked_fits[1]);
      names.push_back(round.candidates[1].score.effect->name);
    }
    rivals_.push_back(std::move(rivals));
    rival_names_.push_back(std::move(names));
    return round;
  }
  const bool any = std::any_of(round.candidates.begin(), round.candidates.end(), [&](const Candidate& c) {
    return c.score.unobservable.empty() && c.score.adjusted_p < scoring.significance;
  });
  if (!any) round.reason = "no effect of the catalogue is significant";
  else round.reason = "the significant effects do not survive the refit (BIC, plausible values, held-out series)";
  return round;
}

// Unknown functions of one channel that explain what the base model leaves no worse than the effects do, and carry over.
std::vector<ChannelFunction> Tracer::rivals_outside(const Fit& base, const Fit& current, const std::string& first_effect) {
  if (functions_.empty()) functions_ = attribute(*model_, data_, base);
  std::vector<ChannelFunction> rivals;
  for (const ChannelFunction& f : functions_) {
    // In the channel of the effect itself it is that effect in another dress.
    const bool elsewhere = f.channel != find_effect(first_effect)->channel;
    if (elsewhere && f.carried_over > one_cause && f.chi2 < current.chi2 + indistinct_bic) rivals.push_back(f);
  }
  return rivals;
}

// What the catalogue explains a cause that it does not have may explain as well: theory.md (I.8).
void Tracer::look_outside(const Fit& base, const Fit& current, const std::vector<std::string>& added) {
  std::vector<ChannelFunction> rivals = rivals_outside(base, current, added.front());
  if (rivals.empty()) return;
  // One cause that carries over is simpler than several effects together, and than an effect that leaves something of it.
  bool simpler = added.size() > 1;
  for (const ChannelColumns& c : channel_columns(*model_, data_, current)) {
    const bool rival = std::any_of(rivals.begin(), rivals.end(), [&c](const ChannelFunction& f) {
      return f.channel == c.channel && f.argument == c.argument;
    });
    simpler = simpler || (rival && channel_p(c, current) < rest_of_rival);
  }
  result_.rival_explanation = simpler;
  if (simpler) {
    result_.explained = false;
  } else {
    result_.alternatives = std::move(rivals);
  }
}

void Tracer::propose() {
  for (std::size_t k = 0; k < rivals_.size() && k < result_.selected.size(); ++k) {
    if (rivals_[k].size() < 2) continue;
    result_.next = next_experiment(*model_, rivals_[k][0].settings, rivals_[k][1].settings,
                                   {rival_names_[k][0], rival_names_[k][1]}, data_.noise.mean_sigma(model_->series()));
    return;
  }
}

Trace Tracer::run() {
  prepare();
  clock("reading");
  const std::vector<Series> everything = result_.series;
  const Model all(everything, experiment_.solver, false);

  Fit base = fit_base();
  if (!base.report.usable()) {
    result_.report = base.report;
    result_.report.message = "the base model cannot be fitted: " + base.report.message;
    return std::move(result_);
  }
  settle_noise(base);
  result_.noise = data_.noise;
  clock("base fit");
  Fit declared;
  declared.evaluation = model_->evaluate({});
  if (declared.evaluation.complete) {
    declared.residual = data_.residual(declared.evaluation);
    declared.chi2 = declared.residual.squaredNorm();
    result_.declared = error_of(all, declared, result_.declared_predictions);
  }
  result_.base_tests = test_residuals(data_, base);
  result_.base = error_of(all, base, result_.base_predictions);
  clock("errors of declared and base model");

  Fit current = base;
  ResidualTests tests = result_.base_tests;
  std::vector<std::string> added;
  std::vector<std::vector<std::string>> classes;
  while (static_cast<int>(added.size()) < options_.most_effects) {
    if (!go_on(fmt::format("round {}: scores of {} effects", result_.rounds.size() + 1, catalogue().size()))) break;
    Fit better;
    result_.rounds.push_back(look(current, better));
    const Round& round = result_.rounds.back();
    if (round.added.empty()) break;
    added.push_back(round.added);
    classes.push_back(round.classes[round.candidates.front().class_index]);
    current = std::move(better);
    tests = test_residuals(data_, current);
    // Where one cause that the catalogue does not have carries over, several effects would be rejected in the end.
    if (!tests.acceptable() && options_.attribute && !rivals_outside(base, current, added.front()).empty()) break;
  }
  result_.significant = !result_.base_tests.acceptable() || !added.empty();
  result_.explained = tests.acceptable();
  if (result_.explained && !added.empty() && options_.attribute && go_on("causes outside the catalogue")) {
    look_outside(base, current, added);
    clock("causes outside the catalogue");
  }
  Fit final_fit = base;
  if (result_.explained) {
    final_fit = current;
    result_.selected = added;
    result_.selected_classes = classes;
    for (const ChannelFunction& f : result_.alternatives) {
      const std::string member = "outside:" + to_string(f.channel);
      std::vector<std::string>& first = result_.selected_classes.front();
      if (std::find(first.begin(), first.end(), member) == first.end()) first.push_back(member);
    }
    if (!added.empty()) result_.channel = to_string(find_effect(added.front())->channel);
  } else {
    result_.partial = added;
    if (!added.empty()) {
      double squares = 0.0;
      for (const std::size_t k : data_.series) squares += (data_.measured[k] - current.evaluation.force[k]).squaredNorm();
      result_.partial_rmse = std::sqrt(squares / static_cast<double>(data_.rows()));
    }
    if (options_.attribute && go_on("where the residual comes from")) {
      if (functions_.empty()) functions_ = attribute(*model_, data_, base);
      result_.functions = functions_;
    }
    if (!result_.functions.empty()) result_.channel = to_string(result_.functions.front().channel);
    clock("channels");
  }
  result_.final_settings = final_fit.settings;
  if (result_.selected.empty()) {
    result_.final_tests = result_.base_tests;
    result_.final = result_.base;
    result_.final_predictions = result_.base_predictions;
  } else {
    result_.final_tests = test_residuals(data_, final_fit);
    result_.final = error_of(all, final_fit, result_.final_predictions);
  }
  for (const Prediction& p : result_.final_predictions) {
    for (const double e : p.curve.discretisation_error) result_.mesh_error = std::max(result_.mesh_error, e);
  }
  if (heldout_) {
    const std::optional<double> before = heldout_rmse(base);
    const std::optional<double> after = heldout_rmse(final_fit);
    if (before && after) result_.heldout_rmse = {*before, *after};
  }
  if (data_.series.size() > 1) result_.left_out_rmse = {left_out_rmse(base), left_out_rmse(final_fit)};
  clock("errors of the final model");
  if (options_.intervals && !result_.selected.empty()) {
    for (std::size_t k = base.free; k < final_fit.free; ++k) {
      if (!go_on("interval of " + final_fit.settings[k].parameter->key)) break;
      const ProfileInterval interval = profile_interval(*model_, data_, final_fit, k, 3.84);
      FittedNumber& n = result_.final.numbers[k];
      const Parameter& p = *final_fit.settings[k].parameter;
      n.profiled = true;
      n.lower = interval.lower ? std::optional(model_->shown({&p, *interval.lower})) : std::nullopt;
      n.upper = interval.upper ? std::optional(model_->shown({&p, *interval.upper})) : std::nullopt;
    }
    clock("intervals");
  }
  if (go_on("next experiment")) propose();
  clock("next experiment");
  return std::move(result_);
}

}  // namespace

Trace trace(const Experiment& experiment, const TraceOptions& options) { return Tracer(experiment, options).run(); }

}  // namespace snare::identification
