#include "study/design.hpp"

#include "study/random_access.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace snare::study {
namespace {

Variable uniform(const char* name) {
  return {name, {name}, {}, {}};
}

DesignSettings settings(DesignKind kind, std::uint64_t cases) {
  DesignSettings s;
  s.kind = kind;
  s.cases = cases;
  s.seed = 7;
  return s;
}

TEST(Permutation, IsOneOfAnySize) {
  for (const std::uint64_t size : {1U, 2U, 3U, 7U, 100U, 1025U}) {
    const KeyedPermutation p(3, 1, size);
    std::set<std::uint64_t> seen;
    for (std::uint64_t i = 0; i < size; ++i) {
      EXPECT_LT(p(i), size);
      seen.insert(p(i));
    }
    EXPECT_EQ(seen.size(), size);
  }
}

// The mean of n independent uniform numbers has a standard deviation of 1 / sqrt(12 n); five of them are
// allowed.
TEST(Permutation, HashedNumbersAreUniform) {
  constexpr int n = 100000;
  double sum = 0.0;
  double squares = 0.0;
  double product = 0.0;
  for (std::uint64_t i = 0; i < n; ++i) {
    const double u = hashed_uniform(1, 0, i) - 0.5;
    sum += u;
    squares += u * u;
    product += u * (hashed_uniform(1, 1, i) - 0.5);
  }
  EXPECT_NEAR(sum / n, 0.0, 5.0 / std::sqrt(12.0 * n));
  EXPECT_NEAR(squares / n, 1.0 / 12.0, 5.0 / std::sqrt(180.0 * n));  // variance of u^2: 1/80 - 1/144 = 1/180
  EXPECT_NEAR(product / n, 0.0, 5.0 / (12.0 * std::sqrt(1.0 * n)));
}

TEST(Design, GridHasEveryCombinationOnceTheLastFastest) {
  Variable a{"a", {"a"}, {"1", "2", "3"}, {}};
  Variable b{"b", {"b"}, {"\"x\"", "\"y\""}, {}};
  const Design design({a, b}, settings(DesignKind::grid, 0));
  ASSERT_EQ(design.count(), 6U);
  std::vector<std::string> all;
  for (std::uint64_t k = 0; k < 6; ++k) {
    const std::vector<double> row = design.values(k);
    all.push_back(literal(a, row[0]) + literal(b, row[1]));
  }
  EXPECT_EQ(all, (std::vector<std::string>{"1\"x\"", "1\"y\"", "2\"x\"", "2\"y\"", "3\"x\"", "3\"y\""}));
}

TEST(Design, HypercubeHasOneCaseInEverySlice) {
  constexpr std::uint64_t n = 57;
  const Design design({uniform("a"), uniform("b")}, settings(DesignKind::latin_hypercube, n));
  for (std::size_t j = 0; j < 2; ++j) {
    std::set<int> slices;
    for (std::uint64_t k = 0; k < n; ++k) slices.insert(static_cast<int>(design.values(k)[j] * n));
    EXPECT_EQ(slices.size(), n);
  }
}

// Property A of Sobol's sequence holds for a digital shift, too: of the first 2^d points of d dimensions one
// is in each of the 2^d boxes that halve every axis, and of the first 2^k each of the 2^k slices of an axis
// has one.
TEST(Design, SobolPointsFillSlicesAndBoxes) {
  const Design design({uniform("a"), uniform("b"), uniform("c")}, settings(DesignKind::sobol, 1024));
  std::vector<std::set<int>> slices(3);
  std::set<int> boxes;
  // The sequence leaves out its first point, 0, so a block of 2^k is one from 2^k - 1 on.
  for (std::uint64_t k = 255; k < 511; ++k) {
    const std::vector<double> u = design.values(k);
    for (std::size_t j = 0; j < 3; ++j) slices[j].insert(static_cast<int>(u[j] * 256.0));
  }
  for (const std::set<int>& s : slices) EXPECT_EQ(s.size(), 256U);
  for (std::uint64_t k = 7; k < 15; ++k) {
    const std::vector<double> u = design.values(k);
    boxes.insert((u[0] > 0.5 ? 1 : 0) + (u[1] > 0.5 ? 2 : 0) + (u[2] > 0.5 ? 4 : 0));
  }
  EXPECT_EQ(boxes.size(), 8U);
}

TEST(Design, ACaseDoesNotDependOnTheOthersAskedFor) {
  const Design one({uniform("a"), uniform("b")}, settings(DesignKind::sobol, 1000));
  const Design other({uniform("a"), uniform("b")}, settings(DesignKind::sobol, 1000));
  const std::vector<double> late = one.values(999);
  for (std::uint64_t k = 0; k < 1000; ++k) static_cast<void>(other.values(k));
  EXPECT_EQ(late, other.values(999));
}

TEST(Design, SensitivityRowsSwapOneColumn) {
  const Design design({uniform("a"), uniform("b")}, settings(DesignKind::sensitivity, 8));
  ASSERT_EQ(design.count(), 32U);
  for (std::uint64_t i = 0; i < 8; ++i) {
    const auto a = design.values(4 * i), b = design.values(4 * i + 1);
    const auto first = design.values(4 * i + 2), second = design.values(4 * i + 3);
    EXPECT_EQ(first, (std::vector<double>{b[0], a[1]}));
    EXPECT_EQ(second, (std::vector<double>{a[0], b[1]}));
  }
}

// Normal variables with a normal copula are correlated as declared; the estimate scatters by (1 - r^2) /
// sqrt(n).
TEST(Design, CorrelationIsThatDeclared) {
  constexpr std::uint64_t n = 20000;
  constexpr double r = -0.7;
  Variable a = uniform("a"), b = uniform("b");
  a.distribution = {Distribution::Shape::normal, 3.0, 2.0};
  b.distribution = {Distribution::Shape::normal, -1.0, 0.1};
  DesignSettings s = settings(DesignKind::latin_hypercube, n);
  s.correlation = Eigen::MatrixXd{{1.0, r}, {r, 1.0}};
  const Design design({a, b}, s);
  double aa = 0.0, bb = 0.0, ab = 0.0;
  for (std::uint64_t k = 0; k < n; ++k) {
    const std::vector<double> x = design.values(k);
    const double u = (x[0] - 3.0) / 2.0, v = (x[1] + 1.0) / 0.1;
    aa += u * u;
    bb += v * v;
    ab += u * v;
  }
  EXPECT_NEAR(ab / std::sqrt(aa * bb), r, 5.0 * (1.0 - r * r) / std::sqrt(1.0 * n));
  EXPECT_NEAR(aa / n, 1.0, 0.05);
}

TEST(Design, ContradictingCorrelationsAreNone) {
  EXPECT_TRUE(is_correlation(Eigen::MatrixXd{{1.0, 0.9}, {0.9, 1.0}}));
  EXPECT_FALSE(is_correlation(Eigen::MatrixXd{{1.0, 0.9, 0.9}, {0.9, 1.0, -0.9}, {0.9, -0.9, 1.0}}));
  EXPECT_FALSE(is_correlation(Eigen::MatrixXd{{1.0, 0.9}, {0.8, 1.0}}));
  EXPECT_TRUE(is_correlation(Eigen::MatrixXd(0, 0)));
}

// The distribution function undoes the quantile, cut or not; its derivative's integral is what quantiles of a
// table say.
TEST(Distribution, QuantileAndProbabilityAreInverse) {
  const Distribution all[] = {{Distribution::Shape::uniform, -2.0, 5.0},
                              {Distribution::Shape::normal, 1.0, 0.5},
                              {Distribution::Shape::normal, 1.0, 0.5, 0.0, 0.9, 1.6},
                              {Distribution::Shape::lognormal, 0.3, 0.2},
                              {Distribution::Shape::triangular, 0.0, 3.0, 1.0},
                              {Distribution::Shape::triangular, 0.0, 3.0, 1.0, 0.5, 2.0}};
  for (const Distribution& d : all) {
    for (const double p : {1e-6, 0.01, 0.3, 0.5, 0.9, 1.0 - 1e-6}) {
      const double x = quantile(d, p);
      EXPECT_GE(x, d.lower);
      EXPECT_LE(x, d.upper);
      EXPECT_NEAR(probability_below(d, x), p, 1e-9);  // roundings of x, amplified by the density
    }
  }
}

// Abramowitz, Stegun 1964, table 26.1: P(1) = 0.84134 47461; the triangle by its area.
TEST(Distribution, KnownValues) {
  EXPECT_NEAR(normal_probability(1.0), 0.8413447461, 1e-10);
  EXPECT_NEAR(normal_quantile(0.975), 1.9599639845, 1e-10);
  EXPECT_NEAR(quantile({Distribution::Shape::triangular, 0.0, 3.0, 1.0}, 1.0 / 3.0), 1.0, 1e-12);
  EXPECT_NEAR(quantile({Distribution::Shape::lognormal, 0.0, 1.0}, normal_probability(1.0)), std::exp(1.0),
              1e-12);
}

}  // namespace
}  // namespace snare::study
