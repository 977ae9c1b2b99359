#include "app/report/paper_page.hpp"

#include "app/report/motion_pictures.hpp"
#include "app/report/report_page.hpp"
#include "app/report/report_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace snare::app {

namespace {

using papers::Figure;
using papers::FigureCurve;
using papers::FigureResult;
using papers::Origin;
using papers::Paper;

CurveStyle style_of(const FigureCurve& curve) {
  if (curve.origin == Origin::record) return CurveStyle::points;
  return curve.origin == Origin::published ? CurveStyle::dashes : CurveStyle::line;
}

Curve drawn(const FigureCurve& curve, int colour) {
  Curve result = make_curve(curve.name, curve.x, curve.y, style_of(curve), colour);
  if (curve.scatter > 0.0 && curve.origin == Origin::published)
    result.band = band_around(curve.y, Values(curve.y.size(), curve.scatter));
  return result;
}

/// Where one curve dwarfs those of the paper, shows the paper's first.
void look_at_published(PlotSpecification& plot, const std::vector<Curve>& published) {
  if (published.empty()) return;
  constexpr double dwarfs = 2.0;
  const Range all = extent(plot.curves), rest = extent(published);
  if (size_of(all) > dwarfs * size_of(rest))
    close_up(plot, rest, {0.15, 0.3}, "Close-up; others go beyond it.");
}

void add_panels(ReportPage& page, const Figure& figure, const FigureResult& result) {
  for (std::size_t k = 0; k < figure.panels.size(); ++k) {
    const papers::Panel& panel = figure.panels[k];
    PlotSpecification plot{panel.title, {panel.x.quantity, panel.x.unit}, {panel.y.quantity, panel.y.unit}};
    if (panel.to_scale) plot.scale = AxesScale::equal;
    plot.width = figure.panels.size() == 1 ? PlotWidth::full : PlotWidth::half;
    std::vector<Curve> published;
    bool scatter = false;
    int colour = 0;
    for (const FigureCurve& curve : result.curves) {
      if (curve.panel != k || curve.x.empty()) continue;
      plot.curves.push_back(drawn(curve, colour++));
      scatter = scatter || plot.curves.back().band;
      if (curve.origin == Origin::published) published.push_back(plot.curves.back());
    }
    if (!published.empty()) plot.note = "Dashed: printed in the paper.";
    if (scatter) plot.note += fmt::format(" Band: {:g} standard deviations of a reading.", band_sigmas);
    look_at_published(plot, published);
    page.line_plot(plot);
  }
}

void add_table(ReportPage& page, const papers::FigureTable& table) {
  if (table.rows.empty()) return;
  Table shown;
  for (const std::string& column : table.columns) shown.columns.push_back({column, ColumnKind::text});
  for (const std::vector<std::string>& row : table.rows) shown.rows.emplace_back(row.begin(), row.end());
  page.table(shown);
}

/// Numbers and statements of the text, each with the computed value.
void add_comparison(ReportPage& page, const Figure& figure, const FigureResult& result) {
  if (!std::string_view(figure.compared_in).empty())
    page.paragraph(fmt::format("snare validate compares this in its group \"{}\".", figure.compared_in));
  if (result.rows.empty()) return;
  Table table{"Compared with the text",
              {"Quantity"_text, "Unit"_text, "Reference"_number, "Computed"_number, "Error"_number,
               "Limit"_number, "Verdict"_text, "Source"_text}};
  for (const validation::Row& row : result.rows) {
    const std::string prefix = std::string(figure.number) + ": ";
    table.rows.push_back({row.name.starts_with(prefix) ? row.name.substr(prefix.size()) : row.name, row.unit,
                          shown(row.reference), shown(row.value), shown(row.error(), 2),
                          shown(row.limit.value(), 2),
                          row.within() ? Cell{"within", Tone::good} : Cell{"OUT", Tone::bad}, row.source});
  }
  page.table(table);
}

void add_figure(ReportPage& page, const Figure& figure, const FigureResult& result) {
  page.heading(fmt::format("{}: {}", figure.number, figure.title));
  page.paragraph(fmt::format("The text: {}", figure.text));
  page.paragraph(fmt::format("Made here: {}", figure.method));
  if (!result.failure.empty()) page.callout(result.failure, Tone::bad);
  add_panels(page, figure, result);
  if (result.scene != nullptr) {
    const papers::Run& run = *result.scene;
    page.scene(MotionPictures(run.asked.motions.runs.front().motion, run.samples, run.asked.motions.drawn)
                   .scene({}));
  }
  add_table(page, result.table);
  page.list(result.findings);
  add_comparison(page, figure, result);
}

}  // namespace

std::string paper_page(const Paper& paper, const std::vector<FigureResult>& results,
                       const std::string& version) {
  ReportPage page(fmt::format("Figures and tables of {}", paper.short_title), paper.title);
  page.doubts({}, results.size() < paper.figures.size());
  for (std::size_t k = 0; k < results.size(); ++k) add_figure(page, paper.figures[k], results[k]);
  page.heading("What is lost, and why");
  Table lost{"", {"What"_text, "Why, and what stands for it"_text}};
  for (const papers::Lost& one : paper.lost) lost.rows.push_back({{one.what}, {one.why}});
  page.table(lost);
  page.footer(written_by(version, "figures.json") + plot_help);
  return page.html();
}

}  // namespace snare::app
