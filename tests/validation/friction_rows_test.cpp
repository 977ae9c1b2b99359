#include "validation/friction_checks.hpp"

#include "tests/validation/row_checks.hpp"

#include <gtest/gtest.h>

namespace snare::validation {
namespace {

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
