#include "app/compare_report.hpp"

#include "app/commands.hpp"
#include "app/report_page.hpp"

#include <fmt/format.h>

namespace snare::app {

std::string compare_report_html(const std::string& title,
                                const std::vector<reduction::CaseComparison>& cases) {
  ReportPage page(
      title.empty() ? "Models of a snare wire compared" : title,
      "Accuracy against the full wire and the measured force, cost, range and numbers of every model.");
  for (const reduction::CaseComparison& one : cases) {
    page.heading(one.name);
    if (!one.report.usable()) page.callout("The full wire stopped: " + one.report.message, Tone::bad);
    if (one.models.empty()) continue;
    Table table;
    table.columns = {{"model"},
                     {"largest error, N", ColumnKind::number},
                     {"of the force", ColumnKind::number},
                     {"rms, N", ColumnKind::number},
                     {"rms to measured, N", ColumnKind::number},
                     {"an evaluation, s", ColumnKind::number},
                     {"times cheaper", ColumnKind::number},
                     {"to, mm", ColumnKind::number},
                     {"numbers", ColumnKind::number}};
    PlotSpecification force{"Force", {"travel", "mm"}, {"force", "N"}};
    PlotSpecification error{"Error against the full wire", {"travel", "mm"}, {"model less full wire", "N"}};
    std::vector<double> travel = one.travel;
    for (double& d : travel) d *= 1e3;
    if (!one.measured.empty())
      force.curves.push_back({"measured", travel, one.measured, CurveStyle::points, 0});
    const reduction::ModelResult& full = one.models.front();
    int colour = 1;
    for (const reduction::ModelResult& m : one.models) {
      table.rows.push_back(
          {m.model, format_significant(m.largest_error),
           one.force_range > 0.0 ? format_significant(100.0 * m.largest_error / one.force_range, 2) + " %"
                                 : "-",
           format_significant(m.rms_error), m.measured_rms ? format_significant(*m.measured_rms) : "-",
           format_significant(m.seconds, 2), format_significant(full.seconds / m.seconds, 2),
           format_number(1e3 * m.range.high, 4), std::to_string(m.parameters)});
      force.curves.push_back(
          {m.model, travel, m.force, &m == &full ? CurveStyle::line : CurveStyle::dashes, colour});
      if (&m != &full) {
        std::vector<double> off = m.force;
        for (std::size_t i = 0; i < off.size(); ++i) off[i] -= full.force[i];
        error.curves.push_back({m.model, travel, off, CurveStyle::line, colour});
      }
      ++colour;
    }
    page.table(table);
    page.line_plot(force);
    page.line_plot(error);
  }
  page.footer("snare " + version());
  return page.html();
}

}  // namespace snare::app
