#include "identification/fitting/noncentral_chi.hpp"

#include <gtest/gtest.h>
#include <boost/math/distributions/non_central_chi_squared.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace snare::identification {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Of one component |v + e| is |N(m, 1)|. Below 280 with m = 300: log of the normal distribution at -20, by
// Mills' ratio phi(20) / 20 (1 - 1/400 + 3/160000 - ...) (Abramowitz and Stegun 26.2.12), far below what P
// itself can hold to any digit of log(1 - P).
TEST(NoncentralChi, OneComponentIsANormalVariable) {
  const auto upper = [](double x) { return 0.5 * std::erfc(x / std::numbers::sqrt2); };
  EXPECT_NEAR(length_probability(0.5, 1.25, 1.0, 0.0, 0.0).log, std::log(2.0 * (upper(0.5) - upper(1.25))),
              1e-9);
  EXPECT_NEAR(length_probability(3.0, 7.0, 1.0, 4.0, std::log(2.0)).log,
              std::log(upper(0.5) - upper(2.5) + upper(2.5) - upper(4.5)), 1e-7);
  const double x2 = 400.0;
  const double mills = 1.0 - 1.0 / x2 + 3.0 / (x2 * x2) - 15.0 / std::pow(x2, 3) + 105.0 / std::pow(x2, 4);
  const double log_tail =
      -0.5 * x2 - 0.5 * std::log(2.0 * std::numbers::pi) - 0.5 * std::log(x2) + std::log(mills);
  EXPECT_NEAR(length_probability(0.0, 280.0, 1.0, 300.0 * 300.0, 0.0).log, log_tail, 1e-6);
}

TEST(NoncentralChi, ClosedFormsOfTwoAndThreeComponents) {
  // Rayleigh's distribution; its tail at 60 is e^-1800.
  EXPECT_NEAR(length_probability(60.0, infinity, 2.0, 0.0, 0.0).log, -1800.0, 1e-5);
  EXPECT_NEAR(length_probability(1.0, 2.0, 2.0, 0.0, 0.0).log, std::log(std::exp(-0.5) - std::exp(-2.0)),
              1e-9);
  // Three components: f(t) = t / m (phi(t - m) - phi(t + m)).
  for (const double m : {0.3, 4.0, 50.0, 1e4}) {
    for (const double off : {-2.0, 0.0, 3.0}) {
      const double t = std::abs(m + off);
      const double expected = std::log(t / m) - 0.5 * (t - m) * (t - m) -
                              0.5 * std::log(2.0 * std::numbers::pi) + std::log1p(-std::exp(-2.0 * t * m));
      EXPECT_NEAR(log_noncentral_chi(t, 3.0, m), expected, 2e-7)
          << m << " " << t;  // the expansion's stated error
    }
  }
}

// An independent library where it works: its distribution of the square.
TEST(NoncentralChi, AgreesWithTheDistributionOfTheSquare) {
  for (const double k : {2.0, 5.0, 17.0, 97.0}) {
    for (const double m : {0.5, 3.0, 12.0}) {
      const boost::math::non_central_chi_squared square(k, m * m);
      const double at = std::sqrt(k + m * m);
      for (const auto& [a, b] :
           {std::pair{at - 1.0, at - 0.9}, {at - 0.5, at + 2.0}, {std::max(0.0, at - 4.0), at}}) {
        const double p = boost::math::cdf(square, b * b) - boost::math::cdf(square, a * a);
        EXPECT_NEAR(length_probability(0.1 * a, 0.1 * b, k, 0.01 * m * m, std::log(0.1)).log, std::log(p),
                    1e-6)
            << k << " " << m << " " << a;
      }
    }
  }
}

TEST(NoncentralChi, DerivativesMatchDifferences) {
  struct Case {
    double lower, upper, k, square, s;
  };
  for (const Case& c :
       {Case{3.9, 4.0, 17.0, 1.0, 0.1}, Case{0.2, 0.5, 3.0, 4.0, -0.5}, Case{0.0, 2.0, 2.0, 9.0, 0.0},
        Case{50.0, 51.0, 17.0, 1600.0, 0.2}, Case{3.0, infinity, 9.0, 0.5, -1.0}}) {
    const auto at = [&](double dq, double ds) {
      return length_probability(c.lower, c.upper, c.k, c.square + dq, c.s + ds);
    };
    const IntervalProbability p = at(0.0, 0.0);
    const double h = 1e-4;  // error of central differences: h^2 times a third derivative
    const double hq = h * c.square;
    const auto near = [](double found, double expected) {
      EXPECT_NEAR(found, expected, 1e-4 * std::abs(expected) + 1e-5);
    };
    near(p.by_square, (at(hq, 0.0).log - at(-hq, 0.0).log) / (2.0 * hq));
    near(p.by_scale, (at(0.0, h).log - at(0.0, -h).log) / (2.0 * h));
    near(p.by_square_square, (at(hq, 0.0).by_square - at(-hq, 0.0).by_square) / (2.0 * hq));
    near(p.by_square_scale, (at(0.0, h).by_square - at(0.0, -h).by_square) / (2.0 * h));
    near(p.by_scale_scale, (at(0.0, h).by_scale - at(0.0, -h).by_scale) / (2.0 * h));
  }
}

// As sigma goes to nothing or the interval leaves what is likely, the logarithm stays finite.
TEST(NoncentralChi, StaysFiniteInTheTails) {
  for (const double s : {-14.0, -5.0, 0.0, 8.0}) {
    for (const double square : {0.0, 1e-6, 1.0, 1e6}) {
      const IntervalProbability p = length_probability(0.7, 0.71, 17.0, square, s);
      EXPECT_TRUE(std::isfinite(p.log) && std::isfinite(p.by_square) && std::isfinite(p.by_scale))
          << s << " " << square;
      EXPECT_LE(p.log, 0.0);
    }
  }
}

}  // namespace
}  // namespace snare::identification
