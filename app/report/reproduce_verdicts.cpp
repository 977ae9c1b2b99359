#include "app/report/reproduce_verdicts.hpp"

#include "app/report/report_words.hpp"
#include "results/trace_findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace snare::app {

using namespace results;

namespace {

/// For every range and number of fitted numbers the best set of them, with the readings assumed across.
void add_adequacy(ReportPage& page, const Reproduction& result) {
  if (result.adequacy.empty()) return;
  page.paragraph(
      "How many numbers does one wire for all positions need? p: how often lost readings of this wire give published "
      "numbers as unlikely as these, by a bootstrap; below 0.01 the wire is rejected. Neither the range nor the number "
      "of readings is printed, so both are varied; of all sets of as many numbers the best one is shown.");
  std::map<std::pair<double, std::size_t>, std::map<int, const Adequacy*>> rows;
  std::map<int, bool> counts;
  for (const Adequacy& a : result.adequacy) {
    const Adequacy*& best = rows[{a.to, a.numbers.size()}][a.readings];
    if (best == nullptr || a.chi2 < best->chi2) best = &a;
    counts[a.readings] = true;
  }
  Table table;
  table.columns = {"range [mm]"_number, "numbers"_number};
  for (const auto& [readings, known] : counts) {
    table.columns.push_back({fmt::format("deviance, {} readings", readings), ColumnKind::number});
    table.columns.push_back({"p", ColumnKind::number});
  }
  for (const auto& [key, by_readings] : rows) {
    std::vector<Cell> row{format_number(1e3 * key.first), fmt::format("{}", key.second)};
    for (const auto& [readings, known] : counts) {
      const auto at = by_readings.find(readings);
      const bool has = at != by_readings.end();
      row.emplace_back(has ? shown(at->second->chi2, 3) : absent);
      row.emplace_back(has ? shown(at->second->p, 2) : absent, has && at->second->p > 0.01 ? Tone::good : Tone::plain);
    }
    table.rows.push_back(std::move(row));
  }
  page.table(table);
}

/// How the rounding of R2 moves the answer.
void add_digits(ReportPage& page, const Reproduction& result) {
  Words words;
  for (const auto& [digits, s] : result.by_digits) words.push_back(fmt::format("{:.2g} with {} decimals", s.p, digits));
  if (words.empty()) return;
  page.paragraph(
      fmt::format("R\u00b2 is printed rounded, which leaves an interval for the scatter of the readings: p of the "
                  "best fit is {}.",
                  joined(words)));
}

}  // namespace

void add_verdicts(ReportPage& page, const Reproduction& result) {
  if (!result.trace && result.verdicts.empty()) return;
  page.heading("What explains the curves");
  if (result.trace) {
    page.paragraph(
        "The readings are lost: the published numbers of every fit are compared with those of the same fit to the "
        "computed curve, by their likelihood. Run `snare trace` on the experiment file for the whole evidence.");
    add_digits(page, result);
    const auto& next = result.trace->next;
    if (next && !next->what.empty()) page.paragraph("To measure next: " + next->what + ".");
  }
  if (result.verdicts.empty()) return;
  page.paragraph("The range of travel of the published fits is not printed. What is said depends on it:");
  Table table;
  table.caption =
      "Distance: of the fitted wire from the published parabolas, as rms over their scatter. It is no test of the "
      "wire, whose curve need not be a parabola.";
  table.columns = {"range [mm]"_number, "distance by position"_text, "the tracing says"_text};
  for (const RangeVerdict& v : result.verdicts) {
    Words ratios;
    for (const auto& [name, fit] : v.fit) ratios.push_back(fmt::format("{} {:.2f}", name, fit.rmse / fit.scatter));
    table.rows.push_back({format_number(1e3 * v.to), joined(ratios, ", "), v.verdict});
  }
  page.table(table);
  add_adequacy(page, result);
}

}  // namespace snare::app
