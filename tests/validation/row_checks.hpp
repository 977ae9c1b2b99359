#pragma once

#include "validation/suite.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace snare::validation {

/// Every row is within its limit, every limit is relative to its reference or has a reason, and there are
/// rows.
inline void expect_within(const std::vector<Row>& rows) {
  EXPECT_FALSE(rows.empty());
  for (const Row& row : rows) {
    EXPECT_TRUE(row.within()) << row.group << ", " << row.name << ": " << row.value << " instead of "
                              << row.reference << ", error " << row.error() << " of " << row.limit.value();
    EXPECT_NE(row.limit.error_kind() == ErrorKind::absolute, row.limit.reason().empty())
        << row.group << ", " << row.name << ": an absolute limit has a reason, and it alone";
  }
}

}  // namespace snare::validation
