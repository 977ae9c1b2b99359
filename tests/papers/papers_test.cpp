// The descriptions of the figures, and those of them that take little to compute.

#include "papers/papers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

namespace snare::papers {
namespace {

const std::string data = std::string(SNARE_SOURCE_DIR) + "/data";

/// The figure of a paper by its number.
const Figure& figure_of(const Paper& paper, const std::string& number) {
  for (const Figure& figure : paper.figures)
    if (figure.number == number) return figure;
  throw std::out_of_range("no figure " + number);
}

void expect_whole(const Figure& figure, const FigureResult& result) {
  EXPECT_EQ(result.failure, "") << figure.number;
  for (const validation::Row& row : result.rows)
    EXPECT_TRUE(row.within()) << row.name << ": " << row.value << " instead of " << row.reference;
  for (std::size_t k = 0; k < figure.panels.size(); ++k) {
    EXPECT_TRUE(std::ranges::any_of(result.curves, [k](const FigureCurve& c) { return c.panel == k; }))
        << figure.number << ", panel " << k;
  }
  for (const FigureCurve& curve : result.curves) {
    EXPECT_GT(curve.x.size(), 1U) << curve.name;
    EXPECT_EQ(curve.x.size(), curve.y.size()) << curve.name;
  }
}

TEST(Papers, EveryFigureIsDescribed) {
  std::set<std::string> names;
  for (const Paper* paper : all_papers()) {
    EXPECT_TRUE(names.insert(paper->name).second) << paper->name;
    std::set<std::string> numbers;
    for (const Figure& figure : paper->figures) {
      EXPECT_TRUE(numbers.insert(figure.number).second) << paper->name << ", " << figure.number;
      for (const char* text : {figure.title, figure.text, figure.method})
        EXPECT_FALSE(std::string(text).empty()) << figure.number;
      EXPECT_TRUE(figure.compute != nullptr || !figure.curves.empty()) << figure.number;
      for (const HistoryCurve& curve : figure.curves)
        EXPECT_LT(curve.panel, figure.panels.size()) << figure.number << ", " << curve.name;
    }
    EXPECT_FALSE(paper->lost.empty()) << paper->name;
  }
}

TEST(Papers, TheAirTableIsMade) {
  Runs runs(data);
  for (const char* number : {"Fig. 13", "Fig. 14", "Fig. 15", "Fig. 16"}) {
    const Figure& figure = figure_of(abiko(), number);
    const FigureResult result = made(abiko(), figure, runs);
    expect_whole(figure, result);
    for (const validation::Row& row : result.rows) EXPECT_EQ(row.group, "figures and tables of Abiko et al.");
  }
}

// Before the touch the velocity is that of the approach, and the clock begins with the touch.
TEST(Papers, TheClockOfTheAirTableBeginsWithTheTouch) {
  Runs runs(data);
  const FigureResult result = made(abiko(), figure_of(abiko(), "Fig. 14"), runs);
  for (const FigureCurve& curve : result.curves) {
    ASSERT_LT(curve.x.front(), 0.0) << curve.name;
    for (std::size_t i = 0; i < curve.x.size() && curve.x[i] < 0.0; ++i)
      EXPECT_NEAR(curve.y[i], 0.1, 1e-9) << curve.name;
  }
}

TEST(Papers, ConditionsOfContactAndInputsAreRead) {
  Runs runs(data);
  for (const char* number : {"Table 1", "Table 2", "Fig. 10", "Fig. 11"}) {
    const Figure& figure = figure_of(na(), number);
    expect_whole(figure, made(na(), figure, runs));
  }
}

TEST(Papers, TheStretchedWireIsThatOfTheEquations) {
  Runs runs(data);
  const FigureResult result = made(honda(), figure_of(honda(), "Fig. 5"), runs);
  ASSERT_EQ(result.curves.size(), 2U);
  // 2 K [1 - l/sqrt(l^2 + 2 h x + x^2)] (h + x) at x = 10 mm, h = sqrt(l^2 - L^2)
  const double K = 5.55e5, l = 0.09, L = 0.0875, x = 0.01, h = std::sqrt(l * l - L * L);
  const double expected = 2.0 * K * (1.0 - l / std::sqrt(l * l + 2.0 * h * x + x * x)) * (h + x);
  EXPECT_NEAR(result.curves[0].x.back(), 10.0, 1e-12);
  EXPECT_NEAR(result.curves[0].y.back(), expected, 1e-9 * expected);  // the same formula, other roundings
}

TEST(Papers, WhoeverStopsTheWorkIsObeyed) {
  Runs runs(data, {{}, [] { return true; }});
  EXPECT_THROW((void)made(abiko(), figure_of(abiko(), "Fig. 14"), runs), Stopped);
}

TEST(Papers, AColumnThatIsMissingIsNamed) {
  Runs runs(data);
  const auto& run = runs.of({"scenarios/jemrms_step.toml", {"duration_s=0.1"}});
  try {
    (void)run.columns("time_s", "no such column");
    FAIL();
  } catch (const std::out_of_range& error) {
    EXPECT_NE(std::string(error.what()).find("no such column"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace snare::papers
