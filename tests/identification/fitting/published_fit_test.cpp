#include "identification/fitting/published_fit.hpp"

#include "identification/fitting/noise.hpp"
#include "numerics/dense_solvers.hpp"
#include "tests/support/declared_wire.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace snare::identification {
namespace {

constexpr int readings = 20;
constexpr double range = 4e-3;

std::vector<double> travels() {
  std::vector<double> d;
  for (int i = 0; i < readings; ++i) d.push_back(range * i / (readings - 1));
  return d;
}

/// A curve that is no parabola [N].
double curve(double d, double cubic = 2e8) {
  return 7e5 * d * d + cubic * d * d * d * (1.0 + 50.0 * d);
}

/// The fit that a paper would print of these readings, by least squares on d^2, d, 1.
QuadraticLaw printed(const std::vector<double>& d, const Eigen::VectorXd& y) {
  Eigen::MatrixXd x(readings, 3);
  for (int i = 0; i < readings; ++i) x.row(i) << 1e6 * d[i] * d[i], 1e3 * d[i], 1.0;
  const Eigen::VectorXd c = numerics::full_rank_least_squares(x, y);
  const double lost = (y - x * c).squaredNorm();
  const double all = (y.array() - y.mean()).square().sum();
  return {1e6 * c[0], 1e3 * c[1], c[2], 1.0 - lost / all, range};
}

Series published(const QuadraticLaw& law) {
  Series s;
  s.name = "s";
  s.test = test::declared_wire(65.0 * test::mm, 6.0 * test::mm);
  s.test.travel = travels();
  s.law = law;
  return s;
}

TEST(PublishedFit, TheBasisIsOrthonormalAndHoldsTheQuadratics) {
  const Eigen::MatrixXd q = quadratic_basis(travels());
  EXPECT_LT((q * q.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  Eigen::VectorXd y(readings);
  for (int i = 0; i < readings; ++i) y[i] = 3.0 - 2e3 * travels()[i] + 5e5 * std::pow(travels()[i], 2);
  EXPECT_LT((y - q.transpose() * (q * y)).norm(), 1e-13 * y.norm());
}

// Of readings of a curve, made up with noise and fitted as a paper does, the curve itself leaves a chi2 of 9 coefficients and
// 2 scatters: mean 11, variance somewhat more than 22 since the scatters are estimated from 17 readings each.
TEST(PublishedFit, OfTheTrueCurveChi2IsThatOfNoise) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  const std::vector<double> d = travels();
  std::vector<double> exact;
  for (const double one : d) exact.push_back(curve(one, 1e7));  // 0.03 N rms beside its parabola
  double mean = 0.0;
  double scatter = 0.0;
  int low = 0;
  constexpr int sets = 400;
  for (int k = 0; k < sets; ++k) {
    std::vector<Series> series;
    for (int s = 0; s < 3; ++s) {
      Eigen::VectorXd y(readings);
      for (int i = 0; i < readings; ++i) y[i] = exact[static_cast<std::size_t>(i)] + 0.1 * normal(random);
      series.push_back(published(printed(d, y)));
    }
    const SummaryStatistics found = summary_statistics(series, {exact, exact, exact}, 0);
    EXPECT_EQ(found.dof, 11.0);
    mean += found.chi2 / sets;
    scatter += found.scatter / sets;
    low += found.p < 0.05 ? 1 : 0;
  }
  // 9 times 17/15, since sigma^2 is estimated, and 2: 12.2, to four deviations of the mean.
  EXPECT_NEAR(mean, 12.2, 1.2);
  EXPECT_NEAR(scatter, 0.1, 0.005);  // four deviations: 51 degrees of freedom, 400 sets, and its curvature
  EXPECT_NEAR(low, 20, 18);          // of F: four deviations of 4.4
}

// What a curve has beside a parabola the printed numbers do not contradict.
TEST(PublishedFit, AMisfitOfTheParabolaIsNoResidual) {
  const std::vector<double> d = travels();
  Eigen::VectorXd y(readings);
  std::vector<double> exact;
  for (int i = 0; i < readings; ++i) exact.push_back(y[i] = curve(d[i]));
  const Series s = published(printed(d, y));
  const SummaryStatistics same = summary_statistics({s}, {exact}, 0);
  EXPECT_LT(same.coefficients, 1e-12);
  double parabola = 0.0;
  for (int i = 0; i < readings; ++i) parabola = std::max(parabola, std::abs(s.law->force(d[i]) - exact[i]));
  EXPECT_GT(parabola, 0.5);  // N: it is another curve
  EXPECT_NEAR(same.series[0].computed[0], s.law->a, 1e-9 * s.law->a);
  // Another force is found, in units of the coefficients' deviations.
  std::vector<double> other = exact;
  for (double& f : other) f += 1.0;
  const SummaryStatistics shifted = summary_statistics({s}, {other}, 0);
  EXPECT_NEAR(shifted.series[0].computed[2] - shifted.series[0].published[2], 1.0, 1e-9);
  EXPECT_NEAR(shifted.coefficients, readings / std::pow(shifted.series[0].scatter, 2),
              1e-6 * shifted.coefficients);  // |Q^T 1|^2 = n
}

TEST(PublishedFit, CountsAsThreeNumbers) {
  const Series s = published({7e5, 100.0, 0.1, 0.998, range});
  const Noise noise = declared_noise({s});
  EXPECT_TRUE(noise.summarised(0));
  EXPECT_EQ(noise.rows(0, readings), 3);
  EXPECT_EQ(noise.whiten(0, Eigen::MatrixXd::Ones(readings, 2)).rows(), 3);
}

}  // namespace
}  // namespace snare::identification
