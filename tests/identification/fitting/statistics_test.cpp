#include "identification/fitting/statistics.hpp"
#include "identification/fitting/noise.hpp"
#include "identification/fitting/prediction.hpp"
#include "tests/support/declared_wire.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace snare::identification {
namespace {

TEST(Statistics, TailsOfTables) {
  EXPECT_NEAR(chi_square_tail(3.841459, 1.0), 0.05, 1e-7);
  EXPECT_NEAR(chi_square_tail(18.307038, 10.0), 0.05, 1e-7);
  EXPECT_EQ(chi_square_tail(0.0, 3.0), 1.0);
  EXPECT_EQ(chi_square_tail(std::numeric_limits<double>::infinity(), 3.0), 0.0);
  EXPECT_NEAR(normal_tail(1.959964), 0.025, 1e-7);
  EXPECT_NEAR(normal_quantile(0.025), 1.959964, 1e-5);
}

// Equal weights are a scaled chi-square; two pairs of weights have the tail (a e^(-x/2a) - b e^(-x/2b))/(a -
// b).
TEST(Statistics, TailOfAMixtureOfChiSquares) {
  EXPECT_NEAR(chi_square_mixture_tail(2.0 * 18.307038, Eigen::VectorXd::Constant(10, 2.0)), 0.05, 1e-6);
  const double a = 1.0;
  const double b = 0.2;
  for (const double x : {6.0, 10.0, 14.0}) {
    const double exact = (a * std::exp(-0.5 * x / a) - b * std::exp(-0.5 * x / b)) / (a - b);
    // Moments are matched, the tail is not: the approximation is good to a tenth of P (Liu, Tang and Zhang,
    // Table 1).
    EXPECT_NEAR(chi_square_mixture_tail(x, Eigen::Vector4d(a, a, b, b)), exact, 0.1 * exact) << x;
  }
  EXPECT_EQ(chi_square_mixture_tail(1.0, Eigen::VectorXd::Zero(3)), 1.0);
}

TEST(Statistics, TailsOfStudentAndFisherOfTables) {
  EXPECT_NEAR(student_tail(2.570582, 5.0), 0.025, 1e-7);
  EXPECT_NEAR(student_tail(1.959964, std::numeric_limits<double>::infinity()), 0.025, 1e-7);
  EXPECT_NEAR(fisher_tail(5.409451, 3.0, 5.0), 0.05, 1e-6);
  EXPECT_NEAR(fisher_tail(18.307038 / 10.0, 10.0, std::numeric_limits<double>::infinity()), 0.05, 1e-7);
}

// By simulation: of F seen with the noncentrality l the bound lies above l in 95 % of cases.
TEST(Statistics, TheBoundOfANoncentralityHolds) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  for (const double below : {6.0, std::numeric_limits<double>::infinity()}) {
    std::chi_squared_distribution<double> variance(std::isfinite(below) ? below : 1.0);
    int held = 0;
    constexpr int trials = 1000;
    for (int k = 0; k < trials; ++k) {
      double q = std::pow(normal(random) + 4.0, 2);
      for (int i = 1; i < 8; ++i) q += std::pow(normal(random), 2);
      const double scale = std::isfinite(below) ? variance(random) / below : 1.0;
      held += noncentrality_upper(q / 8.0 / scale, 8.0, below, 0.95) >= 16.0 ? 1 : 0;
    }
    EXPECT_NEAR(held, 950, 28);  // four deviations of 6.9
  }
  EXPECT_EQ(noncentrality_upper(0.01, 8.0, 100.0, 0.95), 0.0);
}

TEST(Statistics, HolmByHand) {
  const std::vector<double> adjusted = holm({0.01, 0.04, 0.03, 0.005});
  EXPECT_DOUBLE_EQ(adjusted[3], 0.02);  // 4 x 0.005
  EXPECT_DOUBLE_EQ(adjusted[0], 0.03);  // 3 x 0.01
  EXPECT_DOUBLE_EQ(adjusted[2], 0.06);  // 2 x 0.03
  EXPECT_DOUBLE_EQ(adjusted[1], 0.06);  // never below the one before
  EXPECT_TRUE(holm({}).empty());
}

// With white noise the p values are uniform: a share of about 5 % is below 0.05; a smooth wave is found at
// once.
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
  const Noise noise = noise_from_residuals({record(d, f)}, {r}, {Eigen::VectorXd::Zero(2000)});
  EXPECT_EQ(noise.source, "residual");
  EXPECT_NEAR(noise.sigma[0], 0.2, 0.02);  // 1.5 % standard deviation
  EXPECT_NEAR(noise.dof, 18.0 / 35.0 * 1998.0, 1.0);
}

/// Six replicates of a curve to peak travels up to 5 % apart: smooth deviations of `smooth` [N], sums of four
/// waves with random phases, and independent ones of `white` [N].
struct Replicates {
  std::vector<Series> series;
  std::vector<Eigen::VectorXd> residuals, computed;
};
Replicates replicates_of(unsigned seed, double smooth, double white, int readings) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  Replicates result;
  for (int k = 0; k < 6; ++k) {
    const double peak = 3e-3 * (1.0 - 0.05 * uniform(random));
    std::vector<double> d, f;
    Eigen::VectorXd r(readings);
    Eigen::VectorXd computed(readings);
    double waves[4][2];
    for (auto& wave : waves) wave[0] = normal(random), wave[1] = normal(random);
    for (int i = 0; i < readings; ++i) {
      const double u = peak * i / (readings - 1);
      double state = 0.0;
      for (int j = 0; j < 4; ++j) {
        const double phase = (1.0 + 1.5 * j) * u / 3e-3;
        state += 0.5 * (waves[j][0] * std::cos(phase) + waves[j][1] * std::sin(phase));
      }
      computed[i] = 5e6 * u * u;
      r[i] = smooth * state + white * normal(random);
      d.push_back(u);
      f.push_back(computed[i] + r[i]);
    }
    result.series.push_back(record(d, f));
    result.residuals.push_back(r);
    result.computed.push_back(computed);
  }
  return result;
}

// Six draws of a smooth process have some 5 x 3 degrees of freedom: 20 % of sigma is 1.1 deviations of one
// set's estimate, so that the mean of many sets is looked at beside most of them.
TEST(Noise, OfReplicatesWithPeakTravelsApart) {
  double mean = 0.0;
  double independent = 0.0;
  int near = 0;
  constexpr int sets = 40;
  for (unsigned seed = 1; seed <= sets; ++seed) {
    const Replicates r = replicates_of(seed, 0.3, 0.05, 150);
    const Noise noise = noise_from_residuals(r.series, r.residuals, r.computed);
    ASSERT_EQ(noise.source, "replicates");
    const double ratio = noise.sigma[0] / std::hypot(0.3, 0.05);
    mean += ratio / sets;
    independent += noise.sigma[0] * std::sqrt(1.0 - noise.smooth) / 0.05 / sets;
    near += std::abs(ratio - 1.0) < 0.2 ? 1 : 0;
    EXPECT_LT(noise.dof, 60.0);
  }
  EXPECT_NEAR(mean, 1.0, 0.08);         // its own standard deviation 0.03; the shape of the process is known
  EXPECT_NEAR(independent, 1.0, 0.05);  // from 900 readings a set
  EXPECT_GE(near, 26);                  // two of three: 1.1 deviations and their scatter over 40 sets
}

// Of six readings each too, where the information of the readings allows a fifth in two of three sets.
TEST(Noise, OfReplicatesWithFewReadings) {
  double mean = 0.0;
  int near = 0;
  constexpr int sets = 60;
  for (unsigned seed = 1; seed <= sets; ++seed) {
    const Replicates r = replicates_of(seed, 0.3, 0.05, 6);
    const Noise noise = noise_from_residuals(r.series, r.residuals, r.computed);
    ASSERT_EQ(noise.source, "replicates");
    const double ratio = noise.sigma[0] / std::hypot(0.3, 0.05);
    mean += ratio / sets;
    near += std::abs(ratio - 1.0) < 0.2 ? 1 : 0;
  }
  EXPECT_NEAR(mean, 1.0, 0.1);
  EXPECT_GE(near, 33);
}

TEST(Noise, OfReplicatesWithoutASmoothPartIsWhite) {
  const Replicates r = replicates_of(3, 0.0, 0.05, 60);
  const Noise noise = noise_from_residuals(r.series, r.residuals, r.computed);
  EXPECT_EQ(noise.source, "replicates");
  EXPECT_TRUE(noise.filter.empty());
  EXPECT_NEAR(noise.sigma[0], 0.05, 0.005);  // 300 degrees of freedom: 4 %
}

// L^-1 V L^-T = I, V from the definition and the inverse factor by whitening the unit vectors.
TEST(Noise, TheFilterWhitensItsCovariance) {
  constexpr int n = 12;
  std::vector<double> d, height;
  for (int i = 0; i < n; ++i) {
    d.push_back(i < 8 ? 1e-3 * i * i : 1e-3 * (100.0 - 6.0 * i));  // forth and back
    height.push_back(0.1 + 0.05 * i);
  }
  const Series s = record(d, std::vector<double>(n, 0.0));
  Noise noise;
  noise.filter = {noise_filter(measured_displacement(s), 0.2, 0.03, height)};
  const Eigen::MatrixXd inverse = noise.whiten(0, Eigen::MatrixXd::Identity(n, n));
  Eigen::MatrixXd covariance(n, n);
  std::vector<double> path(n, 0.0);
  for (int i = 1; i < n; ++i) path[i] = path[i - 1] + std::abs(d[i] - d[i - 1]);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      covariance(i, j) =
          height[i] * height[j] * std::exp(-std::abs(path[i] - path[j]) / 0.03) + (i == j ? 0.04 : 0.0);
    }
  }
  EXPECT_LT((inverse * covariance * inverse.transpose() - Eigen::MatrixXd::Identity(n, n)).norm(),
            1e-12);  // roundings
}

TEST(Noise, DeclaredCountsFirst) {
  Series s = record({0.0, 1e-3, 2e-3}, {0.0, 1.0, 2.0});
  EXPECT_TRUE(declared_noise({s}).sigma.empty());
  s.force_sigma = 0.1;
  EXPECT_EQ(declared_noise({s, s}).source, "declared");
}

}  // namespace
}  // namespace snare::identification
