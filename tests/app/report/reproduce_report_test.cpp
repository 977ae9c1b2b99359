#include "app/report/reproduce_report.hpp"

#include "tests/app/report/page_reading.hpp"
#include "tests/app/report/reproduce_fixture.hpp"
#include "tests/app/report/trace_fixture.hpp"

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace snare::app {
namespace {

using nlohmann::json;
using Strings = std::vector<std::string>;

const std::string position = "s\u00a0=\u00a040\u00a0mm";
/// Its section begins with this heading; the contents before have the same as a link.
const std::string section = "\">" + position + "</h2>";

std::string page_of(const Reproduction& result) {
  return reproduce_report_html(result, "0.1.0");
}

void stop(identification::Prediction& prediction, const std::string& why) {
  prediction.curve.curve.report.termination = numerics::Termination::step_too_small;
  prediction.curve.curve.report.message = why;
}

TEST(ReproduceReport, SaysTheErrorsInWords) {
  expect_all(
      page_of(reproduction()),
      {("The declared model with nothing fitted differs from the published force by 64.5 N rms over all "
        "positions, 32.3 times its range and 645 times the published scatter. A solid wire."),
       ("The best fit with 1 fitted number differs from the published force by 0.200 N rms over all "
        "positions, "
        "10.0 % of its range and 2.0 times the published scatter."),
       ("No verdict: the tracing is missing. The best fit is 2.0 times the published scatter away from the "
        "published curves."),
       "<li>the range is assumed</li>", "Written by snare 0.1.0. The numbers are in reproduce.json"});
}

// An error within the scatter is no verdict: the tracing judges, and no other sentence contradicts it.
TEST(ReproduceReport, TheVerdictIsThatOfTheTracing) {
  Reproduction result = reproduction();
  result.models[1].predictions[0].force = {0.09, 1.09, 2.09};
  result.trace = unexplained_trace();
  result.trace->base_tests.lack_of_fit = 0.001;
  const std::string html = page_of(result);
  EXPECT_TRUE(contains(html, "Not explained: "));
  EXPECT_TRUE(contains(html, "(p &lt;= 0.001)") || contains(html, "(p <= 0.001)"));
  EXPECT_FALSE(contains(html, "agrees with"));
  EXPECT_FALSE(contains(html, "to within their"));
}

TEST(ReproduceReport, ListsErrorsAndParameters) {
  const std::string html = page_of(reproduction());
  EXPECT_EQ(row_of(html, {position, "declared model"}),
            (Strings{position, "declared model", "64.5", "32.3 \u00d7", "645", "102", "2.00", "2"}));
  EXPECT_EQ(row_of(html, {position, "best fit"}),
            (Strings{position, "best fit", "0.200", "10.0 %", "2.0", "2.20", "2.00", "2"}));
  EXPECT_EQ(row_of(html, {"all", "best fit"}),
            (Strings{"all", "best fit", "0.200", "10.0 %", "2.0", "", "", ""}));
  EXPECT_EQ(row_of(html, {"wire.length_mm"}),
            (Strings{"wire.length_mm", "mm", "180", "175.123 \u00b1 0.012"}));
  EXPECT_EQ(row_of(html, {"diameter"}), (Strings{"diameter", "1.5", "mm"}));
  EXPECT_EQ(row_of(html, {"bending stiffness"}), (Strings{"bending stiffness", "0.048", "N m\u00b2"}));
}

TEST(ReproduceReport, GivesThePublishedLaw) {
  EXPECT_TRUE(
      contains(page_of(reproduction()),
               "Published: F = A d\u00b2 + B d + C with A = 0 N/m\u00b2, B = 1000 N/m, C = 0 N, R\u00b2 = "
               "0.970874; scatter \u03c3 = 0.100 N. Pushed from first touch to 2 mm."));
  Reproduction result = reproduction();
  result.experiment.series[0].law.reset();
  result.experiment.series[0].readings = identification::Readings{{0.0, 1e-3, 2e-3}, {0.0, 1.0, 2.0}, {}};
  const std::string html = page_of(result);
  EXPECT_FALSE(contains(html, "Published: F"));
  EXPECT_FALSE(contains(html, "Scatter of the published curves"));
  EXPECT_EQ(row_of(html, {position, "best fit"})[4], "\u2013") << "no scatter is known";
}

TEST(ReproduceReport, DrawsTheBestModelAtAllPositions) {
  const json force = plot_of(page_of(reproduction()), "Force at all positions");
  EXPECT_EQ(curve_of(force, position + " published")["y"], json({0.0, 1.0, 2.0}));
  EXPECT_EQ(curve_of(force, position + " published")["lower"], json({-0.2, 0.8, 1.8}))
      << "two standard deviations";
  EXPECT_EQ(curve_of(force, position + " best fit")["y"], json({0.2, 1.2, 2.2}));
  const json stiffness = plot_of(page_of(reproduction()), "Tangent stiffness at all positions");
  EXPECT_EQ(curve_of(stiffness, position + " published")["y"], json({1.0, 1.0, 1.0})) << "1000 N/m, in N/mm";
}

TEST(ReproduceReport, DrawsForceResidualAndStiffness) {
  const std::string html = page_of(reproduction());
  const json force = plot_of(html, "Force", section);
  EXPECT_EQ(curve_of(force, "declared model")["x"], json({0.0, 1.0, 2.0})) << "displacement in mm";
  EXPECT_EQ(curve_of(force, "declared model")["style"], "dashes");
  EXPECT_EQ(curve_of(force, "best fit")["style"], "line");
  // The published band and the best fit reach from -0.2 to 2.2 N: 0.15 of that below, 0.3 above.
  EXPECT_EQ(force["window"], json({-0.56, 2.92}));
  EXPECT_TRUE(contains(html, "Close-up; beyond it: declared model (to 102 N)."));
  EXPECT_FALSE(plot_of(html, "Force, all models at full scale", section).contains("window"));
  const json residual = plot_of(html, "Residual: computed minus published force", section);
  EXPECT_EQ(curve_of(residual, "declared model")["y"], json({0.0, 50.0, 100.0}));
  EXPECT_EQ(curve_of(residual, "best fit")["y"], json({0.2, 0.2, 0.2}));
  EXPECT_EQ(curve_of(residual, "published scatter \u00b1 2 \u03c3")["upper"], json({0.2, 0.2, 0.2}));
  const json stiffness = plot_of(html, "Tangent stiffness", section);
  EXPECT_EQ(curve_of(stiffness, "declared model")["y"], json({51.0, 51.0, 51.0}));
}

TEST(ReproduceReport, DrawsTheWire) {
  const std::string html = page_of(reproduction());
  const json shapes = plot_of(html, "Shapes of the wire, declared model");
  EXPECT_EQ(shapes["equal"], true);
  EXPECT_EQ(shapes["curves"].size(), 4U) << "two shapes, each with the outline of the pusher";
  EXPECT_EQ(curve_of(shapes, "d = 2 mm")["x"], json({0.0, 40.0, 175.0}));
  EXPECT_EQ(curve_of(shapes, "d = 2 mm")["y"], json({0.0, 9.0, 0.0}));
  // A circle of 6 mm about (40, 3): its first point is to the right of the axis.
  EXPECT_EQ(shapes["curves"][1]["x"][0], 46.0);
  EXPECT_EQ(shapes["curves"][1]["y"][0], 3.0);
  const json tension = plot_of(html, "Tension along the wire, best fit");
  EXPECT_EQ(curve_of(tension, "d = 0 mm")["x"], json({0.0, 41.0, 180.0}));
  EXPECT_EQ(curve_of(tension, "d = 0 mm")["y"], json({5.0, 5.5, 6.0}));
  const json moment = plot_of(html, "Bending moment along the wire, best fit");
  EXPECT_EQ(curve_of(moment, "d = 0 mm")["y"], json({0.1, -0.2, 0.1}));
}

TEST(ReproduceReport, TellsWhereAModelStopped) {
  Reproduction result = reproduction();
  identification::Prediction& declared = result.models[0].predictions[0];
  declared = computed_curve({0.0, 40.0});
  declared.curve.curve.shapes.clear();
  stop(declared, "no equilibrium beyond d = 1.2 mm");
  const std::string html = page_of(result);
  expect_all(html, {"The declared model stopped early: no equilibrium beyond d = 1.2 mm",
                    "Shapes of the wire, best fit", "over what was computed"});
  EXPECT_EQ(row_of(html, {position, "declared model (incomplete)"})[5], "40.0");
  EXPECT_EQ(curve_of(plot_of(html, "Force", section), "declared model")["y"], json({0.0, 40.0}));
  EXPECT_FALSE(contains(html, "Shapes of the wire, declared model"));
}

TEST(ReproduceReport, DoesNotPreferAModelForStoppingEarly) {
  Reproduction result = reproduction();
  result.models[0].predictions[0] = computed_curve({0.01});
  stop(result.models[0].predictions[0], "no equilibrium beyond d = 0.1 mm");
  EXPECT_TRUE(contains(page_of(result), "The best fit is 2.0 times"));
  stop(result.models[1].predictions[0], "interrupted");
  EXPECT_TRUE(contains(page_of(result), "No verdict: the declared model was not computed to the end"));
}

TEST(ReproduceReport, ShowsWhatWasNotComputedAsADash) {
  Reproduction result = reproduction();
  result.models[1].predictions.clear();
  const std::string html = page_of(result);
  expect_all(html, {"The best fit was not computed.", "The best fit was not computed here.",
                    "The declared model is"});
  EXPECT_EQ(
      row_of(html, {position, "best fit (incomplete)"}),
      (Strings{position, "best fit (incomplete)", "\u2013", "\u2013", "\u2013", "\u2013", "2.00", "2"}));
  EXPECT_FALSE(contains(html, "Shapes of the wire, best fit"));
  EXPECT_TRUE(contains(page_of(Reproduction{}), "No model was computed."));
}

TEST(ReproduceReport, SaysWhatTheTracingFound) {
  Reproduction result = reproduction();
  EXPECT_FALSE(contains(page_of(result), "What the tracing says"));
  result.trace = explained_trace();
  const std::string html = page_of(result);
  expect_all(html,
             {"<p class=\"callout good\">Explained. plasticity", "To measure next: push at s = 30 mm."});
}

TEST(ReproduceReport, NamesPlotAndCurveOfAValueThatIsNotFinite) {
  Reproduction result = reproduction();
  result.models[1].predictions[0].curve.curve.shapes[1].tension[2] = std::numeric_limits<double>::infinity();
  try {
    page_of(result);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "plot 'Tension along the wire, best fit', curve 'd = 2 mm': y[2] = inf, must be finite");
  }
}

TEST(ReproduceReport, EscapesTheTitle) {
  Reproduction result = reproduction();
  result.experiment.title = "<script>alert(1)</script>";
  const std::string html = page_of(result);
  EXPECT_FALSE(contains(html, "<script>alert"));
  EXPECT_TRUE(contains(html, "<h1>&lt;script&gt;alert(1)&lt;/script&gt;</h1>"));
}

}  // namespace
}  // namespace snare::app
