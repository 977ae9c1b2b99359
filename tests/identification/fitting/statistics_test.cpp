#include "identification/fitting/statistics.hpp"
#include "identification/fitting/noise.hpp"
#include "tests/support/declared_wire.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace snare::identification {
namespace {

TEST(Statistics, TailsOfTables) {
  EXPECT_NEAR(chi_square_tail(3.841459, 1.0), 0.05, 1e-7);
  EXPECT_NEAR(chi_square_tail(18.307038, 10.0), 0.05, 1e-7);
  EXPECT_EQ(chi_square_tail(0.0, 3.0), 1.0);
  EXPECT_NEAR(normal_tail(1.959964), 0.025, 1e-7);
  EXPECT_NEAR(normal_quantile(0.025), 1.959964, 1e-5);
}

// Equal weights are a scaled chi-square; two pairs of weights have the tail (a e^(-x/2a) - b e^(-x/2b))/(a - b).
TEST(Statistics, TailOfAMixtureOfChiSquares) {
  EXPECT_NEAR(chi_square_mixture_tail(2.0 * 18.307038, Eigen::VectorXd::Constant(10, 2.0)), 0.05, 1e-6);
  const double a = 1.0;
  const double b = 0.2;
  for (const double x : {6.0, 10.0, 14.0}) {
    const double exact = (a * std::exp(-0.5 * x / a) - b * std::exp(-0.5 * x / b)) / (a - b);
    // Moments are matched, the tail is not: the approximation is good to a tenth of P (Liu, Tang and Zhang, Table 1).
    EXPECT_NEAR(chi_square_mixture_tail(x, Eigen::Vector4d(a, a, b, b)), exact, 0.1 * exact) << x;
  }
  EXPECT_EQ(chi_square_mixture_tail(1.0, Eigen::VectorXd::Zero(3)), 1.0);
}

TEST(Statistics, HolmByHand) {
  const std::vector<double> adjusted = holm({0.01, 0.04, 0.03, 0.005});
  EXPECT_DOUBLE_EQ(adjusted[3], 0.02);  // 4 x 0.005
  EXPECT_DOUBLE_EQ(adjusted[0], 0.03);  // 3 x 0.01
  EXPECT_DOUBLE_EQ(adjusted[2], 0.06);  // 2 x 0.03
  EXPECT_DOUBLE_EQ(adjusted[1], 0.06);  // never below the one before
  EXPECT_TRUE(holm({}).empty());
}

// With white noise the p values are uniform: a share of about 5 % is below 0.05; a smooth wave is found at once.
TEST(Statistics, WhitenessTestsHoldTheirLevel) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  int runs = 0;
  int boxes = 0;
  constexpr int trials = 400;
  for (int k = 0; k < trials; ++k) {
    std::vector<Eigen::VectorXd> r(4, Eigen::VectorXd(40));
    for (Eigen::VectorXd& one : r) {
      for (double& v : one) v = normal(random);
    }
    runs += runs_p(r) < 0.05 ? 1 : 0;
    boxes += ljung_box_p(r, 10) < 0.05 ? 1 : 0;
  }
  // Binomial: 20 +- 4.4; the tests are asymptotic, 40 readings a series.
  EXPECT_LT(runs, 40);
  EXPECT_GT(runs, 5);
  EXPECT_LT(boxes, 40);
  EXPECT_GT(boxes, 5);
  Eigen::VectorXd wave(40);
  for (int i = 0; i < 40; ++i) wave[i] = std::sin(0.3 * i) + 0.3 * normal(random);
  EXPECT_LT(runs_p({wave}), 1e-3);
  EXPECT_LT(ljung_box_p({wave}, 10), 1e-6);
}

TEST(Statistics, TooFewOrConstantEntriesSayNothing) {
  EXPECT_EQ(runs_p({Eigen::VectorXd::Constant(3, 1.0)}), 1.0);
  EXPECT_EQ(ljung_box_p({Eigen::VectorXd::Zero(50)}, 10), 1.0);
  EXPECT_LT(runs_p({Eigen::VectorXd::Constant(30, 1.0)}), 1e-3);  // one sign throughout
}

Series record(const std::vector<double>& d, const std::vector<double>& f) {
  Series s;
  s.name = "r";
  s.test = test::declared_wire(65.0 * test::mm, 6.0 * test::mm);
  s.readings = Readings{d, f, {}};
  return s;
}

TEST(Noise, SecondDifferencesSeeThroughASmoothMisfit) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  Eigen::VectorXd r(2000);
  std::vector<double> d, f;
  for (int i = 0; i < 2000; ++i) {
    r[i] = 10.0 * std::sin(i / 200.0) + 0.2 * normal(random);
    d.push_back(1e-6 * i);
    f.push_back(r[i]);
  }
  const Noise noise = noise_from_residuals({record(d, f)}, {r});
  EXPECT_EQ(noise.source, "residual");
  EXPECT_NEAR(noise.sigma[0], 0.2, 0.02);  // 1.5 % standard deviation
}

TEST(Noise, OfReplicatesHasItsIndependentAndItsSmoothPart) {
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  std::vector<Series> series;
  for (int k = 0; k < 8; ++k) {
    std::vector<double> d, f;
    const double a = normal(random);
    const double b = normal(random);
    for (int i = 0; i < 300; ++i) {
      const double u = i / 299.0;
      d.push_back(3e-3 * u);
      f.push_back(5.0 * u * u + 0.3 * (a * std::sin(6.0 * u) + b * std::cos(6.0 * u)) + 0.05 * normal(random));
    }
    series.push_back(record(d, f));
  }
  EXPECT_EQ(replicates(series).size(), 1u);
  const Noise noise = known_noise(series);
  EXPECT_EQ(noise.source, "replicates");
  // Eight specimens: 0.3 and 0.05 to a quarter.
  EXPECT_NEAR(noise.sigma[0], std::hypot(0.3, 0.05), 0.1);
  EXPECT_NEAR(noise.smooth, 0.97, 0.03);
  EXPECT_GT(noise.length, 1e-4);
  // Whitened deviations of a fresh specimen of the same kind are about of unit variance.
  const Eigen::MatrixXd white = noise.whiten(0, Eigen::VectorXd::Constant(300, 0.3));
  EXPECT_LT(white.squaredNorm(), 300.0);  // a shift of all readings is one number, not 300
}

TEST(Noise, DeclaredCountsFirst) {
  Series s = record({0.0, 1e-3, 2e-3}, {0.0, 1.0, 2.0});
  EXPECT_TRUE(known_noise({s}).sigma.empty());
  s.force_sigma = 0.1;
  EXPECT_EQ(known_noise({s, s}).source, "declared");
}

}  // namespace
}  // namespace snare::identification
