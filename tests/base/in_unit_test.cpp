#include "base/in_unit.hpp"

#include "base/range.hpp"
#include "base/units.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>

namespace snare::base {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A decimal number of at most `digits` digits, as a file would have it.
double decimal(std::mt19937_64& engine, int digits) {
  const auto size = static_cast<std::int64_t>(std::pow(10.0, digits));
  const std::int64_t figures = std::uniform_int_distribution<std::int64_t>(-size + 1, size - 1)(engine);
  char text[40];
  std::snprintf(text, sizeof text, "%lde%d", static_cast<long>(figures),
                std::uniform_int_distribution<int>(-9, 3)(engine));
  return std::strtod(text, nullptr);
}

// What a file says comes back as the file says it, in every unit in which files are written.
TEST(InUnit, ADecimalNumberOfAFileComesBack) {
  EXPECT_EQ(in_unit(to_si(87.75, mm), mm), 87.75);
  EXPECT_NE(to_si(87.75, mm) / mm, 87.75) << "the plain division has the tail that is to be avoided";
  std::mt19937_64 engine(1);
  for (const double unit : {mm, degree, GPa, 1e-6, 1.0}) {
    for (int k = 0; k < 100000; ++k) {
      const double x = decimal(engine, 15);
      ASSERT_EQ(in_unit(to_si(x, unit), unit), x) << "unit " << unit;
    }
  }
}

// A number that was multiplied by its unit, not read, has the round-off of that product.
TEST(InUnit, AProductWithTheUnitComesBack) {
  std::mt19937_64 engine(2);
  int missed = 0;
  for (int k = 0; k < 100000; ++k) {
    const double x = decimal(engine, 12);
    missed += in_unit(x * degree, degree) != x || in_unit(x * mm, mm) != x ? 1 : 0;
  }
  EXPECT_EQ(missed, 0);
}

TEST(InUnit, ANumberThatIsInTheUnitLosesItsTailAlone) {
  EXPECT_EQ(without_tail(87.75000000000001, mm), 87.75);
  EXPECT_EQ(without_tail(58.00000000000001, degree), 58.0);
  EXPECT_EQ(without_tail(87.750000000000125, mm), 87.750000000000125);
  const double third = 100.0 / 3.0;
  EXPECT_EQ(without_tail(third, mm), third);
}

// Computed numbers keep what they have: off by no more than the two round-offs of converting there and back,
// that is less than one part in 2^51, whatever is shown; and most of them keep more than 15 digits.
TEST(InUnit, ComputedNumbersKeepTheirDigits) {
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> size(-12.0, 6.0);
  int kept = 0;
  constexpr int count = 100000;
  for (int k = 0; k < count; ++k) {
    const double x = std::pow(10.0, size(engine));
    for (const double unit : {mm, degree}) {
      const double shown = in_unit(x, unit);
      const long double exact =
          static_cast<long double>(x) / (unit == mm ? 1e-3L : static_cast<long double>(degree));
      ASSERT_LE(std::abs(static_cast<double>((shown - exact) / exact)), 2.0 * epsilon) << x;
      char text[40];
      std::snprintf(text, sizeof text, "%.14e", shown);
      kept += std::strtod(text, nullptr) != shown ? 1 : 0;
    }
  }
  EXPECT_GT(kept, count);  // of 2 count
}

TEST(InUnit, WhatIsNoOrdinaryNumberStays) {
  EXPECT_EQ(in_unit(0.0, mm), 0.0);
  EXPECT_TRUE(std::signbit(in_unit(-0.0, mm)));
  EXPECT_TRUE(std::isnan(in_unit(std::numeric_limits<double>::quiet_NaN(), mm)));
  EXPECT_EQ(in_unit(-std::numeric_limits<double>::infinity(), mm), -std::numeric_limits<double>::infinity());
  const double least = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(in_unit(least, mm), 1000.0 * least);
}

}  // namespace
}  // namespace snare::base
