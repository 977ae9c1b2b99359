// Intervals of sweeps contain closed-form probabilities and indices as often as they say.
// benchmarks/results/intervals.json has more functions, sizes and seeds.

#include "benchmarks/interval_coverage.hpp"

#include <gtest/gtest.h>

namespace snare::study {
namespace {

using namespace benchmarks;

// 95 of 100: of 200 studies a binomial's three standard deviations are 4.6 %.
TEST(SlowIntervals, OfSubsetSimulations) {
  for (const double probability : {1e-2, 1e-4, 1e-6}) {
    for (const LimitFunction& limit : limit_functions(probability))
      EXPECT_NEAR(subset_coverage(limit, 1000, {1, 200}).share(), 0.95, 0.046)
          << limit.name << ' ' << probability;
  }
}

// Hits alone have no levels; Clopper and Pearson's interval holds at least as often as it says.
TEST(Intervals, OfYesOrNoHoldAtLeastAsOften) {
  for (const double probability : {1e-2, 1e-4, 1e-6})
    EXPECT_GE(subset_coverage(yes_or_no(limit_functions(probability)[0]), 1000, {1, 50}).share(),
              0.95 - 0.03 * 3.0);
}

// The six indices of a study are correlated: counted as one study each, 4.6 % as above.
TEST(SlowIntervals, OfSobolIndices) {
  for (const IndexFunction& f : {ishigami(), g_function({0.0, 1.0, 4.5, 9.0, 99.0, 99.0}), box(0.1, 2)}) {
    const IndexCoverage c = index_coverage(f, 256, {1, 200});
    EXPECT_NEAR(c.first.share(), 0.95, 0.046) << f.name;
    EXPECT_NEAR(c.total.share(), 0.95, 0.046) << f.name;
  }
}

// A rare outcome in few rows: no indices rather than intervals that are too narrow.
TEST(Intervals, AreWithheldWhereFewRowsDecide) {
  EXPECT_TRUE(indices_of(box(0.01, 2), 64, 1).of.empty());
  EXPECT_FALSE(indices_of(box(0.01, 2), 4096, 1).of.empty());
}

}  // namespace
}  // namespace snare::study
