#include "identification/tracing/trace.hpp"

#include "base/parallel.hpp"
#include "validation/blind_set.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace snare::identification {
namespace {

/// A blind set on few edges.
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
  const Trace t = trace(blind("none", 0.0, 6));
  EXPECT_FALSE(t.serial.has_value());
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
  // The scores state the smallest size that these data show.
  for (const Candidate& c : t.rounds.front().candidates) {
    if (c.score.effect->name == "contact_friction") {
      ASSERT_TRUE(c.score.detectable);
      EXPECT_LT(*c.score.detectable, 0.1);
    }
  }
}

// Six places off by 0.02 mm (of one standard deviation), which is tens of standard deviations of the
// readings.
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
  const Trace t = trace(blind("damage", 300.0, 2));
  EXPECT_FALSE(t.explained);
  EXPECT_TRUE(t.selected.empty());
  EXPECT_EQ(t.channel, "wire");
  ASSERT_FALSE(t.functions.empty());
  EXPECT_TRUE(t.functions.front().accepted);
  EXPECT_NE(t.functions.front().argument.find("place"), std::string::npos);
}

TEST(SlowTrace, CanBeInterrupted) {
  TraceOptions options;
  options.progress = [](const std::string& stage) { return stage.find("refit") == std::string::npos; };
  const Trace t = trace(blind("contact_friction", 30.0, 2), options);
  EXPECT_TRUE(t.interrupted);
  EXPECT_GT(t.base.rmse, 0.0);  // the base model was finished
}

}  // namespace
}  // namespace snare::identification
