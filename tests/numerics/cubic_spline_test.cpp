#include "numerics/cubic_spline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace snare::numerics {
namespace {

// Not-a-knot splines reproduce cubics, to round-off over the smallest cell.
TEST(CubicSpline, ReproducesCubics) {
  const std::vector<double> x{0.0, 0.1, 0.35, 0.5, 1.2, 1.3};
  const auto f = [](double t) { return 1.0 - 2.0 * t + 0.5 * t * t + 3.0 * t * t * t; };
  std::vector<double> v;
  for (const double t : x) v.push_back(f(t));
  const HermiteCurve curve(x, v);
  for (int i = 0; i <= 100; ++i) {
    const double t = 0.013 * i;
    EXPECT_NEAR(curve.value(t), f(t), 1e-12);
    EXPECT_NEAR(curve.slope(t), -2.0 + t + 9.0 * t * t, 1e-11);
    EXPECT_NEAR(curve.integral(t), t - t * t + t * t * t / 6.0 + 0.75 * t * t * t * t, 1e-12);
  }
}

// Fourth order: halving the cells divides the error by 16; 13 leaves room for the ends.
TEST(CubicSpline, ConvergesAtFourthOrder) {
  const auto error = [](int n) {
    std::vector<double> x, v;
    for (int i = 0; i <= n; ++i) {
      x.push_back(static_cast<double>(i) / n);
      v.push_back(std::exp(2.0 * x.back()));
    }
    const HermiteCurve curve(x, v);
    double worst = 0.0;
    for (int i = 0; i <= 1000; ++i) {
      const double t = 1e-3 * i;
      worst = std::max(worst, std::abs(curve.value(t) - std::exp(2.0 * t)));
    }
    return worst;
  };
  EXPECT_GT(error(10) / error(20), 13.0);
}

// Widths of which the reciprocals are no numbers: said, where solving went astray.
TEST(CubicSpline, KnotsThatRoundingsDoNotTellApartAreRefused) {
  const std::vector<double> knots{0.0, 1e-310, 2e-310, 3e-310, 4e-310}, values(5, 1.0);
  EXPECT_THROW(HermiteCurve(knots, values), std::domain_error);
}

}  // namespace
}  // namespace snare::numerics
