#include "identification/tracing/trace.hpp"

#include "base/parallel.hpp"
#include "identification/effects/catalogue.hpp"
#include "identification/fitting/conditions.hpp"
#include "identification/fitting/statistics.hpp"
#include "identification/tracing/base_fit.hpp"
#include "identification/tracing/model_average.hpp"
#include "identification/tracing/odd_series.hpp"
#include "identification/tracing/outside_causes.hpp"
#include "identification/tracing/progress.hpp"
#include "identification/tracing/reading_findings.hpp"
#include "identification/tracing/trace_input.hpp"

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

/// Thrown where `TraceOptions::stop` has ended curves.
struct Stopped {};

/// A trace under way.
class Tracer {
 public:
  Tracer(const Experiment& experiment, const TraceOptions& options, Division series);
  Trace run();

 private:
  [[nodiscard]] bool only_fitted() const { return options_.most_effects == 0; }
  void look_at_base();
  void tell_part() const;
  void look_for_effects();
  void add_effects();
  [[nodiscard]] bool beyond_section(const Fit& fit) const;
  [[nodiscard]] std::vector<Setting> begun_anew() const;
  [[nodiscard]] bool accept();
  void drop_unneeded();
  [[nodiscard]] bool needed(std::size_t which, double inflation, Fit& without);
  void conclude();
  void select();
  void reject();
  void find_findings();
  [[nodiscard]] bool decided() const;
  [[nodiscard]] bool numbers_open() const;
  void widen_for_serial_noise();
  [[nodiscard]] bool serial_noise_does() const;
  void compare_models();
  void weigh();
  void average_intervals();
  void find_intervals();
  void propose();
  [[nodiscard]] ModelError error_of(const Fit& fit, SharedPredictions& predictions) const;
  [[nodiscard]] std::vector<Setting> with_places(const Fit& fit) const;
  [[nodiscard]] const std::vector<ChannelFunction>& functions();
  [[nodiscard]] std::vector<ChannelFunction> rivals();

  const Experiment& experiment_;
  const TraceOptions& options_;
  Trace result_;
  Progress progress_;
  Model model_;      // of the fitted series
  HeldOut heldout_;  // the others
  Model all_;        // of every series, on the mesh asked for
  Data data_;
  Fit base_;
  SharedPredictions base_predictions_;  // whole, until another model is chosen
  Fit current_;                         // with the effects added so far
  Fit final_;                           // what is selected
  Data final_data_;                     // with the autocorrelated noise of its residual
  ResidualTests tests_;                 // of current_
  std::vector<std::string> added_;      // effects, and the class of each
  std::vector<std::size_t> numbers_;    // of each
  std::vector<std::vector<std::string>> classes_;
  std::vector<ChannelFunction> functions_;  // of the base model's residual, once asked for
  std::vector<RoundFits> rounds_;           // in which an effect was added
  std::vector<FittedModel> models_;         // base model and refits with effects that make sense
};

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
  const Model::Applied applied = all_.apply(with_places(fit));
  PredictionOptions whole;
  whole.stop = options_.stop;
  std::vector<Prediction> curves(applied.series.size());
  base::parallel_for(curves.size(), [&](std::size_t k) {
    curves[k] = predict(applied.series[k], all_.solver(), applied.reading[k], whole);
  });
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
// variance that the
// model leaves, by F, all effects that could be seen counted.                              theory.md (I.9)
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
// effect. An effect counts
// only if it brings the stiffness back and leaves noise.                                  theory.md (I.9)
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

// The degree of the answer.                                                               theory.md (I.9)
void Tracer::conclude() {
  drop_unneeded();
  const double tolerance = result_.tolerance;
  // What may be more than the tolerance and has no name is not called missing unless it is more.
  const ResidualTests& base = result_.base_tests;
  const bool small = added_.empty() && !result_.few_readings && !base.of_published && tolerance > 0.0 &&
                     base.left.rmse <= tolerance;
  const bool base_does = small || base.acceptable(tolerance);
  // One series of another wire is simpler than several causes of all.
  const bool several = added_.size() != 1 || !tests_.acceptable(tolerance);
  std::optional<Finding> odd;
  if (!base_does && several && !base.of_published)
    odd = series_of_another_specimen(model_, data_, base_, progress_);
  result_.significant = !base_does || !added_.empty();
  Remaining& remaining = result_.remaining;
  const auto leave = [&](const Remainder& left, double share) {
    remaining = {left.rmse, left.upper, share, ""};
  };
  const Remainder& before = base.left;
  if (odd) {
    leave(before, 1.0);
    result_.kind = VerdictKind::not_explained;
    reject();
    result_.channel = remaining.channel = to_string(Channel::wire);
    result_.findings.push_back(*odd);
  } else if ((small || tests_.acceptable(tolerance)) && accept()) {
    leave(tests_.left, added_.empty() ? (before.rmse > 0.0 ? 1.0 : 0.0) : share_left(before, tests_.left));
    result_.kind = added_.empty() ? VerdictKind::nothing_missing : VerdictKind::explained;
    select();
  } else if (!added_.empty() && !result_.rival_explanation && !result_.serial_rival &&
             is_partial(before, tests_.left, result_.peak_force) && rivals().empty()) {
    leave(tests_.left, share_left(before, tests_.left));
    result_.kind = VerdictKind::partly_explained;
    if (options_.attribute && progress_.go_on("where the rest comes from")) {
      const std::vector<ChannelFunction> rest = attribute(model_, data_, current_);
      if (!rest.empty()) remaining.channel = to_string(rest.front().channel);
    }
    select();
  } else {
    leave(before, 1.0);
    result_.kind = result_.serial_rival ? VerdictKind::cannot_tell : VerdictKind::not_explained;
    reject();
    remaining.channel = result_.channel;
  }
  // A model whose stiffness no such wire has describes the readings and not the wire.
  const std::vector<Finding> beyond = beyond_construction(model_, numbers_of(model_, final_));
  const bool impossible = std::any_of(beyond.begin(), beyond.end(), [](const Finding& f) { return f.sure; });
  if (impossible && result_.kind != VerdictKind::not_explained) {
    result_.partial = added_;
    result_.selected.clear();
    result_.selected_classes.clear();
    result_.alternatives.clear();
    if (!added_.empty()) result_.partial_rmse = fitted_rmse(data_, current_.evaluation);
    final_ = base_;
    leave(before, 1.0);
    result_.kind = VerdictKind::not_explained;
  }
  result_.findings.insert(result_.findings.end(), beyond.begin(), beyond.end());
  find_findings();
  const bool hides =
      !base.of_published && remaining.upper > std::max(tolerance, most_hidden * result_.peak_force);
  if (result_.kind == VerdictKind::nothing_missing && (numbers_open() || hides))
    result_.kind = VerdictKind::cannot_tell;
  result_.explained = result_.kind == VerdictKind::nothing_missing || result_.kind == VerdictKind::explained;
}

// What is remarkable about the fitted numbers of the final model, and the units that they speak of.
void Tracer::find_findings() {
  std::vector<Finding> found = number_findings(model_, final_);
  const bool turned = has_finding(result_.findings, FindingKind::sign_turned);
  if (!turned && !result_.from_laws && progress_.go_on("units of the readings")) {
    for (Finding& f : unit_findings(model_, data_, final_)) found.push_back(std::move(f));
  }
  result_.findings.insert(result_.findings.end(), found.begin(), found.end());
  progress_.clock("signs and units of the readings");
}

// Whether the readings leave a number of the final model open.
bool Tracer::numbers_open() const {
  return has_finding(result_.findings, FindingKind::not_identifiable);
}

void Tracer::select() {
  final_ = current_;
  if (!added_.empty()) find_rank(model_, data_, final_);
  result_.selected = added_;
  result_.selected_classes = classes_;
  for (const ChannelFunction& f : result_.alternatives) {
    const std::string member = "outside:" + to_string(f.channel);
    std::vector<std::string>& first = result_.selected_classes.front();
    if (std::find(first.begin(), first.end(), member) == first.end()) first.push_back(member);
  }
  if (!added_.empty()) result_.channel = to_string(find_effect(added_.front())->channel);
}

// The effects do not do: the base model stays, and the channels are asked.
void Tracer::reject() {
  final_ = base_;
  if (!added_.empty()) {
    result_.partial = added_;
    result_.partial_rmse = fitted_rmse(data_, current_.evaluation);
  }
  const bool any = base_.dof() >= 1.0 && !result_.few_readings;
  if (any && options_.attribute && progress_.go_on("where the residual comes from"))
    result_.functions = functions();
  if (!result_.functions.empty() && !result_.one_condition)
    result_.channel = to_string(result_.functions.front().channel);
  progress_.clock("channels");
}

// One member in every class, and every effect lowers the error of conditions left out: theory.md (I.9).
bool Tracer::decided() const {
  // These readings cannot say whether autocorrelated noise or a small error of the model is the reason.
  if (!result_.explained || result_.serial) return false;
  Evidence evidence{.dof = final_.dof(),
                    .classes = result_.selected_classes,
                    .cause_outside = !result_.alternatives.empty(),
                    .one_condition = result_.one_condition && !result_.selected.empty(),
                    .zero_in_doubt = result_.zero && result_.zero->doubtful,
                    .something_left = !tests_.agrees(result_.tolerance),
                    .numbers_open = numbers_open()};
  evidence.readings_in_doubt = has_finding(result_.findings, FindingKind::sign_turned) ||
                               has_finding(result_.findings, FindingKind::unit_slip);
  if (result_.selected.empty()) {
    return is_decided(evidence) && !result_.few_readings &&
           result_.remaining.upper <= std::max(result_.tolerance, most_force_left * result_.peak_force);
  }
  if (result_.one_condition) return false;
  evidence.left_out.push_back(left_out_rmse(model_, data_, base_));
  for (const RoundFits& round : rounds_)
    evidence.left_out.push_back(left_out_rmse(model_, data_, round.better));
  return is_decided(evidence);
}

// Autocorrelated readings carry less information than independent ones: the final model is fitted again by
// generalised least squares,
// with Student's t of the effective number of readings.                                     theory.md (I.35)
void Tracer::widen_for_serial_noise() {
  final_data_ = data_;
  result_.serial = serial_noise(model_, data_, final_);
  if (!result_.serial || !progress_.go_on("autocorrelated noise")) return;
  final_data_.noise = with_serial_part(model_, data_.noise, *result_.serial);
  final_data_.noise.dof = std::max(1.0, result_.serial->effective - static_cast<double>(final_.free));
  Fit beside = fit(model_, final_data_, final_.fitted(), final_.fixed());
  if (!beside.report.usable()) {
    result_.serial.reset();
    final_data_ = data_;
    return;
  }
  final_ = std::move(beside);
  find_rank(model_, final_data_, final_);
  result_.noise = final_data_.noise;
  result_.noise.filter = {};  // of every reading
  progress_.clock("autocorrelated noise");
}

// Whether the base model with autocorrelated noise is as likely as the model with the effects that were
// added. A declared noise leaves no such choice.
bool Tracer::serial_noise_does() const {
  if (added_.empty() || data_.noise.source != "residual") return false;
  return serial_criterion(model_, data_, base_) <= serial_criterion(model_, data_, current_);
}

// Errors of the final model, on fitted series, held-out ones, and each of them left out.
void Tracer::compare_models() {
  result_.final_settings = final_.settings;
  result_.places = final_data_.places(model_, final_.evaluation, final_.covariance);
  if (result_.selected.empty() && !result_.serial && !only_fitted()) {
    result_.final_tests = result_.base_tests;
    result_.final = result_.base;
    result_.final_predictions = base_predictions_;
  } else {
    base_predictions_ = {};
    if (only_fitted() && data_.series.size() == 1)
      base_.evaluation = {};  // of many readings: there is nothing to leave out
    result_.final_tests = test_residuals(model_, final_data_, final_);
    result_.final = error_of(final_, result_.final_predictions);
  }
  if (only_fitted()) {
    result_.base = result_.final;
    result_.base_predictions = forces_only(result_.final_predictions);
  }
  for (const Prediction& p : result_.final_predictions) {
    for (const double e : p.curve.discretisation_error) result_.mesh_error = std::max(result_.mesh_error, e);
  }
  const std::optional<double> before = heldout_.rmse(base_.settings);
  const std::optional<double> after = heldout_.rmse(final_.settings);
  if (before && after) result_.heldout_rmse = {*before, *after};
  if (data_.series.size() > 1 && !result_.one_condition) {
    result_.left_out_rmse = {left_out_rmse(model_, data_, base_), left_out_rmse(model_, final_data_, final_)};
  }
  progress_.clock("errors of the final model");
}

// The hypotheses that were fitted, with unknown functions beside them.
void Tracer::weigh() {
  if (only_fitted() || result_.few_readings || !progress_.go_on("hypotheses")) return;
  models_.insert(models_.begin(), FittedModel{{}, base_});
  result_.hypotheses = weigh_hypotheses(model_, data_, models_);
  progress_.clock("hypotheses");
}

// Intervals of the base model's numbers that hold whichever effect is the right one, and whether one is
// missing.
void Tracer::average_intervals() {
  if (result_.kind == VerdictKind::not_explained || result_.serial) return;
  for (std::size_t k = 0; k < base_.free; ++k) {
    const FittedNumber& known = result_.final.numbers[k];
    if (!known.identified || known.bound != AtBound::none) continue;
    std::optional<Interval> interval;
    if (!result_.selected.empty()) {
      interval = interval_over_rivals(final_, k, rounds_, tests_.left.inflation());
    } else if (!result_.rounds.empty()) {
      interval = interval_over_candidates(final_, k, result_.rounds.front().candidates);
    }
    if (!interval) continue;
    const Parameter& p = *final_.settings[k].parameter;
    FittedNumber& n = result_.final.numbers[k];
    n.averaged = true;
    n.lower = interval->first >= model_.lower(p) ? std::optional(model_.shown({&p, interval->first}))
                                                 : std::nullopt;
    n.upper = interval->second <= model_.upper(p) ? std::optional(model_.shown({&p, interval->second}))
                                                  : std::nullopt;
  }
}

// Profile likelihood of the selected effects' numbers.
void Tracer::find_intervals() {
  const double reach = student_quantile(0.025, final_.noise_dof);
  const double rise = reach * reach;  // of chi2: 95 %
  for (std::size_t k = base_.free; k < final_.free; ++k) {
    const Parameter& p = *final_.settings[k].parameter;
    if (!final_.rank.is_known(k)) continue;
    if (!progress_.go_on("interval of " + p.key)) break;
    const ProfileInterval interval = profile_interval(model_, final_data_, final_, k, rise, [&](int, double) {
      return progress_.go_on("interval of " + p.key);
    });
    if (progress_.interrupted()) break;
    FittedNumber& n = result_.final.numbers[k];
    n.profiled = true;
    n.lower = interval.lower ? std::optional(model_.shown({&p, *interval.lower})) : std::nullopt;
    n.upper = interval.upper ? std::optional(model_.shown({&p, *interval.upper})) : std::nullopt;
  }
  progress_.clock("intervals");
}

// A measurement that separates the first effect that has a rival from it.
void Tracer::propose() {
  for (std::size_t k = 0; k < rounds_.size() && k < result_.selected.size(); ++k) {
    const RoundFits& r = rounds_[k];
    if (r.rivals.size() < 2) continue;
    result_.next =
        next_experiment(model_, r.rivals[0].settings, r.rivals[1].settings,
                        {r.rival_names[0], r.rival_names[1]}, data_.noise.mean_sigma(model_.series()));
    return;
  }
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

}  // namespace

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
