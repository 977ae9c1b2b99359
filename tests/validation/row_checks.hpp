#pragma once

#include "validation/suite.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace snare::validation {

/// Every row is within its limit, and there are rows.
inline void expect_within(const std::vector<Row>& rows) {
  EXPECT_FALSE(rows.empty());
  for (const Row& row : rows) {
    EXPECT_TRUE(row.within()) << row.group << ", " << row.name << ": " << row.value << " instead of " << row.reference
                              << ", error " << row.error() << " of " << row.limit;
  }
}

}  // namespace snare::validation
