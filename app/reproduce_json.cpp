#include "app/reproduce_json.hpp"

#include "app/commands.hpp"
#include "app/report/plot.hpp"
#include "results/in_mm.hpp"
#include "results/published_map.hpp"
#include "results/trace_findings.hpp"
#include "results/trace_json.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace snare::app {

using namespace results;

namespace {

using identification::Prediction;
using identification::Series;
using nlohmann::json;

json shape_json(const coupling::PushShape& shape, double offset, double pusher_radius) {
  return {{"displacement_mm", in_mm(shape.travel + offset)},
          {"x_mm", in_mm(shape.x)},
          {"y_mm", in_mm(shape.y)},
          {"arc_mm", in_mm(shape.arc)},
          {"tension_N", shape.tension},
          {"moment_Nm", shape.moment},
          {"pusher_x_mm", in_mm(shape.pusher_centre.x())},
          {"pusher_y_mm", in_mm(shape.pusher_centre.y())},
          {"pusher_radius_mm", in_mm(pusher_radius)}};
}

json curve_json(const Series& series, const Prediction& prediction) {
  const identification::Misfit misfit =
      identification::misfit(identification::measured_force(series), prediction.force);
  json shapes = json::array();
  for (const coupling::PushShape& shape : prediction.curve.curve.shapes) {
    shapes.push_back(shape_json(shape, prediction.reading.displacement_offset, series.test.pusher.radius));
  }
  json result{
      {"force_N", prediction.force},
      {"stiffness_N_mm", tangent_stiffness(identification::measured_displacement(series), prediction.force)},
      {"rmse_N", misfit.rmse},
      {"nrmse", misfit.nrmse},
      {"max_N", largest_force(prediction)},
      {"shapes", shapes}};
  const numerics::SolveReport& report = prediction.curve.curve.report;
  if (!report.usable()) result["stopped"] = report.message;
  return result;
}

json series_json(const Reproduction& reproduction, std::size_t k) {
  const Series& series = reproduction.experiment.series[k];
  const std::vector<double>& displacement = identification::measured_displacement(series);
  json result{{"name", series.name},
              {"contact_position_mm", in_mm(series.test.contact_position)},
              {"range_mm", in_mm(*std::max_element(displacement.begin(), displacement.end()))},
              {"displacement_mm", in_mm(displacement)},
              {"published_N", identification::measured_force(series)},
              {"published_stiffness_N_mm", published_stiffness(series)}};
  if (const auto sigma = published_scatter(series)) result["published"]["sigma_N"] = *sigma;
  if (series.law) {
    result["published"].update({{"A_N_m2", series.law->a},
                                {"B_N_m", series.law->b},
                                {"C_N", series.law->c},
                                {"R2", series.law->r_squared}});
  }
  for (const ReproducedModel& model : reproduction.models) {
    if (model.at(k) != nullptr) result["models"][model.name] = curve_json(series, *model.at(k));
  }
  return result;
}

json model_json(const identification::Experiment& experiment, const ReproducedModel& model) {
  json parameters = json::object();
  for (const auto& [key, n] : model.numbers) {
    parameters[key] = {{"value", n.value},
                       {"stderr", n.standard_error ? json(*n.standard_error) : json()},
                       {"unit", n.unit}};
  }
  const auto misfit = model.misfit(experiment);
  return {{"name", model.name},
          {"label", model.label},
          {"description", model.description},
          {"parameters", parameters},
          {"rmse_N", misfit ? json(misfit->rmse) : json()},
          {"nrmse", misfit ? json(misfit->nrmse) : json()},
          {"free", model.free}};
}

json comparison_json(const identification::FitComparison& c) {
  json result{{"chi2", c.chi2},
              {"R2_published", c.published_r2},
              {"R2_computed", c.computed_r2},
              {"scatter_N", c.scatter}};
  constexpr const char* names[] = {"A_N_m2", "B_N_m", "C_N"};
  for (std::size_t k = 0; k < 3; ++k) {
    result[names[k]] = {
        {"published", c.published[k]}, {"computed", c.computed[k]}, {"stderr", c.deviation[k]}};
  }
  return result;
}

/// How the published fits may have come about; the map of every range and number of readings stays in its
/// file.
void add_map(const Reproduction& reproduction, json& result) {
  result["published"] = nullptr;
  result["leading"] = nullptr;
  result["map"] = json::array();
  if (!reproduction.map) return;
  const PublishedVerdict verdict = published_verdict(*reproduction.map);
  result["published"] = {{"answer", to_string(verdict.answer)},
                         {"headline", verdict.headline},
                         {"coarse", reproduction.map->at("coarse")},
                         {"decimal_point", reproduction.map->at("decimal_point")}};
  for (json entry : reproduction.map->at("map")) {
    entry.erase("by_range_and_readings");
    if (entry["model"] == verdict.leading) result["leading"] = entry;
    result["map"].push_back(std::move(entry));
  }
  if (const auto& leader = reproduction.leader; leader && !result["leading"].is_null())
    result["leading"]["recomputed"] = {{"p", leader->p}, {"values", leader->values}};
}

json summary_json(const Reproduction& reproduction) {
  if (!reproduction.summary) return nullptr;
  const identification::SummaryStatistics& s = *reproduction.summary;
  json series = json::object();
  std::size_t at = 0;
  for (const Series& one : reproduction.experiment.series) {
    if (one.law && at < s.series.size()) series[one.name] = comparison_json(s.series[at++]);
  }
  json by_digits = json::array();
  for (const auto& [digits, one] : reproduction.by_digits) {
    by_digits.push_back({{"R2_digits", digits}, {"chi2", one.chi2}, {"dof", one.dof}, {"p", one.p}});
  }
  return {{"chi2", s.chi2},   {"chi2_coefficients", s.coefficients},
          {"dof", s.dof},     {"numbers", s.numbers},
          {"p", s.p},         {"scatter_N", s.scatter},
          {"series", series}, {"by_R2_digits", by_digits}};
}

}  // namespace

json reproduce_json(const Reproduction& reproduction) {
  const identification::Experiment& experiment = reproduction.experiment;
  const coupling::PushProblem& test = experiment.series.front().test;
  json result{{"schema", "snare-reproduce/1"},
              {"title", experiment.title},
              {"source", experiment.source},
              {"version", version()},
              {"interrupted", reproduction.interrupted},
              {"warnings", reproduction.warnings},
              {"assumptions", reproduction.assumptions},
              {"wire",
               {{"diameter_mm", in_mm(test.wire.diameter)},
                {"length_mm", in_mm(test.wire.length)},
                {"span_mm", in_mm(test.mount.span)},
                {"bending_stiffness_Nm2", test.wire.bending_stiffness()},
                {"axial_stiffness_N", test.wire.axial_stiffness()}}},
              {"summary_statistics", summary_json(reproduction)},
              {"trace", nullptr},
              {"models", json::array()},
              {"series", json::array()}};
  add_map(reproduction, result);
  if (reproduction.trace) {
    result["trace"] = trace_json(experiment, *reproduction.trace);
    result["trace"].erase("series");
  }
  for (const ReproducedModel& model : reproduction.models)
    result["models"].push_back(model_json(experiment, model));
  for (std::size_t k = 0; k < experiment.series.size(); ++k) {
    result["series"].push_back(series_json(reproduction, k));
  }
  return result;
}

}  // namespace snare::app
