#include "results/trace_json.hpp"

#include "identification/effects/catalogue.hpp"
#include "results/finding_json.hpp"
#include "results/finite_json.hpp"
#include "results/in_mm.hpp"
#include "results/trace_findings.hpp"
#include "results/version.hpp"
#include "results/warnings.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

namespace snare::results {

namespace {

using identification::Candidate;
using identification::FittedNumber;
using identification::ModelError;
using identification::Round;
using identification::Trace;
using nlohmann::json;

/// Correlations of the fitted numbers by their keys; those without a standard error have none.
json correlation_json(const std::vector<FittedNumber>& numbers) {
  json result = json::object();
  for (const FittedNumber& n : numbers)
    for (std::size_t k = 0; k < n.correlation.size() && k < numbers.size(); ++k)
      if (numbers[k].key != n.key && numbers[k].standard_error)
        result[n.key][numbers[k].key] = n.correlation[k];
  return result;
}

/// Null directions: which numbers go together, and the others with the first one held.
json open_json(const std::vector<identification::OpenDirection>& open) {
  json result = json::array();
  for (const identification::OpenDirection& direction : open) {
    json changes = json::object();
    for (const identification::NamedChange& c : direction.changes) changes[c.key] = finite(c.change);
    result.push_back({{"what", identification::null_words(direction.changes)},
                      {"changes", changes},
                      {"held", {{"key", direction.changes.front().key}, {"value", finite(direction.held)}}},
                      {"known", numbers_json(direction.known)}});
  }
  return result;
}

json error_json(const Trace& trace, const ModelError& error) {
  json series = json::object();
  for (std::size_t k = 0; k < error.series_rmse.size(); ++k)
    series[trace.series[k].name] = finite(error.series_rmse[k]);
  return {{"rmse_N", finite(error.rmse)},
          {"nrmse", finite(error.nrmse)},
          {"chi2_dof", finite(error.chi2_dof)},
          {"series_rmse_N", series},
          {"parameters", numbers_json(error.numbers)},
          {"correlation", correlation_json(error.numbers)},
          {"indistinguishable", open_json(error.open)}};
}

json tests_json(const identification::ResidualTests& tests) {
  return {{"runs_p", tests.runs}, {"ljung_box_p", tests.ljung_box}, {"lack_of_fit_p", tests.lack_of_fit}};
}

json zero_json(const std::optional<identification::ZeroCheck>& zero) {
  if (!zero) return nullptr;
  return {{"offset_mm", finite(zero->offset)},
          {"interval95_mm", {finite(zero->lower), finite(zero->upper)}},
          {"p", zero->p},
          {"key", zero->key.empty() ? json() : json(zero->key)},
          {"unit", zero->unit},
          {"without", finite(zero->without)},
          {"with", finite(zero->with)},
          {"doubtful", zero->doubtful}};
}

json candidate_json(const Candidate& c) {
  json values = json::object();
  json intervals = json::object();
  for (const FittedNumber& n : c.numbers) {
    values[n.key] = finite(n.value);
    intervals[n.key] = {finite(n.lower), finite(n.upper)};
  }
  const identification::Effect& effect = *c.score.effect;
  return {
      {"effect", effect.name},
      {"channel", to_string(effect.channel)},
      {"meaning", effect.meaning},
      {"observable", c.score.unobservable.empty()},
      {"why_unobservable", c.score.unobservable.empty() ? json() : json(c.score.unobservable)},
      {"score_z", finite(c.score.z)},
      {"score_p", finite(c.score.p)},
      {"score_p_holm", finite(c.score.adjusted_p)},
      {"refitted", c.refitted},
      {"rmse_N", c.refitted ? finite(c.rmse) : json()},
      {"delta_bic", c.refitted ? finite(c.delta_bic) : json()},
      {"value", values},
      {"interval95", intervals},
      {"plausible", c.plausible},
      {"why_implausible", c.why_implausible.empty() ? json() : json(c.why_implausible)},
      {"why_not_named", c.why_too_small.empty() ? json() : json(c.why_too_small)},
      {"heldout_improves", c.heldout_improves ? json(*c.heldout_improves) : json()},
      {"detectable", {{"key", effect.numbers.front().parameter.key}, {"size", finite(c.score.detectable)}}},
      {"class", c.class_index}};
}

/// By the names of the fitted series.
json curves_json(const Trace& trace, const Round& round) {
  json result = json::array();
  for (const identification::RefitCurves& curves : round.curves) {
    json force = json::object();
    std::size_t at = 0;
    for (std::size_t k = 0; k < trace.series.size(); ++k) {
      if (!trace.heldout[k] && at < curves.force.size()) force[trace.series[k].name] = curves.force[at++];
    }
    result.push_back({{"effect", curves.effect}, {"force_N", force}});
  }
  return result;
}

json round_json(const Trace& trace, const Round& round) {
  json candidates = json::array();
  for (const Candidate& c : round.candidates) candidates.push_back(candidate_json(c));
  return {{"candidates", candidates},
          {"classes", round.classes},
          {"added", round.added.empty() ? json() : json(round.added)},
          {"reason", round.reason},
          {"curves", curves_json(trace, round)}};
}

json function_json(const identification::ChannelFunction& f) {
  return {{"channel", to_string(f.channel)},
          {"argument", f.argument},
          {"effect", f.effect},
          {"at", f.at},
          {"value", f.value},
          {"deviation", f.deviation},
          {"carried_over", finite(f.carried_over)},
          {"explained", finite(f.explained)},
          {"chi2_dof", finite(f.chi2_dof)},
          {"accepted", f.accepted},
          {"shape", f.shape}};
}

json series_json(const Trace& trace, std::size_t k) {
  const identification::Series& s = trace.series[k];
  json result{{"name", s.name},
              {"contact_position_mm", in_mm(s.test.contact_position)},
              {"span_mm", in_mm(s.test.mount.span)},
              {"heldout", static_cast<bool>(trace.heldout[k])},
              {"displacement_mm", in_mm(s.readings->displacement)},
              {"measured_N", s.readings->force},
              {"time_s", s.readings->time},
              {"drawn", s.law.has_value()}};
  const auto model = [&](const char* name, const std::vector<identification::Prediction>& predictions) {
    result[name] = predictions.size() > k ? predictions[k].force : std::vector<double>();
  };
  model("declared_N", trace.declared_predictions);
  model("base_N", trace.base_predictions);
  model("final_N", trace.final_predictions);
  if (s.law) {
    const auto rms = [&](const std::vector<identification::Prediction>& predictions) {
      return finite(law_distance(trace, k, predictions));
    };
    result["law"] = {{"A_N_m2", s.law->a},
                     {"B_N_m", s.law->b},
                     {"C_N", s.law->c},
                     {"R2", s.law->r_squared},
                     {"scatter_N", s.law->scatter()},
                     {"declared_rmse_N", rms(trace.declared_predictions)},
                     {"base_rmse_N", rms(trace.base_predictions)},
                     {"final_rmse_N", rms(trace.final_predictions)}};
  }
  return result;
}

json remaining_json(const Trace& trace) {
  return {{"rmse_N", finite(trace.remaining.rmse)},
          {"upper95_N", finite(trace.remaining.upper)},
          {"share_of_peak_force",
           trace.peak_force > 0.0 ? finite(trace.remaining.upper / trace.peak_force) : json()},
          {"share_of_excess", finite(trace.remaining.share_of_excess)},
          {"channel", trace.remaining.channel.empty() ? json() : json(trace.remaining.channel)}};
}

json places_json(const Trace& trace) {
  json result = json::array();
  for (const identification::PlaceEstimate& p : trace.places) {
    result.push_back({{"series", p.series},
                      {"sigma_mm", in_mm(p.sigma)},
                      {"shift_mm", in_mm(p.shift)},
                      {"stderr_mm", in_mm(p.standard_error)}});
  }
  return result;
}

json hypotheses_json(const Trace& trace) {
  json result = json::array();
  for (const identification::CauseHypothesis& h : trace.hypotheses) {
    result.push_back({{"effects", h.effects},
                      {"discrepancy", h.discrepancy.empty() ? json() : json(h.discrepancy)},
                      {"probability", h.probability}});
  }
  return result;
}

/// The unknown function that leads where nothing of the catalogue is named.
json outside_json(const Trace& trace) {
  const identification::OutsideCause cause = identification::outside_cause(trace.hypotheses);
  if (trace.kind != identification::VerdictKind::not_explained || cause.variable.empty()) return {};
  return {{"variable", cause.variable}, {"probability", cause.probability}};
}

}  // namespace

json numbers_json(const std::vector<FittedNumber>& numbers) {
  json result = json::object();
  for (const FittedNumber& n : numbers) {
    result[n.key] = {{"value", finite(n.value)},       {"stderr", finite(n.standard_error)},
                     {"declared", finite(n.declared)}, {"unit", n.unit},
                     {"lower95", finite(n.lower)},     {"upper95", finite(n.upper)},
                     {"profiled", n.profiled},         {"averaged", n.averaged},
                     {"identified", n.identified},     {"on_bound", bound_json(n.bound)}};
  }
  return result;
}

namespace {

/// All but the series with their readings.
json findings_document(const identification::Experiment& experiment, const Trace& trace) {
  const bool any = !trace.rounds.empty();
  json seconds = json::object();
  for (const auto& [what, time] : trace.seconds) seconds[what] = time;
  json functions = json::array();
  for (const identification::ChannelFunction& f : trace.functions) functions.push_back(function_json(f));
  json alternatives = json::array();
  for (const identification::ChannelFunction& f : trace.alternatives)
    alternatives.push_back(function_json(f));
  json rounds = json::array();
  for (const Round& round : trace.rounds) rounds.push_back(round_json(trace, round));
  json result{{"schema", "snare-trace/1"},
              {"title", experiment.title},
              {"source", experiment.source},
              {"version", version()},
              {"verdict", verdict(trace)},
              {"verdict_kind", to_string(trace.kind)},
              {"remaining", remaining_json(trace)},
              {"tolerance_N", finite(trace.tolerance)},
              {"published_fits", trace.from_laws},
              {"independent_numbers", trace.rows},
              {"few_readings", trace.few_readings},
              {"one_condition", trace.one_condition},
              {"findings", findings_json(trace.findings)},
              {"places", places_json(trace)},
              {"zero", zero_json(trace.zero)},
              {"interrupted", trace.interrupted},
              {"noise",
               {{"sigma_N", finite(reading_noise(trace))},
                {"dof", finite(trace.noise.dof)},
                {"source", trace.noise.source},
                {"smooth_share", trace.noise.smooth},
                {"correlation_length_mm", in_mm(trace.noise.length)},
                {"correlation_readings", trace.serial ? json(trace.serial->length) : json()},
                {"effective_readings", trace.serial ? json(trace.serial->effective) : json()},
                {"drawn_about_published_laws", false}}},
              {"declared", error_json(trace, trace.declared)},
              {"base", error_json(trace, trace.base)},
              {"residual",
               {{"significant", trace.significant},
                {"tests", tests_json(trace.base_tests)},
                {"tests_after", tests_json(trace.final_tests)}}},
              {"candidates", any ? round_json(trace, trace.rounds.front())["candidates"] : json::array()},
              {"classes", any ? json(trace.rounds.front().classes) : json::array()},
              {"rounds", rounds},
              {"selected", trace.selected},
              {"selected_classes", trace.selected_classes},
              {"partial",
               {{"effects", trace.partial},
                {"rival_explanation", trace.rival_explanation},
                {"rmse_N", trace.partial.empty() ? json() : finite(trace.partial_rmse)}}},
              {"final", error_json(trace, trace.final)},
              {"heldout",
               {{"rmse_base_N", trace.heldout_rmse ? finite(trace.heldout_rmse->first) : json()},
                {"rmse_final_N", trace.heldout_rmse ? finite(trace.heldout_rmse->second) : json()}}},
              {"left_out",
               {{"rmse_base_N", trace.left_out_rmse ? finite(trace.left_out_rmse->first) : json()},
                {"rmse_final_N", trace.left_out_rmse ? finite(trace.left_out_rmse->second) : json()}}},
              {"explained", trace.explained},
              {"decided", trace.decided},
              {"channel", trace.channel.empty() ? json() : json(trace.channel)},
              {"hypotheses", hypotheses_json(trace)},
              {"outside", outside_json(trace)},
              {"functions", functions},
              {"alternatives", alternatives},
              {"mesh_error_N", finite(trace.mesh_error)},
              {"seconds", seconds},
              {"series", json::array()}};
  if (trace.next) {
    result["next_experiment"] = {{"what", trace.next->what},
                                 {"separates", trace.next->separates},
                                 {"difference_N", finite(trace.next->difference)},
                                 {"difference_sigma", finite(trace.next->sigmas)}};
  } else {
    result["next_experiment"] = {{"what", ""}, {"separates", json::array()}};
  }
  return result;
}

}  // namespace

json trace_json(const identification::Experiment& experiment, const Trace& trace) {
  json result = findings_document(experiment, trace);
  for (std::size_t k = 0; k < trace.series.size(); ++k) result["series"].push_back(series_json(trace, k));
  return result;
}

json trace_document(const identification::Experiment& experiment, const Trace& trace) {
  json result = trace_json(experiment, trace);
  result["warnings"] = trace_warnings(experiment, trace);
  return result;
}

identification::TraceOptions fitting_options() {
  identification::TraceOptions options;
  options.most_effects = 0;
  options.intervals = true;
  options.attribute = false;
  return options;
}

json fit_json(const identification::Experiment& experiment, const Trace& trace) {
  json whole = findings_document(experiment, trace);
  whole["warnings"] = trace_warnings(experiment, trace);
  json result{{"schema", "snare-fit/1"}, {"interrupted", trace.interrupted}};
  for (const char* key : {"title", "source", "version", "places", "findings", "noise", "declared", "heldout",
                          "left_out", "mesh_error_N", "warnings"}) {
    result[key] = whole[key];
  }
  result["fit"] = whole["final"];
  result["residual"] = {{"acceptable", trace.base_tests.acceptable(trace.tolerance)},
                        {"tests", whole["residual"]["tests"]}};
  return result;
}

std::vector<CurveColumn> curve_columns(const Trace& trace) {
  std::vector<CurveColumn> columns{{"base_N", {}}, {"final_N", {}}};
  for (std::size_t k = 0; k < trace.series.size(); ++k) {
    columns[0].values.push_back(trace.base_predictions[k].force);
    columns[1].values.push_back(trace.final_predictions[k].force);
  }
  return columns;
}

}  // namespace snare::results
