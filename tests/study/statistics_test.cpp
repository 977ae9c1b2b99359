#include "study/design.hpp"
#include "study/proportion.hpp"
#include "study/sobol_indices.hpp"
#include "study/subset.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

namespace snare::study {
namespace {

using Function = std::function<double(const std::vector<double>&)>;

SobolIndices indices_of(std::size_t variables, Distribution distribution, std::uint64_t rows,
                        const Function& f, std::uint64_t seed = 1) {
  std::vector<Variable> all;
  for (std::size_t j = 0; j < variables; ++j) all.push_back({"x", {"x"}, {}, distribution});
  DesignSettings s;
  s.kind = DesignKind::sensitivity;
  s.cases = rows;
  s.seed = seed;
  const Design design(all, s);
  return sobol_indices(variables, rows, [&](std::uint64_t k) { return f(design.values(k)); });
}

double ishigami(const std::vector<double>& x) {
  const double s = std::sin(x[1]);
  return std::sin(x[0]) + 7.0 * s * s + 0.1 * std::pow(x[2], 4) * std::sin(x[0]);
}

// Ishigami, Homma 1990 with a = 7, b = 0.1; the closed forms of the variances: Sobol', Levitan 1999.
TEST(SobolIndices, Ishigami) {
  constexpr double pi = std::numbers::pi, a = 7.0, b = 0.1;
  const double v1 = 0.5 * std::pow(1.0 + b * std::pow(pi, 4) / 5.0, 2);
  const double v2 = a * a / 8.0;
  const double v13 = b * b * std::pow(pi, 8) * (1.0 / 18.0 - 1.0 / 50.0);
  const double v = v1 + v2 + v13;
  const SobolIndices found = indices_of(3, {Distribution::Shape::uniform, -pi, pi}, 4096, ishigami);
  ASSERT_EQ(found.of.size(), 3U);
  EXPECT_NEAR(found.variance, v, 0.02 * v);
  EXPECT_NEAR(found.mean, 0.5 * a, 0.02);
  const double first[] = {v1 / v, v2 / v, 0.0};
  const double total[] = {(v1 + v13) / v, v2 / v, v13 / v};
  for (std::size_t j = 0; j < 3; ++j) {  // within the stated 95 % interval, and this is no empty promise
    EXPECT_NEAR(found.of[j].first, first[j], found.of[j].first_half + 1e-12) << j;
    EXPECT_NEAR(found.of[j].total, total[j], found.of[j].total_half + 1e-12) << j;
    EXPECT_LT(found.of[j].first_half, 0.03);
    EXPECT_LT(found.of[j].total_half, 0.03);
  }
}

// Saltelli, Sobol' 1995: prod (|4x - 2| + a) / (1 + a); V_j = 1 / (3 (1 + a_j)^2).
TEST(SobolIndices, GFunction) {
  const std::vector<double> a{0.0, 1.0, 4.5, 9.0, 99.0, 99.0};
  const auto g = [&](const std::vector<double>& x) {
    double product = 1.0;
    for (std::size_t j = 0; j < a.size(); ++j) product *= (std::abs(4.0 * x[j] - 2.0) + a[j]) / (1.0 + a[j]);
    return product;
  };
  double all = 1.0;
  for (const double one : a) all *= 1.0 + 1.0 / (3.0 * (1.0 + one) * (1.0 + one));
  const double v = all - 1.0;
  const SobolIndices found = indices_of(a.size(), {}, 8192, g);
  for (std::size_t j = 0; j < a.size(); ++j) {
    const double vj = 1.0 / (3.0 * (1.0 + a[j]) * (1.0 + a[j]));
    EXPECT_NEAR(found.of[j].first, vj / v, found.of[j].first_half) << j;
    EXPECT_NEAR(found.of[j].total, vj * (all / (1.0 + vj)) / v, found.of[j].total_half + 1e-9) << j;
  }
}

TEST(SobolIndices, RowsWithAFailedCaseAreDropped) {
  const auto f = [](std::uint64_t k) {
    return k == 5 ? std::nullopt : std::optional(static_cast<double>(k * k % 7));
  };
  const SobolIndices s = sobol_indices(2, 10, f);
  EXPECT_EQ(s.rows, 9U);
  EXPECT_EQ(s.dropped, 1U);
}

// Clopper, Pearson: 0 of n has the upper end 1 - 0.025^(1/n); 8 of 10: 0.4439 to 0.9748 (their table).
TEST(Proportion, KnownIntervals) {
  EXPECT_EQ(proportion_interval(0, 20).low, 0.0);
  EXPECT_NEAR(proportion_interval(0, 20).high, 1.0 - std::pow(0.025, 1.0 / 20.0), 1e-12);
  EXPECT_EQ(proportion_interval(20, 20).high, 1.0);
  EXPECT_NEAR(proportion_interval(8, 10).low, 0.4439, 5e-5);
  EXPECT_NEAR(proportion_interval(8, 10).high, 0.9748, 5e-5);
  EXPECT_EQ(proportion_interval(0, 0).high, 1.0);
}

SubsetSimulation simulated(std::size_t dimension, std::uint64_t cases, std::uint64_t seed,
                           const Function& margin) {
  SubsetSimulation simulation({.dimension = dimension, .cases = cases, .seed = seed});
  while (!simulation.finished()) {
    std::vector<std::optional<double>> margins;
    for (const std::vector<double>& z : simulation.next()) margins.emplace_back(margin(z));
    simulation.tell(margins);
  }
  return simulation;
}

// The sum of d normal numbers over sqrt(d) exceeds 3.7190 with 1e-4, whatever d is.
TEST(Subset, MeanAndScatterOfManyRuns) {
  constexpr double beta = 3.719016485;
  for (const std::size_t d : {2U, 10U}) {
    double sum = 0.0, squares = 0.0, stated = 0.0;
    constexpr int runs = 100;
    for (std::uint64_t seed = 1; seed <= runs; ++seed) {
      const SubsetSimulation s = simulated(d, 1000, seed, [&](const std::vector<double>& z) {
        double total = 0.0;
        for (const double one : z) total += one;
        return total / std::sqrt(static_cast<double>(z.size())) - beta;
      });
      EXPECT_TRUE(s.reached());
      sum += s.probability();
      squares += s.probability() * s.probability();
      stated += s.variation();
      if (seed == 20) {
        EXPECT_NEAR(sum / 20.0, 1e-4, 0.2e-4) << d;
      }
    }
    const double mean = sum / runs;
    const double variation = std::sqrt(squares / runs - mean * mean) / mean;
    // The mean of a hundred is known to 3 %, and the estimate's bias, of the order of a run's variance over
    // four levels, is as much.
    EXPECT_NEAR(mean, 1e-4, 0.12e-4) << d;
    // As stated: 100 runs know their own scatter to a fourteenth; a factor of 1.3 is four times that.
    EXPECT_LT(variation, 1.3 * stated / runs) << d;
    EXPECT_GT(variation, stated / runs / 1.3) << d;
  }
}

TEST(Subset, AnEventThatCannotBeIsNotReached) {
  const SubsetSimulation s =
      simulated(1, 200, 1, [](const std::vector<double>& z) { return std::min(z[0], 2.0) - 3.0; });
  EXPECT_FALSE(s.reached());
  EXPECT_LT(s.probability(), 0.1);
}

TEST(Subset, ACommonEventNeedsOneLevel) {
  const SubsetSimulation s = simulated(3, 2000, 1, [](const std::vector<double>& z) { return z[0]; });
  EXPECT_EQ(s.levels().size(), 1U);
  EXPECT_NEAR(s.probability(), 0.5, 5.0 * std::sqrt(0.25 / 2000.0));
  EXPECT_LT(s.interval().low, s.probability());
  EXPECT_LT(s.interval().high, 0.54);
}

// A margin of two values has no levels: its share of hits counts, and its interval is that of a share.
TEST(Subset, YesOrNoIsCountedAsItIs) {
  const SubsetSimulation some =
      simulated(1, 1000, 1, [](const std::vector<double>& z) { return z[0] > 2.0 ? 0.5 : -0.5; });
  EXPECT_EQ(some.levels().size(), 1U);
  EXPECT_TRUE(some.reached());
  EXPECT_LT(some.interval().low, 0.02275);  // 1 - Phi(2)
  EXPECT_GT(some.interval().high, 0.02275);
  const SubsetSimulation none =
      simulated(1, 1000, 1, [](const std::vector<double>& z) { return z[0] > 5.0 ? 0.5 : -0.5; });
  EXPECT_FALSE(none.reached());
  EXPECT_EQ(none.interval().low, 0.0);
  EXPECT_NEAR(none.interval().high, 1.0 - std::pow(0.025, 1e-3), 1e-9);
}

// A margin in steps: more cases than seeds are beyond a threshold, and those that go on must be drawn from
// all of them.
TEST(Subset, MarginsInStepsAreNotBiased) {
  double sum = 0.0;
  constexpr int runs = 40;
  for (std::uint64_t seed = 1; seed <= runs; ++seed) {
    const SubsetSimulation s = simulated(2, 1000, seed, [](const std::vector<double>& z) {
      return std::floor(2.0 * (z[0] + z[1]) / std::sqrt(2.0)) - 7.0;
    });
    EXPECT_TRUE(s.reached());
    sum += s.probability();
  }
  // 1 - Phi(3.5) = 2.326e-4; a run varies by 0.35, the mean of forty by 0.055.
  EXPECT_NEAR(sum / runs, 2.326e-4, 3.0 * 0.055 * 2.326e-4);
}

}  // namespace
}  // namespace snare::study
