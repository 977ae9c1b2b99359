#include "identification/tracing/model_average.hpp"

#include "identification/effects/catalogue.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace snare::identification {
namespace {

/// A fit of the axial stiffness at `coordinate`, known to `deviation`, that leaves `chi2` of a hundred
/// readings.
Fit fit_at(double coordinate, double deviation, double chi2) {
  Fit f;
  f.settings = {{&parameters().at("wire.axial_stiffness_N"), coordinate}};
  f.free = 1;
  f.covariance = Eigen::MatrixXd::Constant(1, 1, deviation * deviation);
  f.residual = Eigen::VectorXd::Zero(100);
  f.chi2 = chi2;
  return f;
}

TEST(MixtureQuantile, OfOneNormalDistributionIsItsOwn) {
  EXPECT_NEAR(mixture_quantile({{0.3, 5.0, 2.0}}, 0.975), 5.0 + 2.0 * 1.959963985, 1e-7);
  EXPECT_NEAR(mixture_quantile({{0.3, 5.0, 2.0}}, 0.025), 5.0 - 2.0 * 1.959963985, 1e-7);
}

// Two distributions far apart: each end is a quantile of its own part at twice the probability.
TEST(MixtureQuantile, OfTwoFarPartsIsThatOfTheOuterOne) {
  const std::vector<NormalPart> parts{{1.0, -50.0, 1.0}, {1.0, 50.0, 3.0}};
  EXPECT_NEAR(mixture_quantile(parts, 0.025), -50.0 - 1.644853627, 1e-6);
  EXPECT_NEAR(mixture_quantile(parts, 0.975), 50.0 + 3.0 * 1.644853627, 1e-6);
}

// Against draws from the mixture.
TEST(MixtureQuantile, HoldsTheShareThatItSays) {
  const std::vector<NormalPart> parts{{1.0, 0.0, 1.0}, {0.5, 1.5, 0.4}, {0.1, -4.0, 2.0}};
  std::mt19937 random(7);
  std::discrete_distribution<std::size_t> which{1.0, 0.5, 0.1};
  std::normal_distribution<double> normal;
  for (const double p : {0.025, 0.3, 0.975}) {
    const double at = mixture_quantile(parts, p);
    int below = 0;
    constexpr int draws = 200000;
    for (int i = 0; i < draws; ++i) {
      const NormalPart& part = parts[which(random)];
      below += part.mean + part.deviation * normal(random) < at ? 1 : 0;
    }
    EXPECT_NEAR(below / static_cast<double>(draws), p, 4.0 * std::sqrt(p * (1.0 - p) / draws)) << p;
  }
}

TEST(IntervalOverRivals, ReachesToARivalThatDoesAsWell) {
  RoundFits round;
  round.rivals = {fit_at(0.0, 0.1, 90.0), fit_at(1.0, 0.1, 90.0)};
  const auto interval = interval_over_rivals(round.rivals.front(), 0, {round}, 1.0);
  ASSERT_TRUE(interval);
  EXPECT_NEAR(interval->first, -0.1645, 1e-4);
  EXPECT_NEAR(interval->second, 1.1645, 1e-4);
}

// A rival 6 worse in BIC has exp(-3) of the weight: 4.7 %, of which 2.5 % lie beyond the end.
TEST(IntervalOverRivals, WeighsRivalsByTheirLikelihood) {
  RoundFits round;
  round.rivals = {fit_at(0.0, 0.1, 90.0), fit_at(1.0, 0.1, 96.0)};
  const auto near = interval_over_rivals(round.rivals.front(), 0, {round}, 1.0);
  ASSERT_TRUE(near);
  EXPECT_GT(near->second, 0.9);
  EXPECT_LT(near->second, 1.0);
  round.rivals.back().chi2 = 102.0;
  const auto far = interval_over_rivals(round.rivals.front(), 0, {round}, 1.0);
  ASSERT_TRUE(far);
  EXPECT_NEAR(far->second, 0.196, 0.02);
  // Twice the scatter makes the same difference weigh half.
  const auto scattered = interval_over_rivals(round.rivals.front(), 0, {round}, 2.0);
  ASSERT_TRUE(scattered);
  EXPECT_NEAR(scattered->second, near->second, 1e-9);
}

// Of two effects, rivals of the first one were fitted before the second was added: they move the number by as
// much.
TEST(IntervalOverRivals, RivalsOfAnEarlierEffectMoveTheNumberFromWhereItIs) {
  RoundFits first, second;
  first.rivals = {fit_at(0.3, 0.2, 90.0), fit_at(0.8, 0.2, 90.0)};
  second.rivals = {fit_at(0.0, 0.1, 60.0)};
  const auto interval = interval_over_rivals(second.rivals.front(), 0, {first, second}, 1.0);
  ASSERT_TRUE(interval);
  EXPECT_NEAR(interval->first, -0.1645, 1e-4);
  EXPECT_NEAR(interval->second, 0.6645, 1e-4);
}

TEST(IntervalOverRivals, IsAbsentWithoutARivalOrAWidth) {
  RoundFits round;
  round.rivals = {fit_at(0.0, 0.1, 90.0)};
  EXPECT_FALSE(interval_over_rivals(round.rivals.front(), 0, {round}, 1.0));
  round.rivals = {fit_at(0.0, 0.0, 90.0), fit_at(1.0, 0.1, 90.0)};
  EXPECT_FALSE(interval_over_rivals(round.rivals.front(), 0, {round}, 1.0));
}

/// An effect that was asked for, of z standard deviations, which moves the number by `shift` a standard
/// deviation.
Candidate asked(double z, double shift) {
  Candidate c;
  c.score.z = z;
  c.score.shift = Eigen::VectorXd::Constant(1, shift);
  c.score.effect = find_effect("span");
  return c;
}

TEST(IntervalOverCandidates, IsHardlyWiderWhereNoEffectIsSeen) {
  const Fit base = fit_at(0.0, 0.1, 90.0);
  const auto interval = interval_over_candidates(base, 0, {asked(0.5, 0.05), asked(1.0, 0.1)});
  ASSERT_TRUE(interval);
  EXPECT_NEAR(interval->first, -0.196, 0.01);
  EXPECT_GT(interval->second, 0.196);
  EXPECT_LT(interval->second, 0.25);
}

// Of three standard deviations, and alone: exp((9 - ln 100)/2) = 9 times as likely as none, the number then
// 0.9 higher.
TEST(IntervalOverCandidates, ReachesToWhereAnEffectThatMayBeMissingWouldMoveTheNumber) {
  const Fit base = fit_at(0.0, 0.1, 90.0);
  const auto interval = interval_over_candidates(base, 0, {asked(3.0, 0.3)});
  ASSERT_TRUE(interval);
  const double weight = std::exp(0.5 * (9.0 - std::log(100.0)));
  const double deviation = std::hypot(0.1, 0.3);
  EXPECT_NEAR(interval->second, mixture_quantile({{1.0, 0.0, 0.1}, {weight, 0.9, deviation}}, 0.975), 1e-9);
  EXPECT_GT(interval->second, 1.4);
  EXPECT_GT(interval->first, -0.2);
}

TEST(IntervalOverCandidates, IsAbsentWhereNoEffectCouldBeSeen) {
  EXPECT_FALSE(interval_over_candidates(fit_at(0.0, 0.1, 90.0), 0, {Candidate{}}));
}

}  // namespace
}  // namespace snare::identification
