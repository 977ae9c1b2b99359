// The conclusions of a trace: degree of the answer, hypotheses, intervals, next experiment.

#include "identification/effects/catalogue.hpp"
#include "identification/fitting/statistics.hpp"
#include "identification/tracing/model_average.hpp"
#include "identification/tracing/odd_series.hpp"
#include "identification/tracing/outside_causes.hpp"
#include "identification/tracing/reading_findings.hpp"
#include "identification/tracing/tracer.hpp"

#include <algorithm>
#include <utility>

namespace snare::identification {

// The degree of the answer.                                                               theory.md (I.9)
void Tracer::conclude() {
  drop_unneeded();
  const double tolerance = result_.tolerance;
  // What may be more than the tolerance and has no name is not called missing unless it is more.
  const ResidualTests& base = result_.base_tests;
  const bool small = added_.empty() && !result_.few_readings && !base.of_published && tolerance > 0.0 &&
                     base.left.rmse <= tolerance;
  const bool base_does = small || base.acceptable(tolerance);
  // Two exchanged files, or one series of another wire, are simpler than several causes of all.
  const bool several = added_.size() != 1 || !tests_.acceptable(tolerance);
  std::optional<Finding> odd;
  if (!base_does && several && !base.of_published) {
    odd = series_exchanged(model_, data_, base_, progress_);
    if (!odd) odd = series_of_another_specimen(model_, data_, base_, progress_);
  }
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
    if (odd->kind == FindingKind::series_of_another_specimen)
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
// generalised least squares, with Student's t of the effective number of readings.           theory.md (I.35)
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

}  // namespace snare::identification
