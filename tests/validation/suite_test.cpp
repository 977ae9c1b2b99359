// Every validation row of the command is within its limit.

#include "validation/push_checks.hpp"

#include "tests/validation/row_checks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace snare::validation {
namespace {

TEST(Row, ErrorIsNeverInsideForANaN) {
  Row row;
  row.reference = 2.0;
  row.value = 2.1;
  row.limit = 0.06;
  EXPECT_NEAR(row.error(), 0.05, 1e-12);
  EXPECT_TRUE(row.within());
  row.kind = ErrorKind::absolute;
  EXPECT_FALSE(row.within());
  row.value = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(row.within());
}

class SlowStaticChecks : public testing::TestWithParam<std::size_t> {};

TEST_P(SlowStaticChecks, AllRowsAreWithinTheirLimits) {
  expect_within(static_wire_checks()[GetParam()].run());
}

INSTANTIATE_TEST_SUITE_P(SlowStatic, SlowStaticChecks, testing::Range(std::size_t{0}, static_wire_checks().size()));

}  // namespace
}  // namespace snare::validation
