#include "app/report/compare_report.hpp"

#include "app/report/report_page.hpp"
#include "results/in_mm.hpp"
#include "results/version.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace snare::app {

using namespace results;

namespace {

// of the range of the force: the error of a model that would dwarf the others
constexpr double far_off = 0.5;

/// What to show first where a model is far off: all of the others.
void close_up(PlotSpecification& plot, const std::vector<double>& shown, bool dwarfed) {
  if (!dwarfed || shown.empty()) return;
  const auto [least, most] = std::minmax_element(shown.begin(), shown.end());
  const double margin = 0.1 * (*most - *least);
  plot.y_window = Range{*least - margin, *most + margin};
  plot.note = "Close-up: a model that is off by more than half of the force goes beyond.";
}

}  // namespace

std::string compare_report_html(const std::string& title, const std::vector<reduction::CaseComparison>& cases,
                                bool interrupted) {
  ReportPage page(
      title.empty() ? "Models of a snare wire compared" : title,
      "Accuracy against the full wire and the measured force, cost, range and numbers of every model.");
  page.doubts({}, interrupted);
  for (const reduction::CaseComparison& one : cases) {
    page.heading(one.name);
    if (!one.report.usable()) page.callout("The full wire stopped: " + one.report.message, Tone::bad);
    if (one.models.empty()) continue;
    Table table;
    table.columns = {"model"_text,
                     "largest error, N"_number,
                     "of the force"_number,
                     "rms, N"_number,
                     "rms to measured, N"_number,
                     "an evaluation, s"_number,
                     "times cheaper"_number,
                     "to, mm"_number,
                     "numbers"_number,
                     "why it is far off"_text};
    PlotSpecification force{"Force", {"travel", "mm"}, {"force", "N"}};
    PlotSpecification error{"Error against the full wire", {"travel", "mm"}, {"model less full wire", "N"}};
    const Values travel = in_mm(one.travel);
    if (!one.measured.empty())
      force.curves.push_back({"measured", travel, one.measured, CurveStyle::points, 0});
    const reduction::ModelResult& full = one.models.front();
    int colour = 1;
    bool dwarfed = false;
    std::vector<double> forces, errors;
    for (const reduction::ModelResult& m : one.models) {
      const bool far = m.largest_error > far_off * one.force_range;
      dwarfed = dwarfed || far;
      if (!far) forces.insert(forces.end(), m.force.begin(), m.force.end());
      table.rows.push_back(
          {m.model, format_significant(m.largest_error),
           one.force_range > 0.0 ? format_significant(100.0 * m.largest_error / one.force_range, 2) + " %"
                                 : "-",
           format_significant(m.rms_error), m.measured_rms ? format_significant(*m.measured_rms) : "-",
           format_significant(m.seconds, 2), format_significant(full.seconds / m.seconds, 2),
           format_number(1e3 * m.range.high, 4), std::to_string(m.parameters), m.why});
      force.curves.push_back(
          {m.model, travel, m.force, &m == &full ? CurveStyle::line : CurveStyle::dashes, colour});
      if (&m != &full) {
        std::vector<double> off = m.force;
        for (std::size_t i = 0; i < off.size(); ++i) off[i] -= full.force[i];
        if (!far) errors.insert(errors.end(), off.begin(), off.end());
        error.curves.push_back({m.model, travel, off, CurveStyle::line, colour});
      }
      ++colour;
    }
    close_up(force, forces, dwarfed);
    close_up(error, errors, dwarfed);
    page.table(table);
    page.line_plot(force);
    page.line_plot(error);
  }
  page.footer("snare " + version());
  return page.html();
}

}  // namespace snare::app
