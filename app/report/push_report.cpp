#include "app/report/push_report.hpp"

#include "app/report/report_page.hpp"
#include "app/report/report_words.hpp"
#include "results/in_mm.hpp"
#include "results/version.hpp"

#include <algorithm>
#include <cstddef>

namespace snare::app {

using namespace results;

namespace {

using identification::Prediction;
using identification::Series;

/// A model whose curves are drawn.
struct Model {
  const char* name;
  const std::vector<Prediction>& predictions;
  CurveStyle style;
};

void series_table(ReportPage& page, const std::vector<Series>& series, const Model& model) {
  Table table{"",
              {"Series"_code, "Position [mm]"_number, "Points"_number, "Largest force [N]"_number,
               "rms to readings [N]"_number, "of their range"_number, "Ended"_text}};
  for (std::size_t k = 0; k < series.size(); ++k) {
    const Prediction& p = model.predictions[k];
    const std::vector<double> readings = identification::measured_force(series[k]);
    const bool read = !readings.empty() && !p.force.empty();
    const identification::Misfit misfit =
        read ? identification::misfit(readings, p.force) : identification::Misfit();
    double largest = 0.0;
    for (const double force : p.force) largest = std::max(largest, std::abs(force));
    const numerics::SolveReport& report = p.curve.curve.report;
    table.rows.push_back({series[k].name, format_number(in_mm(series[k].test.contact_position)),
                          std::to_string(p.force.size()), measured(largest),
                          read ? measured(misfit.rmse) : absent, read ? percent(misfit.nrmse) : absent,
                          report.usable() ? Cell("at the last point") : Cell(report.message, Tone::bad)});
  }
  page.table(table);
}

/// A plot a series: forces, and where there are readings what the last model leaves of them.
void series_plots(ReportPage& page, const std::vector<Series>& series, const std::vector<Model>& models) {
  for (std::size_t k = 0; k < series.size(); ++k) {
    const Values travel = in_mm(identification::measured_displacement(series[k]));
    const Values readings = identification::measured_force(series[k]);
    const std::string at =
        series[k].name + ", at " + format_number(in_mm(series[k].test.contact_position)) + " mm";
    PlotSpecification force{at, {"travel", "mm"}, {"force", "N"}};
    if (readings.empty()) force.width = PlotWidth::full;
    if (!readings.empty()) {
      const bool drawn = !series[k].readings.has_value();
      force.curves.push_back(make_curve(drawn ? "published fit" : "measured", travel, readings,
                                        drawn ? CurveStyle::dashes : CurveStyle::points, 0));
    }
    int colour = 1;
    for (const Model& model : models)
      if (k < model.predictions.size())  // else it has none: its path did not come to an end
        force.curves.push_back(
            make_curve(model.name, travel, model.predictions[k].force, model.style, colour++));
    page.line_plot(force);
    if (readings.empty()) continue;
    PlotSpecification remainder{
        "What is left: " + series[k].name, {"travel", "mm"}, {"measured less computed", "N"}};
    colour = 1;
    for (const Model& model : models) {
      if (k >= model.predictions.size()) continue;
      Values rest;
      const Values& computed = model.predictions[k].force;
      for (std::size_t i = 0; i < std::min(readings.size(), computed.size()); ++i)
        rest.push_back(readings[i] - computed[i]);
      remainder.curves.push_back(make_curve(model.name, travel, rest, model.style, colour++));
    }
    page.line_plot(remainder);
  }
}

}  // namespace

std::string push_report_html(const identification::Experiment& experiment,
                             const std::vector<identification::Prediction>& predictions,
                             const std::vector<std::string>& warnings, bool interrupted) {
  ReportPage page(experiment.title, experiment.source);
  page.doubts(warnings, interrupted);
  const Model declared{"declared model", predictions, CurveStyle::line};
  page.heading("Series");
  page.paragraph("The declared model, nothing fitted.");
  series_table(page, experiment.series, declared);
  page.heading("Curves");
  series_plots(page, experiment.series, {declared});
  page.footer(written_by(version(), "curves.csv") + plot_help);
  return page.html();
}

std::string fit_report_html(const identification::Experiment& experiment, const identification::Trace& trace,
                            const std::vector<std::string>& warnings) {
  ReportPage page(experiment.title, experiment.source);
  page.doubts(warnings, trace.interrupted);
  page.key_figures({{"rms error, declared", measured(trace.declared.rmse, " N"), ""},
                    {"rms error, fitted", measured(trace.final.rmse, " N"), ""},
                    {"chi2 per degree of freedom", measured(trace.final.chi2_dof), "1: nothing but noise"}});
  page.heading("Fitted numbers");
  Table numbers{"", {"Number"_code, "Declared"_number, "Value"_number, "95 % interval"_number, "Unit"_text}};
  for (const identification::FittedNumber& n : trace.final.numbers) {
    std::vector<Cell> row{n.key, shown(n.declared)};
    for (Cell& cell : value_cells(n)) row.push_back(std::move(cell));
    row.emplace_back(n.unit);
    numbers.rows.push_back(std::move(row));
  }
  page.table(numbers);
  if (!trace.base_tests.acceptable(trace.tolerance)) {
    page.callout(
        "What the fitted model leaves is more than noise. What the model lacks is asked by snare trace.",
        Tone::bad);
  }
  page.heading("Series");
  const Model fitted{"fitted model", trace.final_predictions, CurveStyle::line};
  series_table(page, trace.series, fitted);
  page.heading("Curves");
  series_plots(page, trace.series,
               {{"declared model", trace.declared_predictions, CurveStyle::dashes}, fitted});
  page.footer(written_by(version(), "fit.json and curves.csv") + plot_help);
  return page.html();
}

}  // namespace snare::app
