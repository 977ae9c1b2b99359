#include "app/traced_wire.hpp"

#include "base/one_line.hpp"
#include "coupling/statics/spatial_push.hpp"
#include "identification/fitting/model.hpp"
#include "results/in_mm.hpp"
#include "results/published_map.hpp"
#include "results/trace_findings.hpp"
#include "scenario/push_writer.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace snare::app {

namespace {

using identification::Experiment;
using identification::FittedNumber;
using identification::Model;
using identification::Trace;

constexpr std::size_t most_laws = 32;  // law positions of a wire file

std::string comment(const std::string& text) {
  return "# " + base::one_line(text) + '\n';
}

/// A text as TOML quotes it; the escapes of JSON are escapes of TOML.
std::string quoted(const std::string& text) {
  return nlohmann::json(base::one_line(text)).dump();
}

/// A verdict in words: "not explained".
std::string with_spaces(std::string kind) {
  std::ranges::replace(kind, '_', ' ');
  return kind;
}

/// A fitted number on a line: "wire.length_mm = 175.6 +- 0.04 mm (declared: 180)". error: " +- 0.04".
std::string line_of(const std::string& key, double value, const std::string& error, const std::string& unit,
                    double declared) {
  std::string line = fmt::format("  {} = {:.6g}{}", key, value, error);
  if (!unit.empty() && unit != "1") line += " " + unit;
  if (std::isfinite(declared)) line += fmt::format(" (declared: {:.6g})", declared);
  return line;
}

/// Number as TOML has it: a point or an exponent, so that it is no integer.
std::string decimal(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string array(const std::vector<double>& metres) {
  std::string text;
  for (const double value : metres) text += (text.empty() ? "" : ", ") + decimal(results::in_mm(value));
  return "[" + text + "]";
}

/// `[ranges]` and `[laws]` as the tests were made.
std::string asked(const Model::Applied& applied) {
  double travel = 0.0;
  std::vector<double> positions, offsets;
  for (std::size_t k = 0; k < applied.series.size(); ++k) {
    const identification::Series& series = applied.series[k];
    const std::vector<double>& displacement = identification::measured_displacement(series);
    if (!displacement.empty()) travel = std::max(travel, *std::ranges::max_element(displacement));
    if (positions.size() == most_laws ||
        std::ranges::find(positions, series.test.contact_position) != positions.end())
      continue;
    positions.push_back(series.test.contact_position);
    offsets.push_back(applied.reading[k].displacement_offset);
  }
  std::string text;
  // the limits of the key
  const bool ranged = applied.series.front().test.pusher.direction == coupling::PushDirection::outward &&
                      travel >= 1e-9 && travel <= 1.0;
  if (ranged) text += fmt::format("\n[ranges]\ntravel_mm = {}\n", decimal(results::in_mm(travel)));
  text += fmt::format("\n[laws]\npositions_mm = {}\n", array(positions));
  const bool inside = std::ranges::all_of(offsets, [&](double x) { return x >= 0.0 && x < travel; });
  const bool any = std::ranges::any_of(offsets, [](double x) { return x != 0.0; });
  if (ranged && inside && any) text += fmt::format("displacement_offsets_mm = {}\n", array(offsets));
  return text;
}

/// A test with numbers fitted to it, and the comments of the file.
struct Bench {
  const Experiment& experiment;
  const std::vector<identification::Setting>& settings;
  std::string of;    ///< "the tracing", "the leading explanation"
  std::string kind;  ///< of the verdict, in words
  bool accepted = false;
  std::vector<std::string> remarks = {}, numbers = {};
};

/// The leading explanation of published fits, at its ranges and number of readings.
Bench leading_bench(const Reproduction& result) {
  const RefittedLeader& leader = *result.leader;
  const results::PublishedVerdict verdict = results::published_verdict(*result.map);
  const Model model(leader.experiment.series, leader.experiment.solver);
  Bench bench{leader.experiment, leader.settings, "the leading explanation",
              with_spaces(results::to_string(verdict.answer))};
  bench.accepted = verdict.answer == results::PublishedAnswer::explained ||
                   verdict.answer == results::PublishedAnswer::most_likely;
  bench.remarks = {
      verdict.headline,
      fmt::format("Here {}, one of these explanations, fitted to {} readings a series over the range "
                  "below, of which the paper gives neither (p = {:.2f} there).",
                  leader.meaning, leader.readings, leader.p)};
  for (const identification::Setting& s : leader.settings) {
    const identification::Parameter& p = *s.parameter;
    bench.numbers.push_back(line_of(p.key, model.shown(s), "", p.unit, p.shown(model.declared(p), 0.0)));
  }
  return bench;
}

/// The model that the tracing ends with.
Bench traced_bench(const Reproduction& result) {
  const Trace& trace = *result.trace;
  Bench bench{result.experiment, trace.final_settings, "the tracing",
              with_spaces(identification::to_string(trace.kind))};
  bench.accepted = trace.explained || trace.kind == identification::VerdictKind::partly_explained;
  bench.remarks = {"Verdict: " + bench.kind + ". " + results::verdict(trace)};
  if (trace.interrupted)
    bench.remarks.emplace_back("The tracing was interrupted: these are its last numbers.");
  std::string effects;
  for (const std::string& effect : trace.selected) effects += (effects.empty() ? "" : ", ") + effect;
  if (!effects.empty()) bench.remarks.push_back("Effects that the tracing added: " + effects + ".");
  for (const FittedNumber& n : trace.final.numbers)
    bench.numbers.push_back(line_of(
        n.key, n.value, n.standard_error ? fmt::format(" +- {:.2g}", *n.standard_error) : " (not determined)",
        n.unit, n.declared));
  return bench;
}

std::string text_of(const Bench& bench, const std::string& command) {
  const Experiment& experiment = bench.experiment;
  const Model::Applied applied = Model(experiment.series, experiment.solver).apply(bench.settings);
  const coupling::PushProblem& test = applied.series.front().test;
  std::string text = comment("Wire, mounts and pusher by " + bench.of + " of \"" + experiment.title +
                             "\", written by `" + command + "`.");
  if (!experiment.file.empty()) text += comment("Declared in " + experiment.file.filename().string() + ".");
  for (const std::string& remark : bench.remarks) text += comment(remark);
  if (!bench.accepted)
    text +=
        comment("No model was accepted: do not rely on these numbers. They are the nearest that were found.");
  text += comment("Fitted; all else is as declared:");
  for (const std::string& number : bench.numbers) text += comment(number);
  if (coupling::needs_space(test))
    text += comment("`snare distil` refuses this file: the push leaves the plane of the wire.");
  text += fmt::format("\nschema = \"snare-wire/1\"\ntitle = {}\nsource = {}\n\n",
                      quoted("traced wire of \"" + experiment.title + "\": " + bench.kind +
                             (bench.accepted ? "" : ", do not rely on it")),
                      quoted(command + ", on: " + experiment.source));
  return text + scenario::push_tables_text(test) + asked(applied);
}

}  // namespace

std::string traced_wire_toml(const Reproduction& result, const std::string& command) {
  if (result.leader) return text_of(leading_bench(result), command);
  if (result.trace && result.trace->report.usable()) return text_of(traced_bench(result), command);
  return {};
}

}  // namespace snare::app
