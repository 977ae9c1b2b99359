#include "app/report/trace_rounds.hpp"

#include "app/report/report_words.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

namespace snare::app {

namespace {

using identification::Candidate;
using identification::Effect;
using identification::FittedNumber;
using identification::Round;
using identification::Trace;

bool observable(const Candidate& candidate) {
  return candidate.score.unobservable.empty();
}

void add_scores(ReportPage& page, const Round& round) {
  Table table{"Does the residual have the shape that the effect would give it?",
              {"Effect"_code, "What would happen"_text, "Where"_text, "Score z"_number, "p (Holm)"_number,
               "Smallest size that would show"_number}};
  for (const Candidate& candidate : round.candidates) {
    if (!observable(candidate)) continue;
    const Effect& effect = *candidate.score.effect;
    const std::string unit = name_and_unit(effect.numbers.front().parameter.key).second;
    table.rows.push_back({{effect.name, effect.name == round.added ? Tone::good : Tone::plain},
                          effect.meaning,
                          to_string(effect.channel),
                          measured(candidate.score.z),
                          shown(candidate.score.adjusted_p, 2),
                          measured(candidate.score.detectable, " " + unit)});
  }
  if (!table.rows.empty()) page.table(table);
}

/// One row a number of the effect; what belongs to the effect stands in the first.
void add_refit(Table& table, const Candidate& candidate) {
  std::map<std::string, FittedNumber> numbers;
  for (const FittedNumber& n : candidate.numbers) numbers[n.key] = n;
  std::string effect = candidate.score.effect->name;
  std::string rmse = measured(candidate.rmse);
  std::string delta_bic = measured(candidate.delta_bic);
  Cell plausible = yes_no(candidate.plausible, Tone::plain, Tone::bad);
  Cell improves = yes_no(candidate.heldout_improves, Tone::plain, Tone::bad);
  const auto add = [&](const std::string& number, const std::vector<Cell>& value_and_interval) {
    table.rows.push_back(
        {effect, rmse, delta_bic, number, value_and_interval[0], value_and_interval[1], plausible, improves});
    effect = rmse = delta_bic = "";
    plausible = improves = "";
  };
  for (const auto& [key, n] : numbers) {
    const auto [name, unit] = name_and_unit(key);
    add(unit.empty() ? name : fmt::format("{} [{}]", name, unit), value_cells(n.value, n.lower, n.upper));
  }
  if (numbers.empty()) add(absent, {absent, absent});
}

void add_refits(ReportPage& page, const Round& round) {
  Table table{"The best of them, each added to the model and all numbers refitted.",
              {"Effect"_code, "Error [N rms]"_number, "Change of BIC"_number, "Its number"_text,
               "Value"_number, "95 % interval"_number, "Plausible"_text, "Held-out improves"_text}};
  for (const Candidate& candidate : round.candidates) {
    if (candidate.refitted) add_refit(table, candidate);
  }
  if (!table.rows.empty()) page.table(table);
}

void add_list(ReportPage& page, const char* introduction, const Words& items) {
  if (items.empty()) return;
  page.paragraph(introduction);
  page.list(items);
}

/// What was ruled out and what could not be judged; `told` of earlier rounds is not said again.
void add_reasons(ReportPage& page, const Round& round, Words& told) {
  Words implausible, small, unseen;
  for (const Candidate& candidate : round.candidates) {
    const Effect& effect = *candidate.score.effect;
    if (!candidate.why_implausible.empty()) {
      implausible.push_back(fmt::format("{}: {}", effect.name, candidate.why_implausible));
    }
    if (!candidate.why_too_small.empty())
      small.push_back(fmt::format("{}: {}", effect.name, candidate.why_too_small));
    if (observable(candidate)) continue;
    const std::string line =
        fmt::format("{} ({}): {}", effect.name, effect.meaning, candidate.score.unobservable);
    if (std::ranges::find(told, line) == told.end()) unseen.push_back(line);
  }
  add_list(page, "Not plausible, a value like this makes no physical sense:", implausible);
  add_list(page, "Too small to be named, or more than the readings bear:", small);
  add_list(page,
           told.empty() ? "These data cannot show, whether present or not:"
                        : "Beside those above these data cannot show:",
           unseen);
  told.insert(told.end(), unseen.begin(), unseen.end());
}

/// Members of a class that are no candidates of its round are in the model already.
void add_classes(ReportPage& page, const Round& round) {
  const auto is_candidate = [&](const std::string& name) {
    return std::ranges::any_of(round.candidates,
                               [&](const Candidate& c) { return c.score.effect->name == name; });
  };
  Words items;
  for (const Words& members : round.classes) {
    if (members.size() < 2) continue;
    Words fitted = members;
    std::erase_if(fitted, is_candidate);
    items.push_back(
        joined(members) +
        (fitted.empty() ? "" : fmt::format("; of these the model has {} already", joined(fitted))));
  }
  add_list(page, "These data cannot tell apart, since the curves change in the same way:", items);
}

/// What the winner leaves of each fitted series, and its rivals, over the travel.
void add_rivals(ReportPage& page, const Trace& trace, const Round& round) {
  if (round.curves.size() < 2) return;
  page.paragraph(
      "What the best refits leave, measured minus computed. One that could not come near the best was given "
      "up before "
      "its own best fit.");
  std::size_t at = 0;
  for (std::size_t k = 0; k < trace.series.size(); ++k) {
    if (trace.heldout[k]) continue;
    const identification::Series& series = trace.series[k];
    PlotSpecification plot{.title = fmt::format("Left of {} beside each effect", series.name),
                           .x = {"travel", "mm"},
                           .y = {"residual", "N"}};
    std::vector<double> travel;
    for (const double d : series.readings->displacement) travel.push_back(1e3 * d);
    int colour = blue;
    for (const identification::RefitCurves& curves : round.curves) {
      if (at >= curves.force.size() || curves.force[at].size() != travel.size()) continue;
      std::vector<double> left;
      for (std::size_t i = 0; i < travel.size(); ++i)
        left.push_back(series.readings->force[i] - curves.force[at][i]);
      plot.curves.push_back(make_curve(curves.effect, travel, left, CurveStyle::line, colour++));
    }
    page.line_plot(plot);
    ++at;
  }
}

}  // namespace

void add_rounds(ReportPage& page, const Trace& trace) {
  if (trace.rounds.empty()) return;
  page.heading("What could be missing");
  page.paragraph(
      "Every effect of the catalogue is asked in turn. Where: the part of the test in which it sits. Score "
      "z: by how "
      "many standard deviations its pattern stands out of the noise; 0 when the residual points the other "
      "way. p: how "
      "often noise alone would reach such a score, corrected by Holm's rule for asking so many effects at "
      "once. "
      "Smallest size: what these readings would reveal nine times in ten.");
  page.paragraph(
      "BIC, the Bayesian information criterion, is the misfit plus a price for every number fitted: an "
      "effect worth its price lowers it.");
  int count = 0;
  Words told;
  for (const Round& round : trace.rounds) {
    page.subheading(fmt::format("Round {}", ++count));
    page.paragraph((round.added.empty() ? "Nothing added" : "Added: " + round.added) +
                   (round.reason.empty() ? "" : "; " + round.reason) + ".");
    add_scores(page, round);
    add_refits(page, round);
    add_rivals(page, trace, round);
    add_reasons(page, round, told);
    add_classes(page, round);
  }
  if (trace.partial.empty()) return;
  page.paragraph(
      fmt::format("Taken out of the model again, for the reason in the verdict: {}. With them the error "
                  "would be {} N rms.",
                  joined(trace.partial), measured(trace.partial_rmse)));
}

}  // namespace snare::app
