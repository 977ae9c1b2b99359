#include "app/traced_wire.hpp"

#include "base/one_line.hpp"
#include "coupling/statics/spatial_push.hpp"
#include "identification/fitting/model.hpp"
#include "results/in_mm.hpp"
#include "results/trace_findings.hpp"
#include "scenario/push_writer.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cassert>
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

/// The kind of the verdict in words: "not explained".
std::string kind_of(const Trace& trace) {
  std::string kind = identification::to_string(trace.kind);
  std::ranges::replace(kind, '_', ' ');
  return kind;
}

/// A fitted number on a line: "wire.length_mm = 175.6 +- 0.04 mm (declared: 180)".
std::string line_of(const FittedNumber& n) {
  std::string line = fmt::format("  {} = {:.6g}", n.key, n.value);
  line += n.standard_error ? fmt::format(" +- {:.2g}", *n.standard_error) : std::string(" (not determined)");
  if (!n.unit.empty() && n.unit != "1") line += " " + n.unit;
  if (std::isfinite(n.declared)) line += fmt::format(" (declared: {:.6g})", n.declared);
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

}  // namespace

std::string traced_wire_toml(const Reproduction& result, const std::string& command) {
  assert(result.trace && result.trace->report.usable());
  const Trace& trace = *result.trace;
  const Experiment& experiment = result.experiment;
  const Model::Applied applied = Model(experiment.series, experiment.solver).apply(trace.final_settings);
  const coupling::PushProblem& test = applied.series.front().test;
  const std::string kind = kind_of(trace);
  const bool accepted = trace.explained || trace.kind == identification::VerdictKind::partly_explained;

  std::string text = comment("The wire that the tracing of \"" + experiment.title +
                             "\" ends with, written by `" + command + "`: wire, mounts and pusher.");
  if (!experiment.file.empty()) text += comment("Declared in " + experiment.file.filename().string() + ".");
  text += comment("Verdict: " + kind + ". " + results::verdict(trace));
  if (trace.interrupted) text += comment("The tracing was interrupted: this is what it had found.");
  if (!accepted)
    text += comment(
        "No model was accepted: do not rely on these numbers. They are the best fit of the declared kind.");
  std::string effects;
  for (const std::string& effect : trace.selected) effects += (effects.empty() ? "" : ", ") + effect;
  if (!effects.empty()) text += comment("Effects that the tracing added: " + effects + ".");
  text += comment("Fitted, with standard errors; all else is as declared:");
  for (const FittedNumber& number : trace.final.numbers) text += comment(line_of(number));
  if (coupling::needs_space(test))
    text += comment("`snare distil` refuses this file: the push leaves the plane of the wire.");

  text += fmt::format("\nschema = \"snare-wire/1\"\ntitle = {}\nsource = {}\n\n",
                      quoted("traced wire of \"" + experiment.title + "\": " + kind +
                             (accepted ? "" : ", do not rely on it")),
                      quoted(command + ", on: " + experiment.source));
  return text + scenario::push_tables_text(test) + asked(applied);
}

}  // namespace snare::app
