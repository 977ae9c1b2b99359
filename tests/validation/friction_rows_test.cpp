#include "validation/friction_checks.hpp"

#include <gtest/gtest.h>

namespace snare::validation {
namespace {

void expect_within(const std::vector<Row>& rows) {
  ASSERT_FALSE(rows.empty());
  for (const Row& row : rows) {
    EXPECT_TRUE(row.within()) << row.name << ": " << row.value << " instead of " << row.reference
                              << ", error " << row.error() << " of " << row.limit;
  }
}

TEST(Friction, RestsBelowTheFrictionAngleAndSlidesAboveIt) {
  expect_within(incline_rows());
}
TEST(Friction, StopsABlockForGood) {
  expect_within(stopping_block_rows());
}
TEST(Friction, LetsACylinderRoll) {
  expect_within(rolling_rows());
}
TEST(Friction, MakesABeltStickAndSlip) {
  expect_within(stick_slip_rows());
}
TEST(Friction, ReversesWithASlowPushAsInTheStatics) {
  expect_within(reversed_push_rows());
}
TEST(Friction, OfStrandsReversesAsInTheStatics) {
  expect_within(strand_push_rows());
}

}  // namespace
}  // namespace snare::validation
