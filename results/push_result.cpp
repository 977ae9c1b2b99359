#include "results/push_result.hpp"

#include "identification/tracing/reading_findings.hpp"
#include "results/in_mm.hpp"
#include "results/warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace snare::results {

namespace {

nlohmann::json summary(const identification::Series& series, const identification::Prediction& prediction) {
  nlohmann::json events = nlohmann::json::array();
  for (const coupling::PushEvent& e : prediction.curve.curve.events) {
    events.push_back({{"event", coupling::to_string(e.kind)}, {"travel_mm", in_mm(e.travel)}});
  }
  const std::vector<double> readings = identification::measured_force(series);
  nlohmann::json misfit;  // of as many readings as were reached
  if (!readings.empty() && !prediction.force.empty()) {
    const identification::Misfit m = identification::misfit(readings, prediction.force);
    misfit = {{"rmse_N", m.rmse}, {"nrmse", m.nrmse}, {"largest_N", m.largest}};
  }
  double largest = 0.0;
  for (const double force : prediction.force) largest = std::max(largest, std::abs(force));
  return {{"series", series.name},
          {"points", prediction.force.size()},
          {"largest_force_N", largest},
          {"misfit", misfit},
          {"natural_height_mm", in_mm(prediction.curve.curve.natural_height)},
          {"events", events},
          {"in_contact_at_end",
           !prediction.curve.curve.points.empty() && prediction.curve.curve.points.back().in_contact},
          {"stopped", prediction.curve.curve.report.usable()
                          ? nlohmann::json()
                          : nlohmann::json(prediction.curve.curve.report.message)}};
}

}  // namespace

bool PushResult::complete() const {
  return std::ranges::all_of(
      predictions, [](const identification::Prediction& p) { return p.curve.curve.report.usable(); });
}

PushResult push(const identification::Experiment& experiment, const Watch& watch) {
  std::vector<identification::PredictionOptions> options(experiment.series.size());
  for (std::size_t k = 0; k < experiment.series.size(); ++k) {
    options[k].examine_out_of_plane = true;
    options[k].stop = watch.stop;
    options[k].progress = [&watch, &series = experiment.series[k]](double travel) {
      watch.say(fmt::format("{}: {:.3f} of {:.3f} mm", series.name, 1e3 * travel,
                            1e3 * identification::measured_displacement(series).back()));
      return !watch.stopped();
    };
  }
  PushResult result;
  result.predictions = identification::predict_all(experiment.series, experiment.solver, {}, options);
  bool interrupted = false;
  result.document = {
      {"schema", "snare-push/1"}, {"title", experiment.title}, {"series", nlohmann::json::array()}};
  for (std::size_t k = 0; k < result.predictions.size(); ++k) {
    result.document["series"].push_back(summary(experiment.series[k], result.predictions[k]));
    interrupted = interrupted ||
                  result.predictions[k].curve.curve.report.termination == numerics::Termination::interrupted;
  }
  result.document["interrupted"] = interrupted;
  std::vector<std::string> warnings = push_warnings(experiment.series, result.predictions);
  std::vector<std::vector<double>> forces;
  for (const identification::Prediction& p : result.predictions) forces.push_back(p.force);
  for (const identification::Finding& f :
       identification::sign_findings(experiment.series, forces, experiment.solver))
    warnings.push_back(f.what);
  result.document["warnings"] = warnings;
  return result;
}

}  // namespace snare::results
