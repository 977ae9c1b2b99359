// Rows, their limits and kinds; every validation row of the static wire is within its limit.

#include "validation/push_checks.hpp"

#include "tests/validation/row_checks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace snare::validation {
namespace {

Row row(Kind kind, double reference, double value, const Limit& limit) {
  return {"group", "name", "N", "source", kind, reference, value, limit};
}

TEST(Row, ErrorIsNeverInsideForANaN) {
  EXPECT_NEAR(row(Kind::closed_form, 2.0, 2.1, Limit::relative(0.06)).error(), 0.05, 1e-12);  // rounding
  EXPECT_TRUE(row(Kind::closed_form, 2.0, 2.1, Limit::relative(0.06)).within());
  EXPECT_FALSE(row(Kind::closed_form, 2.0, 2.1, Limit::absolute(0.06, "a reason")).within());
  for (const Limit& limit : {Limit::relative(0.06), Limit::absolute(0.06, "a reason")})
    EXPECT_FALSE(row(Kind::closed_form, 2.0, std::numeric_limits<double>::quiet_NaN(), limit).within());
}

// A share of nothing is no error: such a row has to have an absolute limit.
TEST(Row, ARelativeLimitOfAReferenceOfZeroIsNeverKept) {
  for (const double value : {0.0, 1e-12})
    EXPECT_FALSE(row(Kind::closed_form, 0.0, value, Limit::relative(0.1)).within()) << value;
}

// Without defaults a row that leaves out its kind or its limit does not compile.
static_assert(!std::is_default_constructible_v<Row>);
static_assert(!std::is_default_constructible_v<Limit>);
static_assert(!std::is_convertible_v<double, Kind>);

TEST(Limit, AnAbsoluteOneStatesItsReason) {
  EXPECT_THROW((void)Limit::absolute(1.0, ""), std::invalid_argument);
  EXPECT_EQ(Limit::absolute(1.0, "a reason").reason(), "a reason");
  EXPECT_EQ(Limit::relative(1.0).reason(), "");
}

TEST(Kinds, HaveNamesOfTheirOwn) {
  std::set<std::string_view> keys;
  std::set<std::string_view> words;
  for (const Kind kind : all_kinds) {
    keys.insert(key_of(kind));
    words.insert(words_of(kind));
  }
  EXPECT_EQ(keys, (std::set<std::string_view>{"closed_form", "published_measurement", "published_computation",
                                              "independent_code", "convergence"}));
  EXPECT_EQ(words.size(), keys.size());
}

TEST(Kinds, AreCountedLargestFirst) {
  const Limit limit = Limit::relative(0.1);
  EXPECT_EQ(count_by_kind({}), "");
  EXPECT_EQ(
      count_by_kind({row(Kind::closed_form, 1.0, 1.0, limit), row(Kind::convergence, 1.0, 1.0, limit),
                     row(Kind::independent_code, 1.0, 1.0, limit), row(Kind::convergence, 1.0, 1.0, limit)}),
      "2 convergence of this code, 1 closed form, 1 independent code");
}

class SlowStaticChecks : public testing::TestWithParam<std::size_t> {};

TEST_P(SlowStaticChecks, AllRowsAreWithinTheirLimits) {
  expect_within(static_wire_checks()[GetParam()].run());
}

INSTANTIATE_TEST_SUITE_P(SlowStatic, SlowStaticChecks,
                         testing::Range(std::size_t{0}, static_wire_checks().size()));

}  // namespace
}  // namespace snare::validation
