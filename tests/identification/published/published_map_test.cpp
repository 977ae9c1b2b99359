// The evidence of published fits: integrals over numbers, zeros, ranges and numbers of readings.

#include "identification/published/published_map.hpp"

#include "identification/effects/catalogue.hpp"
#include "identification/published/curve_likelihood.hpp"
#include "identification/published/importance_sampling.hpp"
#include "identification/published/range_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <random>

namespace snare::identification {
namespace {

using Eigen::VectorXd;

TouchCurve cubic(double k, double a) {
  std::vector<double> travel, force;
  for (int i = 0; i <= 200; ++i) {
    const double d = 1e-4 * i;
    travel.push_back(d);
    force.push_back(k * d + a * d * d * d);
  }
  return {numerics::HermiteCurve(travel, force), travel.back()};
}

TEST(ImportanceSampling, FindsANarrowPeak) {
  for (const Eigen::Index n : {1, 2, 3}) {
    const double width = 0.004;
    const auto peak = [&](const std::vector<VectorXd>& points) {
      std::vector<double> log;
      for (const VectorXd& u : points)
        log.push_back(-0.5 * (u.array() - 0.37).square().sum() / (width * width) -
                      static_cast<double>(n) * std::log(width * std::sqrt(2.0 * std::numbers::pi)));
      return log;
    };
    const int count = static_cast<int>(n);
    ImportanceSampler sampler(n, 24 * count, peak);
    for (int b = 0; b < 6; ++b) sampler.add_batch(64 * count);
    EXPECT_NEAR(sampler.log_integral(), 0.0, 3.0 / std::sqrt(sampler.effective())) << n;
    EXPECT_GT(sampler.effective(), 100.0) << n;
  }
}

// Heights of the paper's geometric limit: 17.89, 20.40, 21.06 mm.
TEST(FitRanges, EndWhereTheWireIsTaut) {
  const Experiment e =
      read_experiment(SNARE_SOURCE_DIR "/data/experiments/published_static.toml", parameters());
  const FitRanges ranges = fit_ranges(e, {});
  double all[2] = {0.0, 0.0};
  for (std::size_t r = 0; r < ranges.ranges().size(); ++r)
    for (int prior = 0; prior < 2; ++prior)
      all[prior] += ranges.mass(r, prior == 1) * static_cast<double>(ranges.readings().size());
  EXPECT_NEAR(all[0], 1.0, 1e-12);
  EXPECT_NEAR(all[1], 1.0, 1e-12);
  const FitRange& chord = ranges.ranges().back();
  ASSERT_EQ(chord.kind, FitRange::Kind::taut_from_chord);
  EXPECT_NEAR(chord.to[0], 17.89e-3, 0.01e-3);
  EXPECT_NEAR(chord.to[1], 20.40e-3, 0.01e-3);
  EXPECT_NEAR(chord.to[2], 21.06e-3, 0.01e-3);
  EXPECT_NEAR(ranges.longest(), 21.06e-3, 0.01e-3);
}

// By a fine sum over the zero.
TEST(CurveLikelihood, IntegratesTheZeroOut) {
  const TouchCurve curve = cubic(2000.0, 4e7);
  const QuadraticLaw law{4.0e5, 1500.0, -0.2, 0.9985, 6e-3, 4};
  const FitCell cell = fit_cell(law, 6e-3, 13);
  for (const double shift : {-0.5, 0.0, 1.0}) {
    const Eigen::ArrayXd log_sigma = Eigen::ArrayXd::Constant(1, cell.log_scatter + shift);
    const double sigma = std::exp(log_sigma[0]);
    std::vector<double> terms;
    constexpr int count = 40000;
    for (int i = 0; i < count; ++i) {
      const double z = -largest_zero + 2.0 * largest_zero * (i + 0.5) / count;
      Eigen::VectorXd force(13);
      for (int j = 0; j < 13; ++j)
        force[j] = curve.force.value(std::max(0.0, cell.travel[static_cast<std::size_t>(j)] - z));
      const Eigen::Vector3d b = cell.basis * force;
      terms.push_back(-0.5 * (cell.numbers.coefficients - b).squaredNorm() / (sigma * sigma) -
                      3.0 * log_sigma[0] +
                      length_probability(cell.numbers.lower, cell.numbers.upper, 10.0,
                                         force.squaredNorm() - b.squaredNorm(), log_sigma[0])
                          .log);
    }
    const double expected =
        log_sum(terms) - std::log(count) + cell.log_scale - 1.5 * std::log(2.0 * std::numbers::pi);
    EXPECT_NEAR(log_likelihoods(cell, curve, best_zero(cell, curve), log_sigma)[0], expected, 0.02) << shift;
  }
}

// The search for a zero from an estimate finds the one of the search everywhere, and no integral is above its
// bound.
TEST(CurveLikelihood, FindsTheZeroBesideAnEstimate) {
  const TouchCurve curve = cubic(2000.0, 4e7);
  for (const int readings : {6, 13, 68}) {
    const FitCell cell = fit_cell({4.0e5, 1500.0, -0.2, 0.9985, 6e-3, 4}, 6e-3, readings);
    const double zero = best_zero(cell, curve);
    for (const double off : {-4e-4, 1e-4, 3e-4})
      EXPECT_NEAR(best_zero(cell, curve, zero + off), zero, 2e-7) << off;
    const Eigen::ArrayXd log_sigma = cell.log_scatter + Eigen::ArrayXd::LinSpaced(5, -1.0, 1.0);
    const Eigen::ArrayXd most = most_likelihoods(cell, curve, zero, log_sigma);
    EXPECT_TRUE((log_likelihoods(cell, curve, zero, log_sigma) <= most).all());
  }
}

// The mean of p(numbers | another range and count) / p(numbers | theirs) is one: densities of the printed
// numbers, whatever they rest on.
TEST(CurveLikelihood, IsADensityOfThePrintedNumbers) {
  const TouchCurve curve = cubic(2000.0, 4e7);
  const double sigma = 0.8;
  const Eigen::ArrayXd log_sigma = Eigen::ArrayXd::Constant(1, std::log(sigma));
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0.0, sigma);
  std::uniform_real_distribution<double> zero(-largest_zero, largest_zero);
  double sum = 0.0, squares = 0.0;
  constexpr int sets = 1500;
  for (int s = 0; s < sets; ++s) {
    const double z = zero(random);
    std::vector<double> travel;
    VectorXd force(20);
    for (int i = 0; i < 20; ++i) {
      travel.push_back(8e-3 * i / 19);
      force[i] = curve.force.value(std::max(0.0, travel.back() - z)) + noise(random);
    }
    const QuadraticLaw law = printed_law(travel, force, 3);
    if (!(law.r_squared > 0.0)) continue;
    const auto log_of = [&](const FitCell& cell) {
      return log_likelihoods(cell, curve, best_zero(cell, curve), log_sigma)[0];
    };
    const double own = log_of(fit_cell(law, 8e-3, 20)), other = log_of(fit_cell(law, 8.2e-3, 18));
    const double ratio = std::exp(other - own);
    sum += ratio;
    squares += ratio * ratio;
  }
  const double mean = sum / sets, error = std::sqrt((squares / sets - mean * mean) / sets);
  EXPECT_LT(error, 0.06);
  EXPECT_NEAR(mean, 1.0, 3.0 * error);
}

QuadraticLaw law_of(const TouchCurve& curve, double to, int readings, double sigma, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, sigma);
  std::vector<double> travel;
  VectorXd force(readings);
  for (int i = 0; i < readings; ++i) {
    travel.push_back(to * i / (readings - 1));
    force[i] = curve.force.value(travel.back()) + noise(random);
  }
  return printed_law(travel, force, 4);
}

// The profile of own ranges is a fine sum over the range of each series and over all scatters.
TEST(RangeProfile, OwnRangesAreAMeanOverEach) {
  Experiment e = read_experiment(SNARE_SOURCE_DIR "/data/experiments/published_static.toml", parameters());
  e.series.pop_back();
  const std::vector<TouchCurve> curves{cubic(2000.0, 4e7), cubic(3000.0, 3e7)};
  const double to[] = {5e-3, 9e-3};
  constexpr double sigma = 0.1;
  for (std::size_t k = 0; k < 2; ++k)
    e.series[k].law = law_of(curves[k], to[k], 13, sigma, static_cast<unsigned>(k + 1));
  FitRanges::Options options;
  options.bins = 6;
  options.readings = {13};
  const FitRanges ranges(e.series, {0.0, 0.0}, options);
  const RangeProfile profile = range_profile(ranges, curves, impossible);

  constexpr int count = 1500;
  std::vector<std::map<long, std::vector<double>>> terms[2] = {{{}, {}}, {{}, {}}};  // by prior, then series
  for (std::size_t k = 0; k < 2; ++k) {
    for (int i = 0; i < count; ++i) {
      const double u = (i + 0.5) / count;
      const double at[] = {options.least * std::pow(options.most / options.least, u),
                           options.least + (options.most - options.least) * u};
      for (std::size_t prior = 0; prior < 2; ++prior) {
        std::vector<std::optional<double>> zero(1);
        const ByScatter all =
            by_scatter(ranges.single()[k].at({at[prior]}), 0, {curves[k]}, zero, impossible);
        for (Eigen::Index s = 0; s < all.log.size(); ++s)
          terms[prior][k][std::lround(all.log_sigma[s] / scatter_step)].push_back(all.log[s]);
      }
    }
  }
  for (std::size_t prior = 0; prior < 2; ++prior) {
    std::vector<double> sums;
    for (const auto& [scatter, some] : terms[prior][0])
      if (const auto other = terms[prior][1].find(scatter); other != terms[prior][1].end())
        sums.push_back(log_sum(some) + log_sum(other->second) - 2.0 * std::log(count));
    EXPECT_NEAR(profile.log[ranges.bins() + prior], log_sum(sums) + std::log(scatter_step), 0.15) << prior;
  }
  // Common ranges cannot be both.
  for (std::size_t r = 0; r < ranges.bins(); ++r) EXPECT_LT(profile.log[r], profile.log[ranges.bins()] - 3.0);
  const std::vector<double>& best = profile.best_to[ranges.bins()];
  ASSERT_EQ(best.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(best[k], to[k], 0.1 * to[k]);
}

// A coefficient that is printed a hundred times too small is found out, and weighed by its prior.
TEST(PublishedMap, FindsADecimalPointThatSlipped) {
  const Experiment e =
      read_experiment(SNARE_SOURCE_DIR "/data/experiments/published_static.toml", parameters());
  std::vector<QuadraticLaw> laws;
  for (const Series& s : e.series) laws.push_back(*s.law);
  Hypothesis slipped{"slipped", "", "slipped", {}, nullptr, true};
  const std::vector<QuadraticLaw> before = before_print(laws, slipped);
  EXPECT_DOUBLE_EQ(before[0].b, 100.0 * laws[0].b);
  for (std::size_t k = 1; k < laws.size(); ++k) EXPECT_EQ(before[k].b, laws[k].b);
  slipped.decimal_point = false;
  EXPECT_EQ(before_print(laws, slipped)[0].b, laws[0].b);
}

// A wire that gives at its mounts makes the numbers; the map names it, and no other single effect.
TEST(PublishedMap, NamesTheEffectThatMadeTheNumbers) {
  Experiment e = read_experiment(SNARE_SOURCE_DIR "/data/experiments/published_static.toml", parameters());
  e.solver.elements = 32;
  e.solver.extrapolate = false;
  std::vector<Series> truth = e.series;
  std::mt19937_64 random(5);
  for (Series& s : truth) {
    s.law->to = 9e-3;
    s.test.travel.clear();
    for (int i = 0; i < 25; ++i) s.test.travel.push_back(9e-3 * i / 24);
  }
  const Parameter& gives = parameters().at("mount_axial_compliance.compliance_m_N");
  const Evaluation made = Model(truth, e.solver).evaluate({{&gives, 1e-5}});
  ASSERT_TRUE(made.complete);
  std::normal_distribution<double> noise(0.0, 0.4);
  for (std::size_t k = 0; k < truth.size(); ++k) {
    VectorXd force = made.force[k];
    for (double& f : force) f += noise(random);
    e.series[k].law = printed_law(truth[k].test.travel, force, 4);
  }
  MapOptions options;
  options.elements = 32;
  options.ranges.bins = 10;
  options.ranges.readings = {13, 25, 50};
  options.first = 12, options.batch = 8, options.batches = 3;
  std::vector<Hypothesis> some;
  for (const Hypothesis& h : published_hypotheses())
    if (h.name == "declared" || h.name == "mount_axial_compliance" || h.name == "wire_length")
      some.push_back(h);
  const std::vector<HypothesisMap> maps = published_map(e, fit_ranges(e, options), some, options);
  ASSERT_EQ(maps.size(), 3u);
  for (const HypothesisMap& m : maps) {
    if (m.hypothesis.name != "mount_axial_compliance") continue;
    EXPECT_GT(m.probability[0], 0.99);
    EXPECT_GT(m.probability[1], 0.99);
  }
}

}  // namespace
}  // namespace snare::identification
