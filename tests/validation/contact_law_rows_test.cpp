#include "validation/contact_law_checks.hpp"

#include <gtest/gtest.h>

namespace snare::validation {
namespace {

TEST(ContactLawRows, AreWithinTheirLimits) {
  for (const Check& check : contact_law_checks()) {
    for (const Row& row : check.run()) {
      EXPECT_TRUE(row.within()) << row.name << ": " << row.value << " instead of " << row.reference
                                << ", error " << row.error();
    }
  }
}

}  // namespace
}  // namespace snare::validation
