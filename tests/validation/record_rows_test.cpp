#include "validation/record_checks.hpp"

#include "tests/validation/row_checks.hpp"

#include <gtest/gtest.h>

namespace snare::validation {
namespace {

// Measurements of others are not part of the product: without them there is nothing to check.
TEST(SlowRecordRows, MeasuredRecordsAreTraced) {
  const std::filesystem::path source = SNARE_SOURCE_DIR;
  int run = 0;
  for (const Check& check : record_checks(source / "data", source / ".." / "shared" / "data")) {
    if (!check.skipped.empty()) continue;
    ++run;
    expect_within(check.run());
  }
  if (run == 0) GTEST_SKIP() << "the measured records are not beside the repository";
}

}  // namespace
}  // namespace snare::validation
