#include "base/decimal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace snare::base {
namespace {

// Lengths and spans in hundredths of a millimetre: their difference in binary is not the decimal one in about
// half of all cases.
TEST(Decimal, DifferencesOfDecimalNumbersAreTheDecimalOnes) {
  std::mt19937_64 random(1);
  std::uniform_int_distribution<int> hundredths(1, 500'000);
  int differ = 0;
  for (int k = 0; k < 10'000; ++k) {
    const int span = hundredths(random), slack = hundredths(random);
    const double length_m = (span + slack) / 100'000.0, span_m = span / 100'000.0,
                 slack_m = slack / 100'000.0;
    const double derived = length_m - span_m;
    differ += derived == slack_m ? 0 : 1;
    EXPECT_FALSE(exceeds(derived, slack_m, {length_m, span_m}));
    EXPECT_FALSE(exceeds(slack_m, derived, {length_m, span_m}));
    // A tenth of a picometre is not round-off.
    EXPECT_TRUE(exceeds(derived + 1e-13, slack_m, {length_m, span_m}));
  }
  EXPECT_GT(differ, 1000);
}

TEST(Decimal, NothingExceedsANaN) {
  EXPECT_FALSE(exceeds(std::nan(""), 1.0));
  EXPECT_FALSE(exceeds(1.0, std::nan("")));
}

}  // namespace
}  // namespace snare::base
