#include "identification/tracing/tracer.hpp"

#include "identification/effects/catalogue.hpp"
#include "identification/fitting/conditions.hpp"
#include "identification/fitting/statistics.hpp"
#include "identification/tracing/outside_causes.hpp"
#include "identification/tracing/reading_findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace snare::identification {

namespace {

/// The step of a search: fewer edges than for results.
SolverSettings for_search(const SolverSettings& asked) {
  SolverSettings search = asked;
  search.elements = std::min(128, asked.elements);
  return search;
}

}  // namespace

Tracer::Tracer(const Experiment& experiment, const TraceOptions& options, Division series)
    : experiment_(experiment),
      options_(options),
      progress_(options.progress),
      model_(std::move(series.fitted), for_search(experiment.solver)),
      heldout_(series.heldout, for_search(experiment.solver)),
      all_(series.all, experiment.solver, false),
      data_(data_of(model_.series(), experiment.published_scatter)) {
  result_.series = std::move(series.all);
  result_.from_laws = series.from_laws;
  result_.heldout = series.is_heldout;
}

// The settings of a fit, and every series pushed from where its readings say that the pusher stood.
std::vector<Setting> Tracer::with_places(const Fit& fit) const {
  std::vector<Setting> settings = fit.settings;
  const std::vector<std::vector<std::size_t>> groups = tests(result_.series);
  for (const PlaceEstimate& place : data_.places(model_, fit.evaluation, fit.covariance)) {
    // Those held out were pushed from there, too.
    const auto same = std::ranges::find_if(groups, [&](const std::vector<std::size_t>& group) {
      return std::ranges::any_of(
          group, [&](std::size_t k) { return result_.series[k].name == place.series.front(); });
    });
    for (const std::size_t k : *same) {
      const Parameter& own = parameters().at(fmt::format("series[{}].{}", result_.series[k].name, place_key));
      double shift = place.shift;  // beside what the model itself shifts it by: the later setting counts
      for (const Setting& s : fit.settings) {
        if (s.parameter == &own || s.parameter->key == place_key) shift += s.coordinate;
      }
      settings.push_back({&own, shift});
    }
  }
  return settings;
}

// Every reading of every series has a point of its own here, of a million readings for minutes.
ModelError Tracer::error_of(const Fit& fit, SharedPredictions& predictions) const {
  PredictionOptions whole;
  whole.stop = options_.stop;
  std::vector<Prediction> curves = all_.predict_with(all_.apply(with_places(fit)), whole);
  for (const Prediction& p : curves) {
    if (p.curve.curve.report.termination == numerics::Termination::interrupted) throw Stopped{};
  }
  predictions = std::move(curves);
  return model_error(result_.series, result_.heldout, predictions, model_, fit);
}

const std::vector<ChannelFunction>& Tracer::functions() {
  if (functions_.empty()) functions_ = attribute(model_, data_, base_);
  return functions_;
}

std::vector<ChannelFunction> Tracer::rivals() {
  const double base = left_out_excess(model_, data_, base_);
  const double predicted = base > 0.0 ? 1.0 - left_out_excess(model_, data_, current_) / base : 0.0;
  return rivals_outside(functions(), classes_.front(), current_.chi2, predicted);
}

// The declared model as it is and the base model as fitted: errors and what is left.
void Tracer::look_at_base() {
  Fit declared;
  declared.evaluation = model_.evaluate({});
  if (declared.evaluation.complete) {
    declared.residual = data_.residual(declared.evaluation);
    declared.chi2 = declared.residual.squaredNorm();
    SharedPredictions predictions;
    result_.declared = error_of(declared, predictions);
    result_.declared_predictions = forces_only(predictions);
  }
  std::vector<std::vector<double>> forces;
  for (const Prediction& p : result_.declared_predictions) forces.push_back(p.force);
  result_.findings = sign_findings(result_.series, forces, model_.solver());
  result_.base_tests = test_residuals(model_, data_, base_);
  if (only_fitted())
    return;  // then the final model is the base model, and its curves of a million readings are computed once
  result_.base = error_of(base_, base_predictions_);
  result_.base_predictions = forces_only(base_predictions_);
}

// The trace as it would be without what is still to come.
void Tracer::tell_part() const {
  if (!options_.reached) return;
  Trace part = result_;
  part.interrupted = true;
  part.seconds = progress_.seconds();
  if (part.final_predictions.empty()) {
    part.final_settings = base_.settings;
    part.final_tests = part.base_tests;
    part.final = part.base;
    part.final_predictions = base_predictions_;
  }
  options_.reached(part);
}

// The numbers of the current fit where they began; empty where no effect among them was tried at finite sizes
// only.
std::vector<Setting> Tracer::begun_anew() const {
  std::vector<Setting> begun;
  for (const RoundFits& round : rounds_) begun.insert(begun.end(), round.begun.begin(), round.begun.end());
  if (begun.empty()) return {};
  begun.insert(begun.end(), base_.settings.begin(), base_.settings.end());
  std::vector<Setting> settings = current_.fitted();
  for (Setting& s : settings) {
    const auto same = [&s](const Setting& one) { return one.parameter == s.parameter; };
    const auto at = std::find_if(begun.begin(), begun.end(), same);
    if (at != begun.end()) s.coordinate = at->coordinate;
  }
  return settings;
}

// Effects one at a time, until what is left is no more than noise or no effect of the catalogue helps.
void Tracer::add_effects() {
  current_ = base_;
  tests_ = result_.base_tests;
  result_.few_readings = base_.dof() - 1.0 < fewest_dof(base_.free + 1);
  if (has_finding(result_.findings, FindingKind::sign_turned))
    return;  // effects of such readings mean nothing
  const double tolerance = result_.tolerance;
  while (static_cast<int>(added_.size()) < options_.most_effects) {
    // Where a size is asked for, what is smaller is not looked for.
    if (result_.few_readings || (tolerance > 0.0 && tests_.within(tolerance))) break;
    const std::size_t number = result_.rounds.size() + 1;
    if (!progress_.go_on(fmt::format("round {}: scores of {} effects", number, catalogue().size()))) break;
    const double significance = number == 1 ? options_.significance : options_.further_significance;
    RoundFits found =
        look_for_effect(model_, data_, heldout_,
                        {current_, tests_.left, begun_anew(), number == 1 && !tests_.acceptable(tolerance)},
                        number, {significance, tolerance}, progress_);
    result_.rounds.push_back(std::move(found.round));
    const Round& round = result_.rounds.back();
    for (std::size_t k = 0; k < found.rivals.size(); ++k) {
      models_.push_back({added_, k == 0 && !round.added.empty() ? found.better : found.rivals[k]});
      models_.back().effects.push_back(found.rival_names[k]);
    }
    if (round.added.empty()) break;
    added_.push_back(round.added);
    classes_.push_back(round.classes[round.candidates.front().class_index]);
    numbers_.push_back(found.better.free - current_.free);
    current_ = found.better;
    rounds_.push_back(std::move(found));
    tests_ = test_residuals(model_, data_, current_);
    // Where one cause that the catalogue does not have carries over, several effects would be rejected in the
    // end.
    if (!tests_.acceptable(tolerance) && options_.attribute && one_for_several(rivals())) break;
  }
}

// Whether the model needs the effect: what chi2 rises by without it, all others refitted, against the
// variance that the model leaves, by F, all effects that could be seen counted.               theory.md (I.9)
bool Tracer::needed(std::size_t which, double inflation, Fit& without) {
  std::vector<Setting> start;
  std::size_t first = base_.free;
  for (std::size_t k = 0; k < which; ++k) first += numbers_[k];
  for (std::size_t k = 0; k < current_.free; ++k) {
    if (k < first || k >= first + numbers_[which]) start.push_back(current_.settings[k]);
  }
  without = added_.size() == 1 ? base_ : fit(model_, data_, start);
  if (!without.report.usable()) return true;
  double seen = 0.0;
  for (const Candidate& c : result_.rounds.front().candidates)
    seen += c.score.unobservable.empty() ? 1.0 : 0.0;
  const auto numbers = static_cast<double>(numbers_[which]);
  const double gain = (without.chi2 - current_.chi2) / numbers;
  const double below = inflation > 1.0 ? std::min(data_.noise.dof, tests_.left.directions) : data_.noise.dof;
  return std::max(1.0, seen) * fisher_tail(gain / inflation, numbers, below) < options_.significance;
}

// Effects without which the model does as well, seen from what it leaves, go again.
void Tracer::drop_unneeded() {
  for (bool dropped = true; dropped && !added_.empty() && !progress_.interrupted();) {
    dropped = false;
    const double inflation = tests_.left.inflation();
    for (std::size_t k = added_.size(); k-- > 0 && !dropped;) {
      Fit without;
      if (needed(k, inflation, without)) continue;
      const auto at = static_cast<std::ptrdiff_t>(k);
      result_.partial.push_back(added_[k]);
      added_.erase(added_.begin() + at);
      classes_.erase(classes_.begin() + at);
      numbers_.erase(numbers_.begin() + at);
      rounds_.erase(rounds_.begin() + at);
      current_ = std::move(without);
      tests_ = test_residuals(model_, data_, current_);
      dropped = true;
    }
  }
}

// Whether the effects explain the residual: they leave no more than noise, and no cause that the catalogue
// does not have is the simpler one. What the catalogue explains such a cause may explain as well: theory.md
// (I.8).
bool Tracer::accept() {
  if (added_.empty() || !options_.attribute || !progress_.go_on("causes outside the catalogue")) return true;
  if (serial_noise_does()) {
    result_.serial_rival = true;
    return false;
  }
  std::vector<ChannelFunction> outside = rivals();
  if (!outside.empty()) {
    result_.rival_explanation = simpler_outside(outside, model_, data_, current_, added_.size());
    if (!result_.rival_explanation) result_.alternatives = std::move(outside);
  }
  progress_.clock("causes outside the catalogue");
  return !result_.rival_explanation;
}

// Whether a stiffness of the fit exceeds that of the declared section with all of its interval, by more than
// moduli and diameters are uncertain.
bool Tracer::beyond_section(const Fit& fit) const {
  constexpr double well_beyond = 1.05;
  return !beyond_construction(model_, numbers_of(model_, fit), well_beyond).empty();
}

// Errors below the usual tolerance are looked into only where a stiffness beyond the section may replace an
// effect. An effect counts only if it brings the stiffness back and leaves noise.             theory.md (I.9)
void Tracer::look_for_effects() {
  const double usual = result_.tolerance;
  const bool stands_in = usual > 0.0 && !experiment_.model_tolerance && !result_.base_tests.within_noise() &&
                         result_.base_tests.within(usual) && beyond_section(base_);
  if (!stands_in) {
    add_effects();
    return;
  }
  result_.tolerance = 0.0;
  add_effects();
  if (!added_.empty() && tests_.within_noise() && !beyond_section(current_)) return;
  result_.tolerance = usual;
  result_.rounds.clear();
  rounds_.clear();
  added_.clear();
  numbers_.clear();
  classes_.clear();
  current_ = base_;
  tests_ = result_.base_tests;
}

Trace Tracer::run() {
  const auto finished = [this]() -> Trace&& {
    result_.interrupted = progress_.interrupted();
    result_.seconds = progress_.seconds();
    return std::move(result_);
  };
  progress_.clock("reading");
  base_ = fit_base(experiment_, options_.free, model_, data_, progress_);
  if (!base_.report.usable()) {
    result_.report = base_.report;
    result_.report.message = "the base model cannot be fitted: " + base_.report.message;
    return finished();
  }
  settle_noise(model_, data_, base_);
  if (!base_.report.usable()) {
    result_.report = base_.report;
    return finished();
  }
  leave_kinks(model_, data_, base_, progress_);
  find_rank(model_, data_, base_);
  result_.noise = data_.noise;
  result_.rows = static_cast<std::size_t>(data_.rows());
  result_.peak_force = peak_force(data_);
  result_.tolerance = model_tolerance(experiment_, data_);
  result_.one_condition = !left_out_conditions(model_, data_).several;
  progress_.clock("base fit");
  look_at_base();
  progress_.clock("errors of declared and base model");
  if (!only_fitted()) tell_part();
  look_for_effects();
  conclude();
  current_ = {};  // what is selected is in final_
  weigh();
  if (!has_finding(result_.findings, FindingKind::series_of_another_specimen) &&
      !has_finding(result_.findings, FindingKind::series_exchanged) &&
      progress_.go_on("zero of the travel")) {
    result_.zero = check_zero(model_, data_, final_);  // before its residual counts as autocorrelated noise
    progress_.clock("zero of the travel");
  }
  widen_for_serial_noise();
  compare_models();
  average_intervals();
  result_.decided = decided();
  tell_part();
  if (options_.intervals && !result_.selected.empty()) find_intervals();
  if (progress_.go_on("next experiment")) propose();
  progress_.clock("next experiment");
  return finished();
}

Trace trace(const Experiment& experiment, const TraceOptions& options) {
  try {
    return Tracer(experiment, options, Division(experiment)).run();
  } catch (const Stopped&) {
    Trace stopped;
    stopped.interrupted = true;
    stopped.report.end(numerics::Termination::interrupted, "interrupted");
    return stopped;
  }
}

}  // namespace snare::identification
