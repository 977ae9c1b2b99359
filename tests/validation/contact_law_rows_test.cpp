#include "validation/contact_law_checks.hpp"

#include "tests/validation/row_checks.hpp"

#include <gtest/gtest.h>

namespace snare::validation {
namespace {

TEST(ContactLawRows, AreWithinTheirLimits) {
  for (const Check& check : contact_law_checks()) expect_within(check.run());
}

}  // namespace
}  // namespace snare::validation
