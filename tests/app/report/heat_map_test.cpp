#include "app/report/heat_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

namespace snare::app {
namespace {

using testing::HasSubstr;

HeatMap two_by_two() {
  HeatMap map{"a < b", "x", "y", {0.0, 1.0, 3.0}, {0.0, 1.0, 2.0}, {}};
  map.cells = {{true, 0.0, "none of 3"}, {true, 1.0, "3 of 3"}, {false, 0.0, "hidden"}, {true, 0.5, ""}};
  return map;
}

TEST(HeatMap, DrawsTheKnownCellsInTheColoursOfTheirValues) {
  const std::string svg = heat_map(two_by_two());
  EXPECT_THAT(svg, HasSubstr("fill=\"#440154\"><title>none of 3</title>"));  // the ends of viridis
  EXPECT_THAT(svg, HasSubstr("fill=\"#fde725\"><title>3 of 3</title>"));
  EXPECT_EQ(svg.find("hidden"), std::string::npos);
  EXPECT_THAT(svg, HasSubstr("a &lt; b"));
}

TEST(HeatMap, DrawsPaleWhatIsKnownAtSecondHand) {
  HeatMap map = two_by_two();
  map.cells[1].pale = true;
  EXPECT_THAT(heat_map(map), HasSubstr("fill=\"#fde725\" fill-opacity=\"0.5\"><title>3 of 3</title>"));
  EXPECT_THAT(heat_map(map), HasSubstr("fill=\"#440154\"><title>none of 3</title>"));
}

// The script of a page draws every figure of the class "plot" from JSON, which a map does not have.
TEST(HeatMap, IsNoPlotForThePagesScript) {
  EXPECT_EQ(heat_map(two_by_two()).find("class=\"plot"), std::string::npos);
}

TEST(HeatMap, RefusesWhatDoesNotFitTogether) {
  HeatMap map = two_by_two();
  map.cells.pop_back();
  EXPECT_THROW(static_cast<void>(heat_map(map)), std::invalid_argument);
  map = two_by_two();
  map.x_edges[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(heat_map(map)), std::invalid_argument);
}

}  // namespace
}  // namespace snare::app
