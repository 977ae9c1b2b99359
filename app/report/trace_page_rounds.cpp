#include "app/report/trace_page_rounds.hpp"

#include "app/report/trace_page_words.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace snare::app::trace_page {
namespace {

using base::json_fields::array;
using base::json_fields::number;
using base::json_fields::text;
using base::json_fields::texts;

bool observable(const json& candidate) {
  return flag(candidate, "observable").value_or(true);
}

void add_scores(ReportPage& page, const json& round) {
  Table table{"Does the residual have the shape that the effect would give it?",
              {{"Effect", ColumnKind::code},
               {"What would happen"},
               {"Where"},
               number_column("Score z"),
               number_column("p (Holm)"),
               number_column("Smallest size that would show")},
              {}};
  for (const json& candidate : objects(round, "candidates")) {
    if (!observable(candidate)) continue;
    const std::string effect = text(candidate, "effect", absent);
    const json& detectable = object(candidate, "detectable");
    table.rows.push_back(
        {{effect, effect == text(round, "added") ? Tone::good : Tone::plain},
         text(candidate, "meaning"),
         text(candidate, "channel", absent),
         measured(number(candidate, "score_z")),
         shown(number(candidate, "score_p_holm"), 2),
         measured(number(detectable, "size"), fmt::format(" {}", name_and_unit(text(detectable, "key")).second))});
  }
  if (!table.rows.empty()) page.table(table);
}

/// One row a number of the effect; what belongs to the effect stands in the first.
void add_refit(Table& table, const json& candidate) {
  const json& values = object(candidate, "value");
  const auto end = [&](const std::string& key, std::size_t i) {
    const json& interval = array(object(candidate, "interval95"), key);
    return i < interval.size() ? number({{key, interval[i]}}, key) : std::nullopt;
  };
  const std::size_t first = table.rows.size();
  for (const auto& item : values.items()) {
    const auto [name, unit] = name_and_unit(item.key());
    const auto cells = value_cells(number(values, item.key()), end(item.key(), 0), end(item.key(), 1));
    table.rows.push_back(
        {"", "", "", name + (unit.empty() ? "" : " [" + unit + "]"), cells[0], cells[1], "", ""});
  }
  if (table.rows.size() == first) table.rows.push_back({"", "", "", absent, absent, absent, "", ""});
  std::vector<Cell>& row = table.rows[first];
  row[0] = text(candidate, "effect", absent);
  row[1] = measured(number(candidate, "rmse_N"));
  row[2] = measured(number(candidate, "delta_bic"));
  row[6] = yes_no(flag(candidate, "plausible"), Tone::plain, Tone::bad);
  row[7] = yes_no(flag(candidate, "heldout_improves"), Tone::plain, Tone::bad);
}

void add_refits(ReportPage& page, const json& round) {
  Table table{"The best of them, each added to the model and all numbers refitted.",
              {{"Effect", ColumnKind::code},
               number_column("Error [N rms]"),
               number_column("Change of BIC"),
               {"Its number"},
               number_column("Value"),
               number_column("95 % interval"),
               {"Plausible"},
               {"Held-out improves"}},
              {}};
  for (const json& candidate : objects(round, "candidates")) {
    if (flag(candidate, "refitted").value_or(false)) add_refit(table, candidate);
  }
  if (!table.rows.empty()) page.table(table);
}

void add_list(ReportPage& page, const char* introduction, const Words& items) {
  if (items.empty()) return;
  page.paragraph(introduction);
  page.list(items);
}

/// What was ruled out and what could not be judged; `told` of earlier rounds is not said again.
void add_reasons(ReportPage& page, const json& round, Words& told) {
  Words implausible, unseen;
  for (const json& candidate : objects(round, "candidates")) {
    const std::string why = text(candidate, "why_implausible");
    if (!why.empty()) implausible.push_back(fmt::format("{}: {}", text(candidate, "effect"), why));
    if (observable(candidate)) continue;
    unseen.push_back(fmt::format("{} ({}): {}", text(candidate, "effect"), text(candidate, "meaning"),
                                 text(candidate, "why_unobservable", "no reason given")));
    if (std::ranges::find(told, unseen.back()) != told.end()) unseen.pop_back();
  }
  add_list(page, "Not plausible, a value like this makes no physical sense:", implausible);
  add_list(page,
           told.empty() ? "These data cannot show, whether present or not:"
                        : "Beside those above these data cannot show:",
           unseen);
  told.insert(told.end(), unseen.begin(), unseen.end());
}

/// Members of a class that are no candidates of its round are in the model already.
void add_classes(ReportPage& page, const json& round) {
  Words candidates;
  for (const json& candidate : objects(round, "candidates")) candidates.push_back(text(candidate, "effect"));
  Words items;
  for (const Words& members : text_lists(round, "classes")) {
    Words fitted = members;
    std::erase_if(fitted, [&](const std::string& name) {
      return std::ranges::find(candidates, name) != candidates.end();
    });
    if (members.size() > 1)
      items.push_back(
          joined(members) +
          (fitted.empty() ? "" : fmt::format("; of these the model has {} already", joined(fitted))));
  }
  add_list(page, "These data cannot tell apart, since the curves change in the same way:", items);
}

}  // namespace

void add_rounds(ReportPage& page, const json& result) {
  const json& rounds = objects(result, "rounds");
  if (rounds.empty()) return;
  page.heading("What could be missing");
  page.paragraph(
      "Every effect of the catalogue is asked in turn. Where: the part of the test in which it sits. Score "
      "z: by how many standard deviations its "
      "pattern stands out of the noise; 0 when the residual points the other way. p: how often noise alone "
      "would reach such a score, corrected by "
      "Holm's rule for asking so many effects at once. Smallest size: what these readings would reveal nine "
      "times in ten.");
  page.paragraph(
      "BIC, the Bayesian information criterion, is the misfit plus a price for every number fitted: an "
      "effect worth its price lowers it.");
  int count = 0;
  Words told;
  for (const json& round : rounds) {
    page.subheading(fmt::format("Round {}", ++count));
    const std::string added = text(round, "added");
    const std::string reason = text(round, "reason");
    page.paragraph((added.empty() ? "Nothing added" : "Added: " + added) +
                   (reason.empty() ? "" : "; " + reason) + ".");
    add_scores(page, round);
    add_refits(page, round);
    add_reasons(page, round, told);
    add_classes(page, round);
  }
  const json& partial = object(result, "partial");
  const Words taken_out = texts(partial, "effects");
  if (taken_out.empty()) return;
  page.paragraph(
      fmt::format("Taken out of the model again, for the reason in the verdict: {}. With them the error "
                  "would be {} N rms.",
                  joined(taken_out), measured(number(partial, "rmse_N"))));
}

}  // namespace snare::app::trace_page
