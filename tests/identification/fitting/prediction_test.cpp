// Predictions and fits against curves of the continuous wire, which share no code with the rod.

#include "base/errors.hpp"
#include "identification/effects/catalogue.hpp"
#include "identification/fitting/least_squares.hpp"
#include "tests/support/declared_wire.hpp"

#include <gtest/gtest.h>
#include "base/parallel.hpp"

#include <cmath>
#include <random>

namespace snare::identification {
namespace {

using test::mm;

Series series_of(const coupling::PushProblem& test, double offset, double sigma, unsigned seed,
                 int points = 20) {
  Series series;
  series.name = "s";
  series.test = test;
  std::vector<double> travel;
  Readings readings;
  for (int i = 0; i <= points; ++i) {
    const double d = 3.0 * mm * i / points;
    readings.displacement.push_back(d);
    if (d > offset) travel.push_back(d - offset);
  }
  const std::vector<validation::ElasticaState> states =
      validation::push_path(test::elastica_of(test), travel);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  readings.force.assign(readings.displacement.size() - travel.size(), 0.0);
  for (const validation::ElasticaState& s : states) readings.force.push_back(s.force);
  for (double& f : readings.force) f += sigma * noise(random);
  series.readings = readings;
  return series;
}

SolverSettings few_edges() {
  SolverSettings solver;
  solver.elements = 64;
  return solver;
}

TEST(Prediction, DisplacementsBeforeTouchReadTheForceOffset) {
  Series series = series_of(test::declared_wire(65.0 * mm, 6.0 * mm), 0.5 * mm, 0.0, 1);
  ReadingModel reading;
  reading.displacement_offset = 0.5 * mm;
  reading.force_offset = 0.25;
  reading.force_gain = 2.0;
  const Prediction p = predict(series, few_edges(), reading);
  ASSERT_EQ(p.force.size(), series.readings->force.size());
  EXPECT_EQ(p.before_touch, 4u);  // 0, 0.15, 0.30, 0.45 mm
  for (std::size_t i = 0; i < p.before_touch; ++i) EXPECT_EQ(p.force[i], 0.25);
  for (std::size_t i = p.before_touch; i < p.force.size(); ++i) {
    EXPECT_NEAR(p.force[i], 2.0 * series.readings->force[i] + 0.25, 2e-3 * p.force.back());  // 64 edges
  }
}

TEST(Prediction, SameBitsForAnyNumberOfThreads) {
  std::vector<Series> series;
  for (const double position : {40.0, 65.0, 90.0}) {
    series.push_back(series_of(test::declared_wire(position * mm, 6.0 * mm), 0.0, 0.0, 1));
  }
  const Model model(series, few_edges());
  const std::vector<const Parameter*> by{&parameters().at("wire.length_mm")};
  base::set_thread_count(1);
  const Evaluation one = model.evaluate({}, by);
  base::set_thread_count(2);
  const Evaluation two = model.evaluate({}, by);
  for (std::size_t k = 0; k < series.size(); ++k) {
    EXPECT_EQ(one.force[k], two.force[k]);
    EXPECT_EQ(one.by[k], two.by[k]);
  }
}

TEST(Prediction, MisfitByHand) {
  const Misfit m = misfit({0.0, 2.0, 4.0}, {1.0, 2.0, 2.0});
  EXPECT_NEAR(m.rmse, std::sqrt(5.0 / 3.0), 1e-15);
  EXPECT_NEAR(m.nrmse, std::sqrt(5.0 / 3.0) / 4.0, 1e-15);
  EXPECT_EQ(m.largest, 2.0);
}

// A dense record, its displacement jittering, is computed at some points of its legs and interpolated.
TEST(Prediction, DenseRecordsAreThinned) {
  Series dense = series_of(test::declared_wire(65.0 * mm, 6.0 * mm), 0.0, 0.0, 1);
  Readings& r = *dense.readings;
  r.displacement.clear();
  for (int i = 0; i < 400; ++i) r.displacement.push_back(3.0 * mm * i / 399 + (i % 2) * 1e-6);
  r.force.assign(400, 0.0);
  PredictionOptions thin;
  thin.thin = true;
  const Prediction interpolated = predict(dense, few_edges(), {}, thin);
  std::sort(r.displacement.begin(), r.displacement.end());
  const Prediction whole = predict(dense, few_edges(), {});
  ASSERT_EQ(interpolated.force.size(), whole.force.size());
  EXPECT_LT(interpolated.curve.curve.points.size(), 80u);
  // Cubics over a sixtieth of the range.
  for (std::size_t i = 10; i < whole.force.size(); ++i) {
    EXPECT_NEAR(interpolated.force[i], whole.force[i], 1e-3 * whole.force.back());
  }
}

TEST(Model, SettingsMoveEverySeriesFromItsOwnDeclaration) {
  std::vector<Series> series{series_of(test::declared_wire(65.0 * mm, 6.0 * mm), 0.0, 0.0, 1),
                             series_of(test::declared_wire(90.0 * mm, 6.0 * mm), 0.0, 0.0, 1)};
  series[0].name = "a";
  series[1].name = "b";
  series[1].test.wire.length = 179.0 * mm;
  series[1].test.wire.axial_stiffness_override = 1e5;
  const Model model(series, few_edges());
  const Model::Applied applied =
      model.apply({{&parameters().at("wire.length_mm"), 1e-3},
                   {&parameters().at("wire.axial_stiffness_N"), std::log(2.0)},
                   {&parameters().at("contact_position.shift_mm"), -2e-3},
                   {&parameters().at("series[b].reading.displacement_offset_mm"), 5e-4}});
  EXPECT_NEAR(applied.series[0].test.wire.length, 181.0 * mm, 1e-15);
  EXPECT_NEAR(applied.series[1].test.wire.length, 180.0 * mm, 1e-15);
  EXPECT_NEAR(applied.series[1].test.wire.axial_stiffness(), 2e5, 1e-9);
  EXPECT_NEAR(applied.series[1].test.contact_position, 88.0 * mm, 1e-15);
  EXPECT_EQ(applied.reading[0].displacement_offset, 0.0);
  EXPECT_EQ(applied.reading[1].displacement_offset, 5e-4);
  EXPECT_EQ(parameters().find("series[a].nothing"), nullptr);
}

// Numbers of the record, whose derivatives are written by hand; those of the test are compared in
// tests/coupling.
TEST(Model, DerivativesOfTheRecordMatchDifferences) {
  Series s = series_of(test::declared_wire(65.0 * mm, 6.0 * mm), 0.0, 0.0, 1);
  for (std::size_t i = 0; i < s.readings->displacement.size(); ++i)
    s.readings->time.push_back(0.1 * static_cast<double>(i * i));
  const Model model({s}, few_edges());
  const std::vector<Setting> at{{&parameters().at("reading.force_gain"), 0.1},
                                {&parameters().at("reading.force_offset_N"), 0.3},
                                {&parameters().at("rate_viscosity.relaxation_time_s"), 1e-3}};
  std::vector<const Parameter*> by;
  for (const Setting& one : at) by.push_back(one.parameter);
  const Evaluation here = model.evaluate(at, by);
  for (std::size_t k = 0; k < at.size(); ++k) {
    std::vector<Setting> up = at;
    std::vector<Setting> down = at;
    const double h = 1e-4 * std::abs(at[k].coordinate);
    up[k].coordinate += h;
    down[k].coordinate -= h;
    const Eigen::VectorXd difference =
        (model.evaluate(up).force[0] - model.evaluate(down).force[0]) / (2.0 * h);
    EXPECT_LT((here.by[0].col(static_cast<Eigen::Index>(k)) - difference).norm(), 1e-6 * difference.norm())
        << by[k]->key;
  }
}

/// Two positions of a wire that differs from its declaration in EA, length and zero of travel.
struct Hidden {
  std::vector<Series> series;
  Data data;
  double axial = 0.0;
};
Hidden hidden_wire(double sigma, unsigned seed) {
  Hidden h;
  coupling::PushProblem truth = test::declared_wire(65.0 * mm, 6.0 * mm);
  h.axial = 0.8 * truth.wire.axial_stiffness();
  truth.wire.axial_stiffness_override = h.axial;
  truth.wire.length = 179.5 * mm;
  for (const double position : {65.0 * mm, 87.5 * mm}) {
    truth.contact_position = position;
    Series s = series_of(truth, 0.2 * mm, sigma, seed++);
    s.test.wire.axial_stiffness_override.reset();
    s.test.wire.length = 180.0 * mm;
    h.data.series.push_back(h.series.size());
    h.data.measured.emplace_back(Eigen::Map<const Eigen::VectorXd>(
        s.readings->force.data(), static_cast<Eigen::Index>(s.readings->force.size())));
    h.data.noise.sigma.push_back(sigma);
    h.series.push_back(std::move(s));
  }
  h.data.noise.source = "declared";
  return h;
}

/// Its three numbers, from a start nearby.
Fit fit_from_nearby(const Model& model, const Hidden& h) {
  return fit(model, h.data,
             {{&parameters().at("wire.length_mm"), -5e-4},
              {&parameters().at("wire.axial_stiffness_N"), -0.2},
              {&parameters().at("reading.displacement_offset_mm"), 2e-4}});
}

TEST(LeastSquares, RecoverTheWireFromIndependentCurves) {
  const Hidden h = hidden_wire(0.05, 10);
  SolverSettings solver;
  solver.elements = 128;
  const Model model(h.series, solver);
  const Fit f = fit(model, h.data,
                    {{&parameters().at("wire.axial_stiffness_N"), 0.0},
                     {&parameters().at("wire.length_mm"), 0.0},
                     {&parameters().at("reading.displacement_offset_mm"), 0.0}});
  ASSERT_TRUE(f.report.usable()) << f.report.message;
  const double expected[] = {h.axial, 179.5, 0.2};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const double deviation = std::sqrt(f.covariance(i, i));
    const Parameter& p = *f.settings[k].parameter;
    const double truth =
        k == 0 ? std::log(h.axial / model.declared(p)) : expected[k] * p.unit_size - (k == 1 ? 0.18 : 0.0);
    EXPECT_NEAR(f.settings[k].coordinate, truth, 4.0 * deviation) << p.key;
    EXPECT_GT(deviation, 0.0);
  }
  // 39 degrees of freedom: chi2 within five of its standard deviations.
  EXPECT_NEAR(f.chi2, f.dof(), 5.0 * std::sqrt(2.0 * f.dof()));
}

TEST(LeastSquares, ProfileOfANearlyLinearNumberIsItsStandardError) {
  const Hidden h = hidden_wire(0.05, 4);
  const Model model(h.series, few_edges());
  const Fit f = fit_from_nearby(model, h);
  ASSERT_TRUE(f.report.usable());
  const ProfileInterval interval = profile_interval(model, h.data, f, 0, 3.84);
  ASSERT_TRUE(interval.lower && interval.upper);
  const double deviation = std::sqrt(f.covariance(0, 0));
  EXPECT_NEAR(*interval.upper - *interval.lower, 2.0 * 1.96 * deviation, 0.1 * 3.92 * deviation);
}

// Where the numbers are held at an end and all others fitted again, chi2 has risen by what was asked, with
// much noise as with little.
TEST(LeastSquares, AtTheEndsOfAProfileAFitOfTheOthersHasRisenByWhatWasAsked) {
  constexpr double rise = 3.84;
  int ends = 0;
  for (const double sigma : {0.05, 3.0}) {
    const Hidden h = hidden_wire(sigma, 4);
    const Model model(h.series, few_edges());
    const Fit f = fit_from_nearby(model, h);
    ASSERT_TRUE(f.report.usable());
    for (std::size_t which = 0; which < 3; ++which) {
      const ProfileInterval interval = profile_interval(model, h.data, f, which, rise);
      for (const std::optional<double> end : {interval.lower, interval.upper}) {
        if (!end) continue;
        ++ends;
        std::vector<Setting> others = f.fitted();
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(which));
        const Fit beside = fit(model, h.data, others, {{f.settings[which].parameter, *end}});
        ASSERT_TRUE(beside.report.usable());
        EXPECT_NEAR((beside.chi2 - f.chi2) / rise, 1.0, 0.1)
            << sigma << " " << f.settings[which].parameter->key;
      }
    }
  }
  EXPECT_GE(ends, 6);  // all of them with little noise
}

TEST(LeastSquares, ANumberThatNothingDependsOnHasNoStandardError) {
  const Hidden h = hidden_wire(0.05, 4);
  const Model model(h.series, few_edges());
  const Fit f = fit(model, h.data,
                    {{&parameters().at("wire.axial_stiffness_N"), -0.2},
                     {&parameters().at("mount.support_radius_mm"), 0.0}});
  ASSERT_TRUE(f.report.usable()) << f.report.message;
  EXPECT_TRUE(f.covariance.allFinite());
  EXPECT_EQ(f.jacobian.col(1).norm(), 0.0);
}

}  // namespace
}  // namespace snare::identification
