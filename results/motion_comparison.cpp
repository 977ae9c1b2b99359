#include "results/motion_comparison.hpp"

#include "base/errors.hpp"
#include "results/motion_summary.hpp"
#include "results/version.hpp"
#include "scenario/scenario.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace snare::results {

namespace {

using nlohmann::json;

/// A difference relative to a reference; none where there is nothing to relate to.
json relative(double value, double reference) {
  return reference != 0.0 ? json(value / reference - 1.0) : json();
}

/// Differences of an outcome from that of the full wire: relative ones of forces, impulses and tensions,
/// those of times [s].
json differences(const json& outcome, const json& reference) {
  json result = json::object();
  for (const char* key : {"peak_force_N", "peak_tension_N"}) {
    for (const auto& [name, value] : reference[key].items()) {
      if (value.is_number() && outcome[key].contains(name) && outcome[key][name].is_number())
        result[key][name] = relative(outcome[key][name].get<double>(), value.get<double>());
    }
  }
  for (const char* key : {"first_touch_s", "tight_s"}) {
    for (const auto& [name, value] : reference[key].items()) {
      if (value.is_number() && outcome[key].contains(name) && outcome[key][name].is_number())
        result[key][name] = outcome[key][name].get<double>() - value.get<double>();
    }
  }
  for (const auto& [name, value] : reference["impulse_Ns"].items()) {
    if (!outcome["impulse_Ns"].contains(name)) continue;
    double apart = 0.0, size = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double whole = value[k].get<double>();
      apart += std::pow(outcome["impulse_Ns"][name][k].get<double>() - whole, 2);
      size += whole * whole;
    }
    if (size > 0.0) result["impulse_Ns"][name] = std::sqrt(apart / size);
  }
  result["same_outcome"] = outcome["caught"] == reference["caught"];
  return result;
}

}  // namespace

MotionComparison with_every_model(const std::filesystem::path& file,
                                  const std::vector<base::Override>& overrides,
                                  const scenario::WireMotions& motions) {
  if (motions.model_keys.empty())
    throw base::InputError(
        {file.string(), 0, "wires", "", "must have at least one, here or in [[snares]], to compare"});
  MotionComparison comparison{motions, {}};
  comparison.motions.runs.clear();
  std::vector<std::string> models{"full", "quasi_static", "stretched", "rod", "rod_linear"};
  models.insert(models.end(), motions.law_models.begin(), motions.law_models.end());
  for (const std::string& model : models) {
    std::vector<base::Override> with_model = overrides;
    for (const std::string& key : motions.model_keys)
      with_model.push_back({key, fmt::format("\"{}\"", model)});
    try {
      scenario::NamedMotion one = scenario::read_scenario(file, with_model).motions.runs.front();
      one.name = one.model = model;
      comparison.motions.runs.push_back(std::move(one));
    } catch (const base::InputError& error) {
      comparison.left_out.emplace_back(model, error.problems().front().message());
    }
  }
  if (comparison.motions.runs.empty())
    throw base::InputError(
        {file.string(), 0, "wires", "", "no model fits: " + comparison.left_out.front().second});
  return comparison;
}

json comparison_json(const scenario::Scenario& asked, const MotionComparison& comparison,
                     const std::vector<MotionRecord>& records) {
  const scenario::WireMotions& motions = comparison.motions;
  json models = json::array();
  std::optional<json> reference;
  for (const FinishedMotion& run : finished_motions(motions, records)) {
    const json outcome = outcome_json(motions, run);
    models.push_back({{"model", run.asked.model},
                      {"outcome", outcome},
                      {"finished", run.result.report.usable()},
                      {"cost",
                       {{"wall_s", run.result.wall_seconds},
                        {"steps", run.result.statistics.steps},
                        {"real_time_factor", real_time_factor(run.result)}}},
                      {"from_full", reference ? differences(outcome, *reference) : json()}});
    if (!reference) reference = outcome;
  }
  json left_out = json::array();
  for (const auto& [model, why] : comparison.left_out) left_out.push_back({{"model", model}, {"why", why}});
  return {{"schema", "snare-comparison/1"},
          {"version", version()},
          {"title", asked.title},
          {"kind", "motion"},
          {"interrupted", left_undone(motions.runs, records)},
          {"models", models},
          {"left_out", left_out}};
}

}  // namespace snare::results
