#include "identification/tracing/trace.hpp"

#include "tests/support/declared_wire.hpp"
#include "tests/support/refusal.hpp"
#include "validation/blind_set.hpp"

#include <gtest/gtest.h>
#include "base/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace snare::identification {
namespace {

using test::mm;

/// Two series of `n` readings whose forces `f` says.
Experiment experiment_of(int n, const std::function<double(int)>& f) {
  Experiment e;
  e.file = "x.toml";
  e.solver.elements = 64;
  for (const double position : {65.0 * mm, 90.0 * mm}) {
    Series s;
    s.name = position < 80.0 * mm ? "a" : "b";
    s.test = test::declared_wire(position, 6.0 * mm);
    Readings r;
    for (int i = 0; i < n; ++i) {
      r.displacement.push_back(0.1 * mm * i);
      r.force.push_back(f(i));
    }
    s.test.travel = r.displacement;
    s.readings = r;
    e.series.push_back(s);
  }
  return e;
}

void expect_refused(const Experiment& e, const std::string& part) {
  const std::string said = test::refusal([&] { return trace(e); });
  EXPECT_NE(said.find(part), std::string::npos) << said;
  EXPECT_NE(said.find("x.toml"), std::string::npos) << said;
}

TEST(TraceInput, ConstantForceIsRefused) {
  expect_refused(experiment_of(20, [](int) { return 2.0; }), "force_N is 2 in every reading");
}

TEST(TraceInput, ARecordThatNeverTouchesIsRefused) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  expect_refused(experiment_of(40, [&](int) { return 0.01 * normal(random); }), "never touched");
}

TEST(TraceInput, TooFewReadingsAreRefused) {
  Experiment e = experiment_of(3, [](int i) { return 1.0 * i; });
  e.free = {"wire.bending_stiffness_Nm2", "wire.axial_stiffness_N", "wire.length_mm", "reading.force_offset_N"};
  expect_refused(e, "must leave at least 3 degrees of freedom: at most 3 keys with 6 readings");
}

TEST(TraceInput, SeriesWithoutReadingsAreRefused) {
  Experiment e = experiment_of(10, [](int i) { return 1.0 * i; });
  e.series[1].readings.reset();
  expect_refused(e, "series[b], must have readings or a law");
}

TEST(TraceInput, AnUnknownNumberIsNamedBesideThoseThatThereAre) {
  Experiment e = experiment_of(10, [](int i) { return 1.0 * i; });
  e.free = {"wire.colour"};
  const std::string text = test::refusal([&] { return trace(e); });
  const std::string begin =
      "fit.free = \"wire.colour\", must be one of wire.bending_stiffness_Nm2, wire.axial_stiffness_N, "
      "wire.length_mm, wire.diameter_mm, wire.youngs_modulus_GPa, wire.density_kg_m3, "
      "wire.natural_curvature_1_m, mount.span_mm, ";
  EXPECT_NE(text.find(begin), std::string::npos) << text;
  EXPECT_TRUE(text.ends_with("pusher_play.width_mm, rate_viscosity.relaxation_time_s")) << text;
}

TEST(TraceInput, AThresholdThatIsNotDeclaredCannotBeFitted) {
  Experiment e = experiment_of(10, [](int i) { return 1.0 * i; });
  e.free = {"mount_slip.tension_N"};
  expect_refused(e, "declare a value to start from");
}

/// A blind set on few edges: quick under the sanitizers.
Experiment blind(const char* effect, double size, unsigned seed) {
  Experiment e = validation::make_blind_set(effect, size, seed).experiment;
  e.solver.elements = 64;
  return e;
}

TEST(SlowTrace, NamesAnEffectAndGivesTheSameBitsForAnyNumberOfThreads) {
  const validation::BlindSet set = validation::make_blind_set("force_offset", 30.0, 3);
  Experiment e = set.experiment;
  e.heldout = {"p2"};
  base::set_thread_count(1);
  const Trace one = trace(e);
  base::set_thread_count(2);
  const Trace two = trace(e);
  ASSERT_EQ(one.selected, std::vector<std::string>{"force_offset"});
  EXPECT_TRUE(one.explained);
  EXPECT_EQ(one.channel, "sensor");
  EXPECT_LT(one.final.chi2_dof, 1.3);
  EXPECT_GT(one.base.chi2_dof, 3.0);
  ASSERT_TRUE(one.heldout_rmse.has_value());
  EXPECT_LT(one.heldout_rmse->second, 1.5 * 0.05);  // 39 readings
  EXPECT_GT(one.heldout_rmse->first, 2.0 * one.heldout_rmse->second);
  // The offset that was put in: 5 N times the amount, either sign; the other series agree to their noise.
  const FittedNumber& offset = one.final.numbers.back();
  ASSERT_TRUE(offset.lower && offset.upper);
  EXPECT_NEAR(std::abs(offset.value), 5.0 * set.amount, 5.0 * *offset.standard_error);
  EXPECT_EQ(one.final.rmse, two.final.rmse);
  for (std::size_t k = 0; k < one.final.numbers.size(); ++k)
    EXPECT_EQ(one.final.numbers[k].value, two.final.numbers[k].value);
  // By how much the stiffnesses move says the score beforehand.
  const Candidate& first = one.rounds.front().candidates.front();
  for (std::size_t k = 0; k < 2; ++k) {
    const double moved = std::log(one.final.numbers[k].value / one.base.numbers[k].value);
    const double said = first.score.z * first.score.shift[static_cast<Eigen::Index>(k)];
    EXPECT_NEAR(said, moved, 0.1 * std::abs(moved)) << one.final.numbers[k].key;
  }
  ASSERT_EQ(one.rounds.size(), two.rounds.size());
  for (std::size_t k = 0; k < one.rounds.front().candidates.size(); ++k) {
    EXPECT_EQ(one.rounds.front().candidates[k].score.z, two.rounds.front().candidates[k].score.z);
  }
}

TEST(SlowTrace, IsSilentWhereNothingIsMissing) {
  const Trace t = trace(blind("none", 0.0, 5));
  EXPECT_TRUE(t.selected.empty());
  EXPECT_TRUE(t.explained);
  EXPECT_FALSE(t.significant);
  // Intervals hold whether an effect is missing or not: wider than the base model's own, and not by much.
  for (std::size_t k = 0; k < t.final.numbers.size(); ++k) {
    const FittedNumber& base = t.base.numbers[k];
    const FittedNumber& final = t.final.numbers[k];
    EXPECT_TRUE(final.averaged && !base.averaged) << base.key;
    EXPECT_GT(*final.upper - *final.lower, *base.upper - *base.lower) << base.key;
    EXPECT_TRUE(*final.lower < base.value && base.value < *final.upper) << base.key;
    EXPECT_LT(*final.upper - *final.lower, 4.0 * (*base.upper - *base.lower)) << base.key;
  }
  // It says what it could have seen.
  for (const Candidate& c : t.rounds.front().candidates) {
    if (c.score.effect->name == "contact_friction") {
      ASSERT_TRUE(c.score.detectable);
      EXPECT_LT(*c.score.detectable, 0.1);
    }
  }
}

// Six places off by 0.02 mm (of one standard deviation), which is tens of standard deviations of the readings.
TEST(SlowTrace, ErrorsOfPlacesThatAreDeclaredAreNoEffect) {
  const validation::BlindDesign places{.length_deviation = 1e-4, .position_deviation = 2e-5};
  Experiment e = validation::make_blind_set("none", 0.0, 2001, places).experiment;
  e.solver.elements = 64;
  const Trace silent = trace(e);
  EXPECT_EQ(silent.kind, VerdictKind::nothing_missing);
  EXPECT_LT(silent.base.rmse, 1.1 * 0.05);  // the curves are those of the places found
  ASSERT_EQ(silent.places.size(), 6);
  for (const PlaceEstimate& place : silent.places) {
    EXPECT_LT(std::abs(place.shift), 3.0 * 2e-5);
    EXPECT_LT(place.standard_error, 2e-5);
  }
  for (Series& s : e.series) s.position_sigma = 0.0;
  EXPECT_NE(trace(e).kind, VerdictKind::nothing_missing);
  Experiment rough = validation::make_blind_set("contact_friction", 30.0, 2001, places).experiment;
  rough.solver.elements = 64;
  const Trace named = trace(rough);
  EXPECT_EQ(named.selected, std::vector<std::string>{"contact_friction"});
  EXPECT_TRUE(named.explained);
}

TEST(SlowTrace, SaysSoWhenTheCatalogueHasNoExplanation) {
  const Trace t = trace(blind("drift", 30.0, 2));
  EXPECT_FALSE(t.explained);
  EXPECT_TRUE(t.selected.empty());
  EXPECT_EQ(t.channel, "sensor");
  ASSERT_FALSE(t.functions.empty());
  EXPECT_TRUE(t.functions.front().accepted);
  EXPECT_NE(t.functions.front().argument.find("time"), std::string::npos);
  EXPECT_EQ(t.final.rmse, t.base.rmse);  // nothing is absorbed
}

TEST(SlowTrace, CanBeInterrupted) {
  TraceOptions options;
  options.progress = [](const std::string& stage) { return stage.find("refit") == std::string::npos; };
  const Trace t = trace(blind("contact_friction", 30.0, 2), options);
  EXPECT_TRUE(t.interrupted);
  EXPECT_GT(t.base.rmse, 0.0);  // what was finished is there
}

}  // namespace
}  // namespace snare::identification
