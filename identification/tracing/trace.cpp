#include "identification/tracing/trace.hpp"

#include "identification/effects/catalogue.hpp"
#include "identification/tracing/base_fit.hpp"
#include "identification/tracing/outside_causes.hpp"
#include "identification/tracing/progress.hpp"
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

/// What is traced: the experiment with laws replaced by readings, divided into fitted and held-out series.
struct Division {
  explicit Division(const Experiment& experiment, const TraceOptions& options);

  bool drawn = false;
  std::vector<Series> all;
  std::vector<bool> is_heldout;  // one a series of `all`
  std::vector<Series> fitted, heldout;
};

Division::Division(const Experiment& experiment, const TraceOptions& options) : all(experiment.series) {
  drawn = replace_laws(all, options.draw, options.seed);
  const std::vector<std::string>& names = experiment.heldout;
  for (const Series& s : all) is_heldout.push_back(std::find(names.begin(), names.end(), s.name) != names.end());
  check_readings(experiment.file, all, is_heldout);
  for (std::size_t k = 0; k < all.size(); ++k) (is_heldout[k] ? heldout : fitted).push_back(all[k]);
}

Data data_of(const std::vector<Series>& fitted) {
  Data data;
  for (std::size_t k = 0; k < fitted.size(); ++k) {
    data.series.push_back(k);
    data.measured.push_back(forces_of(fitted[k]));
  }
  data.noise = known_noise(fitted);
  return data;
}

/// A trace under way.
class Tracer {
 public:
  Tracer(const Experiment& experiment, const TraceOptions& options, const Division& series);
  Trace run();

 private:
  void look_at_base();
  void tell_part() const;
  void add_effects();
  [[nodiscard]] bool accept();
  void select();
  void reject();
  void compare_models();
  void find_intervals();
  void propose();
  [[nodiscard]] ModelError error_of(const Fit& fit, std::vector<Prediction>& predictions) const;
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
  Fit current_;                     // with the effects added so far
  Fit final_;                       // what is selected
  ResidualTests tests_;             // of current_
  std::vector<std::string> added_;  // effects, and the class of each
  std::vector<std::vector<std::string>> classes_;
  std::vector<ChannelFunction> functions_;  // of the base model's residual, once asked for
  std::vector<RoundFits> rounds_;           // in which an effect was added
};

Tracer::Tracer(const Experiment& experiment, const TraceOptions& options, const Division& series)
    : experiment_(experiment),
      options_(options),
      progress_(options.progress),
      model_(series.fitted, for_search(experiment.solver)),
      heldout_(series.heldout, for_search(experiment.solver)),
      all_(series.all, experiment.solver, false),
      data_(data_of(series.fitted)) {
  result_.series = series.all;
  result_.drawn = series.drawn;
  result_.heldout = series.is_heldout;
}

ModelError Tracer::error_of(const Fit& fit, std::vector<Prediction>& predictions) const {
  predictions = all_.evaluate(fit.settings).predictions;
  return model_error(result_.series, result_.heldout, predictions, model_, fit);
}

const std::vector<ChannelFunction>& Tracer::functions() {
  if (functions_.empty()) functions_ = attribute(model_, data_, base_);
  return functions_;
}

std::vector<ChannelFunction> Tracer::rivals() {
  return rivals_outside(functions(), find_effect(added_.front())->channel, current_.chi2);
}

// The declared model as it is and the base model as fitted: errors and what is left.
void Tracer::look_at_base() {
  Fit declared;
  declared.evaluation = model_.evaluate({});
  if (declared.evaluation.complete) {
    declared.residual = data_.residual(declared.evaluation);
    declared.chi2 = declared.residual.squaredNorm();
    result_.declared = error_of(declared, result_.declared_predictions);
  }
  result_.base_tests = test_residuals(data_, base_);
  result_.base = error_of(base_, result_.base_predictions);
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
    part.final_predictions = part.base_predictions;
  }
  options_.reached(part);
}

// Effects one at a time, until what is left is no more than noise or no effect of the catalogue helps.
void Tracer::add_effects() {
  current_ = base_;
  tests_ = result_.base_tests;
  while (static_cast<int>(added_.size()) < options_.most_effects) {
    const std::size_t number = result_.rounds.size() + 1;
    if (!progress_.go_on(fmt::format("round {}: scores of {} effects", number, catalogue().size()))) break;
    const double significance = number == 1 ? options_.significance : options_.further_significance;
    RoundFits found = look_for_effect(model_, data_, heldout_, current_, number, significance, progress_);
    result_.rounds.push_back(std::move(found.round));
    const Round& round = result_.rounds.back();
    if (round.added.empty()) break;
    added_.push_back(round.added);
    classes_.push_back(round.classes[round.candidates.front().class_index]);
    current_ = std::move(found.better);
    rounds_.push_back(std::move(found));
    tests_ = test_residuals(data_, current_);
    // Where one cause that the catalogue does not have carries over, several effects would be rejected in the end.
    if (!tests_.acceptable() && options_.attribute && !rivals().empty()) break;
  }
  result_.significant = !result_.base_tests.acceptable() || !added_.empty();
}

// Whether the effects explain the residual: they leave no more than noise, and no cause that the catalogue
// does not have is the simpler one. What the catalogue explains such a cause may explain as well: theory.md (I.8).
bool Tracer::accept() {
  if (!tests_.acceptable()) return false;
  if (added_.empty() || !options_.attribute || !progress_.go_on("causes outside the catalogue")) return true;
  std::vector<ChannelFunction> outside = rivals();
  if (!outside.empty()) {
    result_.rival_explanation = simpler_outside(outside, model_, data_, current_, added_.size());
    if (!result_.rival_explanation) result_.alternatives = std::move(outside);
  }
  progress_.clock("causes outside the catalogue");
  return !result_.rival_explanation;
}

void Tracer::select() {
  final_ = current_;
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
  result_.partial = added_;
  if (!added_.empty()) result_.partial_rmse = fitted_rmse(data_, current_.evaluation);
  if (options_.attribute && progress_.go_on("where the residual comes from")) result_.functions = functions();
  if (!result_.functions.empty()) result_.channel = to_string(result_.functions.front().channel);
  progress_.clock("channels");
}

// Errors of the final model, on fitted series, held-out ones, and each of them left out.
void Tracer::compare_models() {
  result_.final_settings = final_.settings;
  if (result_.selected.empty()) {
    result_.final_tests = result_.base_tests;
    result_.final = result_.base;
    result_.final_predictions = result_.base_predictions;
  } else {
    result_.final_tests = test_residuals(data_, final_);
    result_.final = error_of(final_, result_.final_predictions);
  }
  for (const Prediction& p : result_.final_predictions) {
    for (const double e : p.curve.discretisation_error) result_.mesh_error = std::max(result_.mesh_error, e);
  }
  const std::optional<double> before = heldout_.rmse(base_.settings);
  const std::optional<double> after = heldout_.rmse(final_.settings);
  if (before && after) result_.heldout_rmse = {*before, *after};
  if (data_.series.size() > 1) {
    result_.left_out_rmse = {left_out_rmse(model_, data_, base_), left_out_rmse(model_, data_, final_)};
  }
  progress_.clock("errors of the final model");
}

// Profile likelihood of the selected effects' numbers.
void Tracer::find_intervals() {
  constexpr double rise = 3.84;  // of chi2: 95 %
  for (std::size_t k = base_.free; k < final_.free; ++k) {
    const Parameter& p = *final_.settings[k].parameter;
    if (!progress_.go_on("interval of " + p.key)) break;
    const ProfileInterval interval = profile_interval(model_, data_, final_, k, rise);
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
    result_.next = next_experiment(model_, r.rivals[0].settings, r.rivals[1].settings,
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
  result_.noise = data_.noise;
  progress_.clock("base fit");
  look_at_base();
  progress_.clock("errors of declared and base model");
  tell_part();
  add_effects();
  result_.explained = accept();
  if (result_.explained) {
    select();
  } else {
    reject();
  }
  compare_models();
  tell_part();
  if (options_.intervals && !result_.selected.empty()) find_intervals();
  if (progress_.go_on("next experiment")) propose();
  progress_.clock("next experiment");
  return finished();
}

}  // namespace

Trace trace(const Experiment& experiment, const TraceOptions& options) {
  return Tracer(experiment, options, Division(experiment, options)).run();
}

}  // namespace snare::identification
