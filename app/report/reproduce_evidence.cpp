#include "app/report/reproduce_evidence.hpp"

#include "app/report/report_words.hpp"
#include "results/trace_findings.hpp"

#include <fmt/format.h>

namespace snare::app {

using namespace results;

namespace {

/// How the rounding of R2 moves the answer.
void add_digits(ReportPage& page, const Reproduction& result) {
  Words words;
  for (const auto& [digits, s] : result.by_digits)
    words.push_back(fmt::format("{:.2g} with {} decimals", s.p, digits));
  if (words.empty()) return;
  page.paragraph(fmt::format(
      "R\u00b2 is printed rounded, which leaves an interval for the scatter of the readings: p of the "
      "best fit is {}.",
      joined(words)));
}

}  // namespace

void add_evidence(ReportPage& page, const Reproduction& result) {
  if (!result.trace) return;
  page.heading("What the tracing says at the assumed range");
  if (result.map) page.paragraph(verdict(*result.trace));
  page.paragraph(
      "The readings are lost: the published numbers of every fit are compared with those of the same fit to "
      "the "
      "computed curve, by their likelihood. Run `snare trace` on the experiment file for the whole "
      "evidence.");
  add_digits(page, result);
  const auto& next = result.trace->next;
  if (next && !next->what.empty()) page.paragraph("To measure next: " + next->what + ".");
}

}  // namespace snare::app
