#include "app/report/reproduce_verdicts.hpp"

#include "app/report/report_words.hpp"
#include "app/report/trace_findings.hpp"

#include <fmt/format.h>

namespace snare::app {

void add_verdicts(ReportPage& page, const Reproduction& result) {
  if (!result.trace && result.verdicts.empty()) return;
  page.heading("What explains the curves");
  if (result.trace) {
    page.callout(verdict(*result.trace), result.trace->explained ? Tone::good : Tone::bad);
    page.paragraph(
        "Readings were drawn about the published fits with the scatter that the printed R2 implies, since the readings "
        "themselves are lost. Run `snare trace` on the experiment file for the whole evidence.");
    const auto& next = result.trace->next;
    if (next && !next->what.empty()) page.paragraph("To measure next: " + next->what + ".");
  }
  if (result.verdicts.empty()) return;
  page.paragraph("The range of travel of the published fits is not printed. What is said depends on it:");
  Table table;
  table.columns = {"range [mm]"_number, "fit within the published scatter"_text,
                   "rms error over scatter by position"_text, "the tracing says"_text};
  for (const RangeVerdict& v : result.verdicts) {
    Words ratios;
    for (const auto& [name, fit] : v.fit) ratios.push_back(fmt::format("{} {:.2f}", name, fit.rmse / fit.scatter));
    table.rows.push_back({format_number(1e3 * v.to), yes_no(v.within_scatter, Tone::good, Tone::plain),
                          joined(ratios, ", "), v.verdict});
  }
  page.table(table);
}

}  // namespace snare::app
