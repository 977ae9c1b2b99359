#include "app/report/paper_page.hpp"

#include "tests/app/report/page_reading.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace snare::app {
namespace {

using papers::Figure;
using papers::FigureResult;
using papers::Origin;
using papers::Paper;

Paper small_paper() {
  return {"small",
          "Somebody: A paper & its title",
          "Somebody",
          {{"Fig. 1",
            "Force",
            "The force grows.",
            "By a law.",
            {{"Force", {"displacement", "mm"}, {"force", "N"}}}},
           {"Table 2", "Numbers", "A number.", "Read back.", {}, {}, nullptr, "a group"}},
          {{"readings", "never printed"}}};
}

FigureResult curves() {
  FigureResult result;
  result.curves = {{"printed", Origin::published, {0.0, 1.0, 2.0}, {0.0, 1.0, 4.0}, 0, 0.1},
                   {"computed", Origin::computed, {0.0, 1.0, 2.0}, {0.0, 50.0, 100.0}}};
  result.findings = {"It is stiff."};
  result.rows = {{"group", "Fig. 1: force at 2 mm", "N", "Somebody, Table 1",
                  validation::Kind::published_measurement, 4.0, 100.0, validation::Limit::relative(0.1)}};
  return result;
}

TEST(PaperPage, ShowsTextMethodCurvesComparisonAndWhatIsLost) {
  FigureResult table;
  table.table = {{"quantity", "printed"}, {{"mass", "8.9"}}};
  const std::string html = paper_page(small_paper(), {curves(), table}, "0");
  expect_all(html,
             {"Fig. 1: Force", "The text: The force grows.", "Made here: By a law.", "It is stiff.",
              "A paper &amp; its title", "Table 2: Numbers",
              "snare validate compares this in its group &quot;a group&quot;", "What is lost, and why"});
  EXPECT_EQ(row_of(html, {"readings"}), (std::vector<std::string>{"readings", "never printed"}));
  EXPECT_EQ(row_of(html, {"mass"}), (std::vector<std::string>{"mass", "8.9"}));
  EXPECT_EQ(row_of(html, {"force at 2 mm"}).at(6), "OUT");
  EXPECT_FALSE(contains(html, "was interrupted"));
}

// The computed curve goes to 100 N, the printed one to 4 N: the plot opens on the range of the printed one.
TEST(PaperPage, APrintedCurveIsNotDwarfed) {
  const std::string html = paper_page(small_paper(), {curves()}, "0");
  const nlohmann::json plot = plot_of(html, "Force");
  ASSERT_FALSE(plot.is_null());
  EXPECT_EQ(curve_of(plot, "printed").at("x").size(), 3U);
  EXPECT_TRUE(contains(html, "Close-up; others go beyond it."));
}

TEST(PaperPage, SaysThatItIsAPart) {
  EXPECT_TRUE(contains(paper_page(small_paper(), {curves()}, "0"), "was interrupted"));
}

}  // namespace
}  // namespace snare::app
