#include "app/push_json.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace snare::app {

namespace {

nlohmann::json summary(const identification::Series& series, const identification::Prediction& prediction) {
  nlohmann::json events = nlohmann::json::array();
  for (const coupling::PushEvent& e : prediction.curve.curve.events) {
    events.push_back({{"event", coupling::to_string(e.kind)}, {"travel_mm", 1e3 * e.travel}});
  }
  double largest = 0.0;
  for (const double force : prediction.force) largest = std::max(largest, std::abs(force));
  return {
      {"series", series.name},
      {"points", prediction.force.size()},
      {"largest_force_N", largest},
      {"natural_height_mm", 1e3 * prediction.curve.curve.natural_height},
      {"events", events},
      {"in_contact_at_end", !prediction.curve.curve.points.empty() && prediction.curve.curve.points.back().in_contact},
      {"stopped", prediction.curve.curve.report.usable() ? nlohmann::json()
                                                         : nlohmann::json(prediction.curve.curve.report.message)}};
}

}  // namespace

nlohmann::json push_json(const identification::Experiment& experiment,
                         const std::vector<identification::Prediction>& predictions) {
  nlohmann::json result{{"schema", "snare-push/1"}, {"title", experiment.title}, {"series", nlohmann::json::array()}};
  bool partial = false;
  for (std::size_t k = 0; k < predictions.size(); ++k) {
    result["series"].push_back(summary(experiment.series[k], predictions[k]));
    partial = partial || predictions[k].curve.curve.report.termination == numerics::Termination::interrupted;
  }
  result["interrupted"] = partial;
  return result;
}

}  // namespace snare::app
