// Weighed hypotheses on readings of the collocated elastica, which shares nothing with the solver: unknown
// functions that are in no catalogue are put into the readings.

#include "identification/tracing/hypotheses.hpp"

#include "identification/tracing/base_fit.hpp"
#include "identification/tracing/trace_input.hpp"
#include "validation/blind_set.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace snare::identification {
namespace {

/// Hypotheses beside the base model alone: no effect was fitted.
std::vector<CauseHypothesis> weighed(const Experiment& experiment) {
  SolverSettings solver = experiment.solver;
  solver.elements = std::min(solver.elements, 128);
  const Model model(experiment.series, solver);
  Data data = data_of(model.series(), experiment.published_scatter);
  Progress progress({});
  Fit base = fit_base(experiment, {}, model, data, progress);
  settle_noise(model, data, base);
  EXPECT_TRUE(base.report.usable());
  return weigh_hypotheses(model, data, {{{}, base}});
}

/// Adds `deviations` standard deviations of a reading times a wave of a share in [0, 1] to every reading.
Experiment disturbed(unsigned seed, double deviations,
                     const std::function<double(const Series&, std::size_t)>& share) {
  Experiment experiment = validation::make_blind_set("none", 0.0, seed).experiment;
  for (Series& s : experiment.series) {
    const double sigma = s.force_sigma.value_or(0.0);
    EXPECT_GT(sigma, 0.0);
    const std::vector<double> before = s.readings->force;
    for (std::size_t i = 0; i < before.size(); ++i)
      s.readings->force[i] += deviations * sigma * std::sin(3.0 * std::numbers::pi * share(s, i));
  }
  return experiment;
}

double largest_force(const Experiment& experiment) {
  double largest = 0.0;
  for (const Series& s : experiment.series) largest = std::max(largest, std::ranges::max(s.readings->force));
  return largest;
}

TEST(SlowHypotheses, NothingLeadsWhereNothingIsMissing) {
  double sum = 0.0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const std::vector<CauseHypothesis> all =
        weighed(validation::make_blind_set("none", 0.0, seed).experiment);
    double total = 0.0;
    for (const CauseHypothesis& h : all) total += h.probability;
    EXPECT_NEAR(total, 1.0, 1e-12);
    for (const CauseHypothesis& h : all)
      if (h.effects.empty() && h.discrepancy.empty()) sum += h.probability;
  }
  EXPECT_GT(sum / 10.0, 0.85);
}

// A wave over the force, or over the travel, of a reading's standard deviation: in six series of 40 readings
// some ten deviations in all. The right variable leads in nearly all sets (three positions, two slacks).
TEST(SlowHypotheses, TheVariableOfAnUnknownFunctionLeads) {
  const double largest = largest_force(validation::make_blind_set("none", 0.0, 1).experiment);
  const auto over_force = [&](const Series& s, std::size_t i) { return s.readings->force[i] / largest; };
  const auto over_travel = [](const Series& s, std::size_t i) {
    return s.readings->displacement[i] / std::ranges::max(s.readings->displacement);
  };
  int force = 0, travel = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    force += outside_cause(weighed(disturbed(seed, 1.0, over_force))).variable == "force";
    travel += outside_cause(weighed(disturbed(seed, 1.0, over_travel))).variable == "travel";
  }
  EXPECT_GE(force, 9);
  EXPECT_GE(travel, 9);
}

}  // namespace
}  // namespace snare::identification
