#include "app/report/record_report.hpp"

#include "app/report/report_page.hpp"
#include "identification/records/amplitude_spectrum.hpp"
#include "results/version.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace snare::app {

using identification::ChannelError;
using identification::RecordSet;
using identification::RecordStage;
using identification::RecordTrace;
using identification::TracedNumber;
using identification::VerdictKind;

namespace {

std::string probability(double p) {
  return p < 1e-12 ? "< 1e-12" : format_number(p, 2);
}

void errors(ReportPage& page, const RecordTrace& trace) {
  Table table{"Error of the simulation",
              {"Records"_text, "Sensor"_code, "Unit"_text, "Declared"_number, "Base fit"_number,
               "Final"_number, "Final, of the readings"_number}};
  const auto rows = [&](const char* which, const std::vector<ChannelError>& declared,
                        const std::vector<ChannelError>& base, const std::vector<ChannelError>& last) {
    for (std::size_t k = 0; k < last.size(); ++k)
      table.rows.push_back(
          {std::string(which) + (last[k].fitted ? "" : ", watched"), last[k].sensor, last[k].unit,
           k < declared.size() ? format_significant(declared[k].rmse) : std::string(),
           k < base.size() ? format_significant(base[k].rmse) : std::string(),
           format_significant(last[k].rmse), fmt::format("{:.2f} %", 100.0 * last[k].relative)});
  };
  rows("fitted", trace.declared.errors, trace.base.errors, trace.final.errors);
  rows("held out", trace.declared.heldout, trace.base.heldout, trace.final.heldout);
  page.table(table);
}

void numbers(ReportPage& page, const RecordStage& stage) {
  Table table{"Numbers of the final model", {"Key"_code, "Value"_number, "95 %"_number, "Unit"_text}};
  for (const TracedNumber& n : stage.numbers)
    table.rows.push_back({n.key, format_number(n.value),
                          identification::interval_words(n.lower, n.upper, n.identified, n.bound), n.unit});
  page.table(table);
}

/// Limits, and the rise of the misfit along each number.
void profiles(ReportPage& page, const RecordTrace& trace) {
  Table table{"Intervals of 95 % by profile: the number is held, all others are fitted anew",
              {"Key"_code, "Value"_number, "From"_number, "To"_number, "Unit"_text}};
  const auto limit = [](const identification::ProfileSide& side) {
    if (side.end == identification::ProfileEnd::bound) return format_number(*side.limit) + " (its bound)";
    if (side.limit) return format_number(*side.limit);
    return std::string(side.end == identification::ProfileEnd::open ? "no limit"
                                                                    : "cannot be simulated beyond");
  };
  for (const identification::Profile& p : trace.profiles)
    table.rows.push_back({p.key, format_number(p.value), limit(p.lower), limit(p.upper), p.unit});
  page.table(table);
  for (const identification::Profile& p : trace.profiles) {
    Values value, rise, ends, limit_of_95;
    for (const identification::ProfilePoint& point : p.points) {
      value.push_back(point.value);
      rise.push_back(point.rise);
    }
    ends = {value.front(), value.back()};
    limit_of_95 = {identification::profile_rise_95, identification::profile_rise_95};
    PlotSpecification plot{"profile of " + p.key, {p.key, p.unit}, {"rise of the misfit, 3.84 at 95 %", ""}};
    plot.curves.push_back(make_curve("profile", value, rise, CurveStyle::line, 2));
    plot.curves.push_back(make_curve("95 %", ends, limit_of_95, CurveStyle::dashes, 1));
    page.line_plot(plot);
  }
}

void rounds(ReportPage& page, const RecordTrace& trace) {
  for (std::size_t k = 0; k < trace.rounds.size(); ++k) {
    const identification::RecordRound& round = trace.rounds[k];
    Table table{
        fmt::format("Round {}: {}{}", k + 1, round.added.empty() ? "none added" : round.added + " added",
                    round.reason.empty() ? "" : "; " + round.reason),
        {"Effect"_code, "Score"_number, "p (Holm)"_number, "Error after refit"_number, "Value"_number,
         "Would be seen from"_number, "Remark"_text}};
    for (const identification::RecordCandidate& c : round.candidates)
      table.rows.push_back({trace.effects[c.score.effect].label(),
                            c.score.unobservable.empty() ? format_number(c.score.z, 3) : std::string(),
                            c.score.unobservable.empty() ? probability(c.score.adjusted_p) : std::string(),
                            c.refitted ? format_significant(c.rmse) : std::string(),
                            c.numbers.empty() ? std::string() : format_number(c.numbers.front().value, 4),
                            c.score.detectable && std::isfinite(*c.score.detectable)
                                ? format_number(*c.score.detectable, 3)
                                : std::string(),
                            c.score.unobservable + c.why_not});
    page.table(table);
    for (const auto& members : round.classes)
      if (members.size() > 1)
        page.callout(fmt::format("These records cannot tell apart: {}", fmt::join(members, ", ")),
                     Tone::plain);
  }
}

Curve curve_of(const char* name, const Eigen::VectorXd& x, const Eigen::VectorXd& y, CurveStyle style,
               int colour) {
  return make_curve(name, Values(x.begin(), x.end()), Values(y.begin(), y.end()), style, colour);
}

void records(ReportPage& page, const RecordSet& set, const RecordTrace& trace) {
  for (std::size_t r = 0; r < set.records.size(); ++r) {
    const identification::Record& record = set.records[r];
    if (r >= trace.final.predictions.size() || trace.final.predictions[r].channels.empty()) continue;
    page.subheading(record.name + (record.heldout ? " (held out)" : ""));
    for (std::size_t c = 0; c < record.channels.size(); ++c) {
      const Eigen::VectorXd& measured = record.channels[c].values;
      std::string unit;
      for (const ChannelError& e : trace.final.errors)
        if (e.sensor == record.channels[c].sensor) unit = e.unit;
      PlotSpecification plot{record.channels[c].sensor, {"time", "s"}, {record.channels[c].sensor, unit}};
      PlotSpecification remainder{"measured less simulated", {"time", "s"}, {"difference", unit}};
      PlotSpecification over_value{"measured less simulated, over what is simulated",
                                   {record.channels[c].sensor, unit},
                                   {"difference", unit}};
      PlotSpecification spectrum{
          "measured less simulated, by frequency", {"frequency", "Hz"}, {"amplitude", unit}};
      plot.width = remainder.width = PlotWidth::full;
      plot.curves.push_back(curve_of("measured", record.times, measured, CurveStyle::points, 0));
      const auto add = [&](const char* name, const RecordStage& stage, CurveStyle style, int colour) {
        if (r >= stage.predictions.size() || stage.predictions[r].channels.empty()) return;
        const Eigen::VectorXd& y = stage.predictions[r].channels[c];
        plot.curves.push_back(curve_of(name, record.times, y, style, colour));
        const Eigen::VectorXd left = measured - y;
        remainder.curves.push_back(curve_of(name, record.times, left, style, colour));
        over_value.curves.push_back(curve_of(name, y, left, CurveStyle::points, colour));
        const identification::AmplitudeSpectrum s = identification::amplitude_spectrum(record.times, left);
        if (s.frequencies.size() > 0)
          spectrum.curves.push_back(curve_of(name, s.frequencies, s.amplitudes, style, colour));
      };
      add("declared", trace.declared, CurveStyle::dashes, 1);
      add("base fit", trace.base, CurveStyle::line, 2);
      if (!trace.selected.empty()) add("traced", trace.final, CurveStyle::line, 3);
      if (trace.with_partial) add("with what helps", *trace.with_partial, CurveStyle::line, 3);
      page.line_plot(plot);
      page.line_plot(remainder);
      page.line_plot(over_value);
      if (!spectrum.curves.empty()) page.line_plot(spectrum);
    }
  }
}

}  // namespace

std::string record_verdict(const RecordTrace& trace) {
  const std::string names = fmt::format("{}", fmt::join(trace.selected, ", "));
  switch (trace.kind) {
    case VerdictKind::nothing_missing:
      return "Nothing is missing: what the declared scenario leaves is noise, or too small to be worth a "
             "name.";
    case VerdictKind::explained:
      return fmt::format(
          "Explained: the scenario lacks {}; with it what is left is noise, or too small to be worth a name.",
          names);
    case VerdictKind::partly_explained:
      return fmt::format(
          "Partly explained: {} carry {:.1f} % of what the base model leaves beside the noise; the rest "
          "stays open.",
          names, 100.0 * (1.0 - trace.share_left));
    case VerdictKind::cannot_tell:
      return "Cannot tell: the scenario describes the records, but they do not determine its numbers: an "
             "effect that "
             "acts "
             "like one of these would not be seen. Hold one of the numbers that go together at a value that "
             "was "
             "measured "
             "otherwise.";
    case VerdictKind::not_explained:
      break;
  }
  if (trace.partial.empty())
    return "Not explained: no effect of the catalogue accounts for what the scenario leaves.";
  return fmt::format(
      "Not explained: {} would carry {:.1f} % of what the base model leaves beside the noise, but leave more "
      "than "
      "noise, so "
      "none of them is named: something else is missing.",
      fmt::join(trace.partial, ", "), 100.0 * (1.0 - trace.share_left));
}

std::string record_report_html(const RecordSet& set, const RecordTrace& trace) {
  ReportPage page(set.title, set.source);
  page.doubts(trace.warnings, trace.interrupted);
  page.heading("Verdict");
  const bool good = trace.kind == VerdictKind::nothing_missing || trace.kind == VerdictKind::explained;
  page.callout(record_verdict(trace), good ? Tone::good : Tone::plain);
  for (const std::size_t e : trace.selected_effects)
    page.paragraph(trace.effects[e].label() + ": " + trace.effects[e].meaning + ".");
  errors(page, trace);
  numbers(page, trace.final);
  if (!trace.profiles.empty()) profiles(page, trace);
  if (!trace.leftovers.empty() && trace.leftovers.front().share > 0.05) {
    page.heading("What is left");
    std::vector<std::string> items;
    for (const identification::Leftover& l : trace.leftovers)
      if (l.share > 0.05 && items.size() < 5)
        items.push_back(
            fmt::format("{:.0f} % of the residual of {} is a function of {} (found on one half of the time, "
                        "tried on the other)",
                        100.0 * l.share, l.sensor, l.on));
    page.list(items);
  }
  if (!trace.next_measurement.empty()) {
    page.heading("What to measure next");
    page.paragraph(trace.next_measurement + ".");
  }
  if (!trace.rounds.empty()) {
    page.heading("Effects");
    rounds(page, trace);
  }
  page.heading("Records");
  records(page, set, trace);
  page.footer(written_by(results::version(), "trace.json and curves.csv") + plot_help);
  return page.html();
}

}  // namespace snare::app
