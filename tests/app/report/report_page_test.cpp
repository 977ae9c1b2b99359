#include "app/report/report_page.hpp"

#include "app/report/report_assets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace snare::app {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

PlotSpecification simple_plot() {
  PlotSpecification plot;
  plot.title = "Force";
  plot.x = {"displacement d", "mm"};
  plot.y = {"force F", "N"};
  plot.curves = {{"measured", {0.0, 1.0, 2.0}, {0.0, 0.5, 2.0}}};
  return plot;
}

/// What the browser would read from the n-th plot of the page.
nlohmann::json data_of_plot(const std::string& html, std::size_t n = 0) {
  const std::string open = "<script type=\"application/json\">";
  std::size_t at = html.find(open);
  for (std::size_t i = 0; i < n && at != std::string::npos; ++i) at = html.find(open, at + 1);
  if (at == std::string::npos) return nullptr;
  at += open.size();
  return nlohmann::json::parse(html.substr(at, html.find("</script>", at) - at));
}

std::string message_of(const PlotSpecification& plot) {
  ReportPage page("title", "");
  try {
    page.line_plot(plot);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(ReportPage, EscapesUserTextEverywhere) {
  const std::string attack = "<script>alert('x')</script> & \"quoted\"";
  ReportPage page(attack, attack);
  page.heading(attack);
  page.subheading(attack);
  page.paragraph(attack);
  page.list({attack});
  page.callout(attack, Tone::bad);
  page.key_figures({{attack, attack, attack}});
  page.table({attack, {{attack}, {attack, ColumnKind::code}}, {{attack, attack}}});
  PlotSpecification plot = simple_plot();
  plot.title = plot.note = plot.x.label = plot.y.unit = plot.curves[0].name = attack;
  page.line_plot(plot);
  page.footer(attack);

  const std::string html = page.html();
  EXPECT_EQ(html.find("<script>alert"), std::string::npos);
  EXPECT_NE(
      html.find("<title>&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt; &amp; &quot;quoted&quot;</title>"),
      std::string::npos);
  EXPECT_EQ(data_of_plot(html)["curves"][0]["name"], attack) << "the plot shows the text as it was written";
  EXPECT_EQ(count(html, "</script>"), 3U)
      << "data of one plot, D3 and the plot script; no text may end one early";
}

TEST(ReportPage, AcceptsTextThatIsNotUtf8) {
  ReportPage page("title \xff", "");
  PlotSpecification plot = simple_plot();
  plot.curves[0].name = "curve \xc3";
  page.line_plot(plot);
  EXPECT_NE(page.html().find("<title>title \uFFFD</title>"), std::string::npos);
  EXPECT_EQ(data_of_plot(page.html())["curves"][0]["name"], "curve \uFFFD");
}

TEST(ReportPage, MakesNoRequest) {
  ReportPage page("title", "subtitle");
  page.heading("section");
  page.line_plot(simple_plot());
  std::string html = page.html();
  EXPECT_NE(html.find("Content-Security-Policy\" content=\"default-src 'none'"), std::string::npos);

  // D3 can load files when it is asked to, so it is taken out before looking for loaders.
  const std::size_t d3 = html.find(report_assets::d3_script);
  ASSERT_NE(d3, std::string::npos);
  html.erase(d3, report_assets::d3_script.size());
  const std::regex loader(
      R"((src|href|action|poster|srcset)\s*=\s*["']?\s*(https?:|//|\.|/)|@import|url\(\s*["']?(https?:|//)|XMLHttpRequest|fetch\(|d3\.(json|csv|tsv|text|xhr|html|xml)\b)",
      std::regex::icase);
  std::smatch found;
  EXPECT_FALSE(std::regex_search(html, found, loader)) << found.str();
}

TEST(ReportPage, CarriesTheLicenceOfTheInlinedScript) {
  ReportPage page("title", "");
  page.line_plot(simple_plot());
  EXPECT_NE(page.html().find("Michael Bostock"), std::string::npos);
  EXPECT_EQ(report_assets::d3_script.find("</script"), std::string::npos);
  EXPECT_EQ(report_assets::plot_script.find("</script"), std::string::npos);
  EXPECT_EQ(report_assets::style_sheet.find("</style"), std::string::npos);
}

TEST(ReportPage, IsSmallWithoutPlots) {
  ReportPage page("title", "");
  page.paragraph("only text");
  EXPECT_LT(page.html().size(), 20000U) << "a page without plots carries no script";
}

TEST(ReportPage, RejectsValuesThatAreNotFinite) {
  PlotSpecification plot = simple_plot();
  plot.curves[0].y[1] = nan;
  EXPECT_EQ(message_of(plot), "plot 'Force', curve 'measured': y[1] = nan, must be finite");
  plot = simple_plot();
  plot.curves[0].x[2] = infinity;
  EXPECT_EQ(message_of(plot), "plot 'Force', curve 'measured': x[2] = inf, must be finite");
  plot = simple_plot();
  plot.curves[0].band = Band{{0.0, nan, 0.0}, {1.0, 1.0, 1.0}};
  EXPECT_EQ(message_of(plot), "plot 'Force', curve 'measured': lower[1] = nan, must be finite");
  plot = simple_plot();
  plot.y_window = Range{0.0, infinity};
  EXPECT_EQ(message_of(plot), "plot 'Force': y_window[1] = inf, must be finite");
  EXPECT_THROW(format_number(nan), std::invalid_argument);
  EXPECT_THROW(format_significant(-infinity), std::invalid_argument);
}

TEST(ReportPage, RejectsValueThatIsNotFiniteInAThinnedCurve) {
  const std::size_t size = 10 * max_points_per_curve;
  PlotSpecification plot = simple_plot();
  plot.curves[0].x.assign(size, 0.0);
  plot.curves[0].y.assign(size, 1.0);
  plot.curves[0].y[777] = nan;
  EXPECT_EQ(message_of(plot), "plot 'Force', curve 'measured': y[777] = nan, must be finite");
}

TEST(ReportPage, RejectsLengthsThatDiffer) {
  PlotSpecification plot = simple_plot();
  plot.curves[0].y.pop_back();
  EXPECT_EQ(message_of(plot), "plot 'Force', curve 'measured': y has 2 values, x has 3");
  plot = simple_plot();
  plot.curves[0].band = Band{{0.0, 0.0, 0.0}, {1.0}};
  EXPECT_EQ(message_of(plot), "plot 'Force', curve 'measured': upper has 1 values, x has 3");
  plot = simple_plot();
  plot.curves[0].colour = -1;
  EXPECT_EQ(message_of(plot), "plot 'Force', curve 'measured': colour = -1, must be >= 0");
  plot = simple_plot();
  plot.y_window = Range{2.0, 1.0};
  EXPECT_EQ(message_of(plot), "plot 'Force': y_window [2, 1] is empty");
}

TEST(ReportPage, RejectsRowThatDoesNotFitTheTable) {
  ReportPage page("title", "");
  const std::string before = page.html();
  EXPECT_THROW(page.table({"errors", {{"a"}, {"b"}}, {{"1", "2"}, {"3"}}}), std::invalid_argument);
  EXPECT_EQ(page.html(), before) << "a refused table leaves nothing behind";
}

TEST(ReportPage, LeavesOutAPlotWithoutPoints) {
  ReportPage page("title", "");
  PlotSpecification plot = simple_plot();
  plot.curves = {{"nothing", {}, {}}};
  page.line_plot(plot);
  plot.curves.clear();
  page.line_plot(plot);
  EXPECT_EQ(page.html().find("<figure"), std::string::npos);
}

TEST(ReportPage, WritesFewDigits) {
  ReportPage page("title", "");
  PlotSpecification plot = simple_plot();
  plot.curves[0].y = {1.0 / 3.0, 1234567.89, -1e-20 / 3.0};
  page.line_plot(plot);
  EXPECT_NE(page.html().find("\"y\":[0.333333,1234570.0,-3.33333e-21]"), std::string::npos);
}

TEST(ReportPage, ThinsLongCurvesButKeepsTheirExtremes) {
  const std::size_t size = 100001;
  PlotSpecification plot = simple_plot();
  plot.curves[0].x.clear();
  plot.curves[0].y.clear();
  for (std::size_t i = 0; i < size; ++i) {
    plot.curves[0].x.push_back(static_cast<double>(i));
    plot.curves[0].y.push_back(std::sin(1e-3 * static_cast<double>(i)));
  }
  plot.curves[0].y[54321] = 7.0;
  plot.curves[0].y[54322] = -7.0;
  ReportPage page("title", "");
  page.line_plot(plot);
  const auto curve = data_of_plot(page.html())["curves"][0];
  const auto x = curve["x"].get<std::vector<double>>();
  const auto y = curve["y"].get<std::vector<double>>();
  EXPECT_LE(x.size(), max_points_per_curve);
  EXPECT_GT(x.size(), max_points_per_curve / 4);
  EXPECT_EQ(x.size(), y.size());
  EXPECT_TRUE(std::ranges::is_sorted(x));
  EXPECT_EQ(std::ranges::max(y), 7.0);
  EXPECT_EQ(std::ranges::min(y), -7.0);
  EXPECT_NE(page.html().find("Of 100001 points"), std::string::npos) << "the reader is told";
}

TEST(ReportPage, KeepsTheShortOrderOfLoadAndUnload) {
  PlotSpecification plot = simple_plot();
  plot.curves[0].x = {0.0, 2.0, 1.0};
  ReportPage page("title", "");
  page.line_plot(plot);
  EXPECT_EQ(data_of_plot(page.html())["curves"][0]["x"], (std::vector<double>{0.0, 2.0, 1.0}));
}

TEST(ReportPage, ListsItsSectionsInTheContents) {
  ReportPage page("title", "");
  page.heading("Errors");
  page.heading("Wire & mount");
  const std::string html = page.html();
  EXPECT_NE(html.find("<a href=\"#section-2\">Wire &amp; mount</a>"), std::string::npos);
  EXPECT_NE(html.find("<h2 id=\"section-2\">Wire &amp; mount</h2>"), std::string::npos);
}

TEST(ReportPage, FormatsNumbers) {
  EXPECT_EQ(format_number(719880.0), "719880");
  EXPECT_EQ(format_number(0.1 + 0.2), "0.3");
  EXPECT_EQ(format_number(-13.578), "-13.578");
  EXPECT_EQ(format_number(2.3e-7), "2.3e-07");
  EXPECT_EQ(format_number(-0.0), "0");
  EXPECT_EQ(format_significant(0.15), "0.150");
  EXPECT_EQ(format_significant(85.23), "85.2");
  EXPECT_EQ(format_significant(99.96), "100");
  EXPECT_EQ(format_significant(12345.0), "12345");
  EXPECT_EQ(format_significant(1.5e-6), "1.50e-06");
  EXPECT_EQ(format_significant(0.0), "0");
}

}  // namespace
}  // namespace snare::app
