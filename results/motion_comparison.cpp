#include "results/motion_comparison.hpp"

#include "base/errors.hpp"
#include "results/motion_summary.hpp"
#include "results/version.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace snare::results {

namespace {

using nlohmann::json;

/// The scenario with its wires in either model.
std::vector<scenario::NamedMotion> with_models(const scenario::NamedMotion& run) {
  std::vector<scenario::NamedMotion> runs;
  for (const auto& [model, quasi_static] : {std::pair{"full", false}, {"quasi_static", true}}) {
    scenario::NamedMotion one = run;
    one.name = one.model = model;
    for (coupling::MotionWire& wire : one.motion.wires) wire.rod.quasi_static = quasi_static;
    runs.push_back(std::move(one));
  }
  return runs;
}

/// A difference relative to a reference; none where there is nothing to relate to.
json relative(double value, double reference) {
  return reference != 0.0 ? json(value / reference - 1.0) : json();
}

/// Differences of an outcome from that of the full wire: relative ones of forces, impulses and tensions, those of times [s].
json differences(const json& outcome, const json& reference) {
  json result = json::object();
  for (const char* key : {"peak_force_N", "peak_tension_N"}) {
    for (const auto& [name, value] : reference[key].items()) {
      if (value.is_number() && outcome[key][name].is_number())
        result[key][name] = relative(outcome[key][name].get<double>(), value.get<double>());
    }
  }
  for (const char* key : {"first_touch_s", "tight_s"}) {
    for (const auto& [name, value] : reference[key].items()) {
      if (value.is_number() && outcome[key][name].is_number())
        result[key][name] = outcome[key][name].get<double>() - value.get<double>();
    }
  }
  for (const auto& [name, value] : reference["impulse_Ns"].items()) {
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

const scenario::WireMotions& composed_motions(const std::filesystem::path& file, const scenario::Scenario& asked) {
  const auto* motions = std::get_if<scenario::WireMotions>(&asked.content);
  if (motions == nullptr || !motions->composed)
    throw base::InputError(
        {file.string(), 0, "schema", asked.kind, "must be \"snare-scenario/2\": a scenario that lists what there is"});
  return *motions;
}

scenario::WireMotions with_every_model(const scenario::WireMotions& motions) {
  scenario::WireMotions with = motions;
  with.runs = with_models(motions.runs.front());
  return with;
}

json comparison_json(const scenario::Scenario& asked, const scenario::WireMotions& motions,
                     const std::vector<MotionRecord>& records) {
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
  return {{"schema", "snare-comparison/1"},
          {"version", version()},
          {"title", asked.title},
          {"kind", "motion"},
          {"interrupted", left_undone(motions.runs, records)},
          {"models", models}};
}

}  // namespace snare::results
