#include "identification/tracing/channels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace snare::identification {
namespace {

/// A channel of hats over 120 readings beside a fit of one slope; the residual has the slope taken out, as a
/// fit has.
struct Example {
  ChannelColumns channel;
  Fit fit;

  explicit Example(const Eigen::VectorXd& readings) {
    const Eigen::Index n = readings.size();
    channel.columns = Eigen::MatrixXd::Zero(n, ChannelColumns::stations);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double at = (ChannelColumns::stations - 1) * static_cast<double>(i) / static_cast<double>(n);
      const auto j = static_cast<Eigen::Index>(at);
      channel.columns(i, j) = 1.0 - (at - static_cast<double>(j));
      channel.columns(i, j + 1) = at - static_cast<double>(j);
    }
    fit.jacobian = Eigen::VectorXd::LinSpaced(n, -1.0, 1.0);
    const Eigen::VectorXd slope = fit.jacobian.col(0);
    fit.residual = readings - slope * slope.dot(readings) / slope.squaredNorm();
  }
};

TEST(Channels, NoiseAloneIsSmallAsOftenAsItShould) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  int below = 0;
  constexpr int trials = 400;
  for (int k = 0; k < trials; ++k) {
    Eigen::VectorXd noise(120);
    for (double& v : noise) v = normal(random);
    const Example e(noise);
    below += channel_p(e.channel, e.fit) < 0.05 ? 1 : 0;
  }
  // Binomial, 20 expected with a deviation of 4.4: three of them.
  EXPECT_NEAR(below, 20, 13);
}

TEST(Channels, ASmoothFunctionIsSeenASlopeThatIsFittedIsNot) {
  std::mt19937 random(12);
  std::normal_distribution<double> normal;
  Eigen::VectorXd wave(120);
  Eigen::VectorXd slope(120);
  for (Eigen::Index i = 0; i < 120; ++i) {
    const double noise = normal(random);
    wave[i] = noise + std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / 120.0);
    slope[i] = noise + 0.2 * (static_cast<double>(i) - 59.5);
  }
  const Example seen(wave);
  const Example fitted(slope);
  // 7.7 sigma in all, of which a test of every smooth shape sees its share.
  EXPECT_LT(channel_p(seen.channel, seen.fit), 1e-3);
  EXPECT_GT(channel_p(fitted.channel, fitted.fit), 0.01);
}

}  // namespace
}  // namespace snare::identification
