#include "identification/tracing/verdict.hpp"

#include "identification/effects/catalogue.hpp"
#include "identification/tracing/residual_tests.hpp"
#include "identification/tracing/trace.hpp"
#include "tests/support/declared_wire.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace snare::identification {
namespace {

using test::mm;

/// Loading of the declared wire at one place, its computed forces for readings.
Experiment computed(int readings, const std::vector<double>& places) {
  Experiment e;
  e.file = "x.toml";
  e.solver.elements = 64;
  for (const double place : places) {
    Series s;
    s.name = "s" + std::to_string(e.series.size());
    s.test = test::declared_wire(place, 6.0 * mm);
    for (int i = 1; i <= readings; ++i) s.test.travel.push_back(1.5 * mm * i / readings);
    s.readings = Readings{s.test.travel, {}, {}};
    s.readings->force = predict(s, e.solver).force;
    e.series.push_back(s);
  }
  return e;
}

void add_noise(Experiment& e, double sigma, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (Series& s : e.series) {
    for (double& f : s.readings->force) f += sigma * normal(random);
  }
}

struct Fitted {
  Model model;
  Data data;
  Fit fit;
};

Fitted fitted(const Experiment& e, double sigma) {
  Fitted result{Model(e.series, e.solver), {}, {}};
  for (std::size_t k = 0; k < e.series.size(); ++k) {
    result.data.series.push_back(k);
    result.data.measured.push_back(forces_of(e.series[k]));
  }
  result.data.noise.sigma.assign(e.series.size(), sigma);
  result.data.noise.source = "declared";
  result.fit = fit(result.model, result.data, {{&parameters().at("wire.axial_stiffness_N"), 0.0}});
  return result;
}

// Of white noise nothing is left: p is uniform, and the bound is a part of the noise.
TEST(Remainder, OfNoiseIsNone) {
  const Experiment exact = computed(40, {65.0 * mm});
  int low = 0;
  constexpr int sets = 40;
  for (unsigned seed = 1; seed <= sets; ++seed) {
    Experiment e = exact;
    add_noise(e, 0.1, seed);
    const Fitted f = fitted(e, 0.1);
    const Remainder left = remainder(f.model, f.data, f.fit);
    low += left.p < 0.1 ? 1 : 0;
    EXPECT_LT(left.upper, 0.1);  // eleven directions of 39: at most 0.1 sqrt(25/40) in nearly all cases
  }
  EXPECT_LE(low, 10);  // binomial: 4 +- 1.9
}

// A sine of the travel that the fitted number cannot follow is found with its size.
TEST(Remainder, HasTheSizeOfASmoothMisfit) {
  Experiment e = computed(40, {65.0 * mm});
  add_noise(e, 0.05, 4);
  double squares = 0.0;
  for (std::size_t i = 0; i < 40; ++i) {
    const double wave = std::sin(0.35 * static_cast<double>(i));
    e.series[0].readings->force[i] += wave;
    squares += wave * wave / 40.0;
  }
  const Fitted f = fitted(e, 0.05);
  const Remainder left = remainder(f.model, f.data, f.fit);
  EXPECT_LT(left.p, 1e-6);
  // Hats of 1/11 of the travel follow it to 3 %, the stiffness takes some of it.
  EXPECT_NEAR(left.rmse, std::sqrt(squares), 0.1 * std::sqrt(squares));
  EXPECT_GT(left.upper, left.rmse);
  EXPECT_LT(left.upper, 1.2 * left.rmse);
  EXPECT_GT(left.inflation(), 10.0);
}

// Six readings cannot bear an effect beside two numbers, whatever the second decimals look like.
TEST(Verdict, OfFewReadingsNamesNothing) {
  Experiment e = computed(6, {87.5 * mm});
  const double forces[] = {0.0, 24.1, 55.9, 95.2, 142.0, 196.3};
  for (std::size_t i = 0; i < 6; ++i) {
    e.series[0].readings->displacement[i] = 0.3 * mm * static_cast<double>(i);
    e.series[0].readings->force[i] = forces[i];
  }
  e.series[0].test.travel = e.series[0].readings->displacement;
  const Trace t = trace(e);
  EXPECT_TRUE(t.selected.empty());
  EXPECT_TRUE(t.few_readings);
  EXPECT_FALSE(t.decided);
  EXPECT_EQ(t.kind, VerdictKind::nothing_missing);
  EXPECT_TRUE(t.rounds.empty());
  EXPECT_TRUE(t.findings.empty());
}

// What is significant and smaller than the tolerance is not called missing.
TEST(Verdict, SmallIsNotMissing) {
  Experiment e = computed(30, {65.0 * mm, 90.0 * mm});
  for (Series& s : e.series) {
    for (double& f : s.readings->force) f += 0.3;  // of 100 N and more
  }
  add_noise(e, 0.01, 2);
  const Trace t = trace(e);
  EXPECT_EQ(t.kind, VerdictKind::nothing_missing);
  EXPECT_NEAR(t.tolerance, usual_tolerance * t.peak_force, 1e-12);
  EXPECT_LT(t.remaining.upper, t.tolerance);
  EXPECT_TRUE(t.selected.empty());
  EXPECT_FALSE(t.base_tests.like_noise());
}

TEST(Verdict, ToleranceIsWhatTheFileSays) {
  Experiment e = computed(10, {65.0 * mm});
  Fitted f = fitted(e, 1.0);
  EXPECT_EQ(model_tolerance(e, f.data), 0.0);  // the noise is declared
  f.data.noise.source = "residual";
  EXPECT_DOUBLE_EQ(model_tolerance(e, f.data), 0.01 * peak_force(f.data));
  e.model_tolerance = 0.03;
  EXPECT_DOUBLE_EQ(model_tolerance(e, f.data), 0.03 * peak_force(f.data));
}

TEST(Verdict, StiffnessesBeyondTheSolidSectionAreFindings) {
  const Experiment e = computed(10, {65.0 * mm});
  const Model model(e.series, e.solver);
  const double solid =
      e.series[0].test.wire.youngs_modulus * 0.25 * M_PI * std::pow(e.series[0].test.wire.diameter, 2);
  FittedNumber n{
      "wire.axial_stiffness_N", "N", solid, 4.6 * solid, 0.1 * solid, 4.4 * solid, 4.8 * solid, false};
  ASSERT_EQ(beyond_construction(model, {n}).size(), 1u);
  EXPECT_TRUE(beyond_construction(model, {n})[0].sure);
  EXPECT_DOUBLE_EQ(beyond_construction(model, {n})[0].limit, solid);
  n.lower = 1.1 * solid;
  ASSERT_EQ(beyond_construction(model, {n}).size(), 1u);
  EXPECT_FALSE(beyond_construction(model, {n})[0].sure);
  n.lower = 0.5 * solid;
  EXPECT_TRUE(beyond_construction(model, {n}).empty());
}

// Two percent of what the base model leaves, and three of the largest force with 95 % confidence: both.
TEST(Verdict, APartialAnswerLeavesLittle) {
  const Remainder base{.rmse = 10.0, .upper = 11.0};
  EXPECT_TRUE(is_partial(base, {.rmse = 1.4, .upper = 2.9}, 100.0));   // 0.0196 of the squares
  EXPECT_FALSE(is_partial(base, {.rmse = 1.4, .upper = 3.1}, 100.0));  // 3.1 % of the force
  EXPECT_FALSE(is_partial(base, {.rmse = 1.5, .upper = 2.9}, 100.0));  // 0.0225
}

TEST(Verdict, AnEffectThatLowersTheErrorByLittleHasNoName) {
  EXPECT_TRUE(worth_a_name(1.0, 0.85, 0.15, 0.1));
  EXPECT_FALSE(worth_a_name(1.0, 0.95, 0.05, 0.01));  // less than a tenth
  EXPECT_FALSE(worth_a_name(1.0, 0.85, 0.15, 0.2));   // less than the tolerance
}

TEST(Verdict, IsDecidedByAllThatIsAsked) {
  const Evidence good{.dof = 5.0, .classes = {{"span"}}, .left_out = {2.0, 1.0}};
  EXPECT_TRUE(is_decided(good));
  Evidence e = good;
  e.dof = 4.0;
  EXPECT_FALSE(is_decided(e));
  e = good;
  e.classes = {{"span", "wire_length"}};
  EXPECT_FALSE(is_decided(e));
  e = good;
  e.left_out = {1.0, 1.0};
  EXPECT_FALSE(is_decided(e));
  e = good;
  e.classes.push_back({"gravity"});
  e.left_out = {2.0, 1.0, 1.5};  // the second one does not help
  EXPECT_FALSE(is_decided(e));
  for (bool Evidence::*what : {&Evidence::cause_outside, &Evidence::one_condition, &Evidence::zero_in_doubt,
                               &Evidence::something_left}) {
    e = good;
    e.*what = true;
    EXPECT_FALSE(is_decided(e));
  }
}

// Readings that begin late, their zero off by 0.1 mm: the stiffnesses take it up, the error is below what has
// a name, and the zero is still found.
TEST(Verdict, AZeroIsLookedForWhereTheTouchIsNotSeen) {
  for (const double zero : {0.0, 0.1 * mm}) {
    Experiment e = computed(40, {65.0 * mm, 90.0 * mm});
    add_noise(e, 0.02, 3);
    for (Series& s : e.series) {
      for (double& d : s.readings->displacement) d += zero;
      s.test.travel = s.readings->displacement;
      s.test.wire.bending_stiffness_override = 1.05 * s.test.wire.bending_stiffness();
    }
    e.model_tolerance = 0.02;
    TraceOptions options;
    options.intervals = false;
    const Trace t = trace(e, options);
    ASSERT_EQ(t.kind, VerdictKind::nothing_missing) << t.base.rmse;
    ASSERT_TRUE(t.zero.has_value());
    EXPECT_NEAR(t.zero->offset, zero / mm, 0.02);
    EXPECT_EQ(t.zero->doubtful, zero > 0.0) << t.zero->p << " " << t.zero->without << " " << t.zero->with;
    if (zero > 0.0) {
      EXPECT_FALSE(t.decided);
    }
  }
}

// Beside a fitted zero no other is asked for.
TEST(Verdict, NoZeroIsLookedForBesideAFittedOne) {
  const Experiment e = computed(40, {65.0 * mm});
  Fitted f = fitted(e, 0.05);
  EXPECT_TRUE(check_zero(f.model, f.data, f.fit).has_value());
  f.fit = fit(f.model, f.data,
              {{&parameters().at("wire.axial_stiffness_N"), 0.0},
               {&parameters().at("reading.displacement_offset_mm"), 0.0}});
  EXPECT_FALSE(check_zero(f.model, f.data, f.fit).has_value());
}

}  // namespace
}  // namespace snare::identification
