#include "results/static_comparison.hpp"

#include "base/files.hpp"
#include "identification/effects/catalogue.hpp"
#include "identification/fitting/experiment.hpp"
#include "identification/fitting/prediction.hpp"
#include "results/in_mm.hpp"
#include "results/version.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>

namespace snare::results {

namespace {

using reduction::CaseComparison;
using reduction::StaticCase;

using Overrides = std::vector<base::Override>;

/// Every series of an experiment with its readings or its published law.
StaticComparison from_experiment(const std::filesystem::path& file, const Overrides& overrides) {
  const identification::Experiment experiment =
      identification::read_experiment(file, identification::parameters(), overrides);
  StaticComparison result;
  result.title = experiment.title;
  result.settings.elements = experiment.solver.elements;
  result.settings.extrapolate = experiment.solver.extrapolate;
  for (const identification::Series& series : experiment.series) {
    StaticCase one;
    one.name = series.name;
    one.wire.test = series.test;
    one.travel = identification::measured_displacement(series);
    one.measured = identification::measured_force(series);
    one.wire.travel = {0.0, *std::max_element(one.travel.begin(), one.travel.end())};
    one.wire.position = {series.test.contact_position, series.test.contact_position};
    one.wire.slack = {one.wire.nominal_slack(), one.wire.nominal_slack()};
    one.wire.law_positions = {series.test.contact_position};
    if (series.law) {
      const identification::QuadraticLaw law = *series.law;
      one.given.push_back(
          {"published_quadratic", 3, {0.0, law.to}, [law](double d) { return law.force(d); }});
    }
    result.cases.push_back(std::move(one));
  }
  return result;
}

/// The positions of a wire file at its nominal slack; nothing is measured.
StaticComparison from_wire(const std::filesystem::path& file, const Overrides& overrides) {
  constexpr int points = 61;
  const reduction::WireFile wire = reduction::read_wire_file(file, overrides);
  StaticComparison result;
  result.title = wire.title;
  result.settings = wire.settings;
  for (std::size_t c = 0; c < wire.cases.size(); ++c) {
    for (const double position : wire.cases[c].law_positions) {
      StaticCase one;
      one.name = fmt::format("{}s{:.6g}", wire.cases.size() > 1 ? fmt::format("case{}_", c + 1) : "",
                             1e3 * position);
      one.wire = wire.cases[c];
      one.wire.law_positions = {position};
      for (int i = 0; i < points; ++i) one.travel.push_back(one.wire.travel.high * i / (points - 1));
      if (one.wire.dissipates())
        one.travel.insert(one.travel.end(), one.travel.rbegin() + 1, one.travel.rend());
      result.cases.push_back(std::move(one));
    }
  }
  return result;
}

/// Kinds of files of static pushes that can be compared, by their schema.
struct Kind {
  const char* schema;
  StaticComparison (*read)(const std::filesystem::path&, const Overrides&);
};
constexpr std::array<Kind, 2> kinds{{{"snare-experiment/1", from_experiment}, {"snare-wire/1", from_wire}}};

nlohmann::json case_json(const CaseComparison& one) {
  nlohmann::json models = nlohmann::json::array();
  for (const reduction::ModelResult& m : one.models) {
    models.push_back(
        {{"model", m.model},
         {"parameters", m.parameters},
         {"valid_travel_mm", {in_mm(m.range.low), in_mm(m.range.high)}},
         {"error_full_wire",
          {{"largest_N", m.largest_error},
           {"rms_N", m.rms_error},
           {"share", one.force_range > 0.0 ? m.largest_error / one.force_range : 0.0},
           {"why", m.why}}},
         {"error_measured", m.measured_rms ? nlohmann::json{{"rms_N", *m.measured_rms}} : nlohmann::json()},
         {"seconds_per_evaluation", m.seconds},
         {"force_N", m.force}});
  }
  return {{"case", one.name},
          {"displacement_mm", in_mm(one.travel)},
          {"measured_N", one.measured.empty() ? nlohmann::json() : nlohmann::json(one.measured)},
          {"force_range_N", one.force_range},
          {"models", models},
          {"stopped", one.report.usable() ? nlohmann::json() : nlohmann::json(one.report.message)}};
}

}  // namespace

StaticComparison read_static_comparison(const std::filesystem::path& file, const Overrides& overrides) {
  const base::TomlNode root = base::parse_toml(file.string(), base::read_text(file));
  const base::TomlNode* schema = root.find("schema");
  std::string allowed;
  for (const Kind& kind : kinds) {
    if (schema != nullptr && schema->text == kind.schema) return kind.read(file, overrides);
    allowed += fmt::format("{}\"{}\"", allowed.empty() ? "" : " or ", kind.schema);
  }
  throw base::InputError(base::InputProblem{
      file.string(), schema != nullptr ? schema->line : 0, "schema", schema != nullptr ? schema->written : "",
      (schema != nullptr ? "must be " : "missing, must be ") + allowed});
}

nlohmann::json comparison_json(const StaticComparison& comparison,
                               const std::vector<CaseComparison>& results) {
  const bool partial = results.size() < comparison.cases.size();
  nlohmann::json document{
      {"schema", "snare-comparison/1"}, {"version", version()}, {"interrupted", partial},
      {"title", comparison.title},      {"kind", "static"},     {"cases", nlohmann::json::array()}};
  for (const CaseComparison& one : results) document["cases"].push_back(case_json(one));
  return document;
}

}  // namespace snare::results
