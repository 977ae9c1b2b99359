#include "tests/support/refusal.hpp"
#include "wires.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace snare::reduction {
namespace {

TEST(WireFile, HasDefaultsThatMakeSense) {
  const WireCase wire = small_wire().cases.front();
  EXPECT_TRUE(wire.symmetric());
  EXPECT_FALSE(wire.dissipates());
  EXPECT_NEAR(wire.position.low, 0.035, 1e-12);
  EXPECT_NEAR(wire.position.high, 0.0875, 1e-12);
  EXPECT_NEAR(wire.slack.low, 0.75 * 0.49e-3, 1e-12);
  // A mean strain of 0.2 %: the two pieces rise from the bulge of 5.9 mm to 8.6 mm.
  EXPECT_NEAR(wire.travel.high, 2.71e-3, 2e-5);
  EXPECT_EQ(wire.law_positions.size(), 3u);
}

TEST(WireFile, ListsEveryProblem) {
  const std::string text = small_wire_text(R"(tolerance = 2.0
[ranges]
travel_mm = -1.0
position_mm = [90.0, 40.0]
slack_mm = [1.0, 2.0]
frction = [0.1]
[laws]
positions_mm = [0.1]
)");
  const std::string said = test::refusal([&] { return parse_wire_file("w.toml", text); });
  using testing::HasSubstr;
  EXPECT_THAT(said, HasSubstr("w.toml:25: table.tolerance = 2.0, must be >= 1e-05 and <= 0.5"));
  EXPECT_THAT(said, HasSubstr("w.toml:27: ranges.travel_mm = -1.0, must be >= 1e-06 and <= 1000"));
  EXPECT_THAT(
      said, HasSubstr("ranges.position_mm = [90.0, 40.0], must be [low, high] with low < high, or [value]"));
  EXPECT_THAT(said, HasSubstr("ranges.slack_mm = [1.0, 2.0], must contain that of the wire, 0.49 mm"));
  EXPECT_THAT(said, HasSubstr("frction"));
  EXPECT_THAT(said, HasSubstr("did you mean friction"));
  EXPECT_THAT(said, HasSubstr("laws.positions_mm[1] = 0.1, must be >= 1.75 and <= 173.25"));
}

// 0.49 mm is what is left of the length in decimal numbers, and not in binary.
TEST(WireFile, RangesMayEndAtTheSlackOfTheWire) {
  EXPECT_EQ(small_wire("[ranges]\nslack_mm = [0.49, 1.0]\n").cases.size(), 1u);
  EXPECT_EQ(small_wire("[ranges]\nslack_mm = [0.1, 0.49]\n").cases.size(), 1u);
  EXPECT_EQ(small_wire("[ranges]\nslack_mm = [0.49]\n").cases.size(), 1u);
}

TEST(WireFile, CombinesListedValues) {
  const WireFile file = small_wire("[ranges]\nradius_mm = [3.0, 6.0]\nfriction = [0.0, 0.1, 0.2]\n");
  ASSERT_EQ(file.cases.size(), 6u);
  EXPECT_NEAR(file.cases[0].test.pusher.radius, 0.003, 1e-15);
  EXPECT_NEAR(file.cases[5].test.pusher.radius, 0.006, 1e-15);
  EXPECT_EQ(file.cases[5].test.pusher.friction, 0.2);
  EXPECT_TRUE(file.cases[5].dissipates());
}

}  // namespace
}  // namespace snare::reduction
