// Prediction and calibration against curves of the continuous wire, which share no code with the rod.

#include "identification/calibration.hpp"
#include "numerics/errors.hpp"
#include "tests/support/declared_wire.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <random>

namespace snare::identification {
namespace {

using test::mm;

Series series_of(const coupling::PushTest& test, double offset, double sigma, unsigned seed) {
  Series series;
  series.name = "s";
  series.test = test;
  std::vector<double> travel;
  Readings readings;
  for (int i = 0; i <= 20; ++i) {
    const double d = 3.0 * mm * i / 20;
    readings.displacement.push_back(d);
    if (d > offset) travel.push_back(d - offset);
  }
  const std::vector<validation::ElasticaState> states = validation::push_path(test::elastica_of(test), travel);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  readings.force.assign(readings.displacement.size() - travel.size(), 0.0);
  for (const validation::ElasticaState& s : states) readings.force.push_back(s.force);
  for (double& f : readings.force) f += sigma * noise(random);
  series.readings = readings;
  return series;
}

TEST(Prediction, DisplacementsBeforeTouchReadTheForceOffset) {
  Series series = series_of(test::declared_wire(65.0 * mm, 6.0 * mm), 0.5 * mm, 0.0, 1);
  SolverSettings solver;
  solver.elements = 64;
  ReadingModel reading;
  reading.displacement_offset = 0.5 * mm;
  reading.force_offset = 0.25;
  reading.force_gain = 2.0;
  const Prediction p = predict(series, solver, reading);
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
  SolverSettings solver;
  solver.elements = 64;
  omp_set_num_threads(1);
  const std::vector<Prediction> one = predict_all(series, solver);
  omp_set_num_threads(2);
  const std::vector<Prediction> two = predict_all(series, solver);
  for (std::size_t k = 0; k < series.size(); ++k) EXPECT_EQ(one[k].force, two[k].force);
}

TEST(Prediction, MisfitByHand) {
  const Misfit m = misfit({0.0, 2.0, 4.0}, {1.0, 2.0, 2.0});
  EXPECT_NEAR(m.rmse, std::sqrt(5.0 / 3.0), 1e-15);
  EXPECT_NEAR(m.nrmse, std::sqrt(5.0 / 3.0) / 4.0, 1e-15);
  EXPECT_EQ(m.largest, 2.0);
}

TEST(Calibration, RecoversTheWireFromIndependentCurves) {
  // The wire that made the curves differs from the declared one in EA, length and zero of travel.
  coupling::PushTest truth = test::declared_wire(65.0 * mm, 6.0 * mm);
  truth.wire.axial_stiffness_override = 0.8 * truth.wire.axial_stiffness();
  truth.wire.length = 179.5 * mm;
  constexpr double sigma = 0.05;
  Experiment experiment;
  experiment.solver.elements = 64;
  unsigned seed = 10;
  for (const double position : {65.0 * mm, 87.5 * mm}) {
    truth.contact_position = position;
    Series series = series_of(truth, 0.2 * mm, sigma, seed++);
    series.test.wire.axial_stiffness_override.reset();
    series.test.wire.length = 180.0 * mm;
    experiment.series.push_back(series);
  }
  const Calibration fit = calibrate(
      experiment, {"wire.axial_stiffness_N", "wire.length_mm", "reading.displacement_offset_mm"});
  ASSERT_TRUE(fit.report.usable()) << fit.report.message;
  const double expected[] = {truth.wire.axial_stiffness(), 179.5, 0.2};
  for (std::size_t k = 0; k < 3; ++k) {
    const FreeParameter& p = fit.parameters[k];
    ASSERT_TRUE(p.standard_error.has_value());
    // Five standard errors, or the mesh's own error of 1e-4 where that is more.
    EXPECT_NEAR(p.value, expected[k], 5.0 * *p.standard_error + 1e-4 * std::abs(expected[k])) << p.key;
  }
  EXPECT_NEAR(fit.misfit.rmse, sigma, 0.4 * sigma);  // 42 readings: 11 % standard deviation
}

TEST(Calibration, WrongInputIsNamed) {
  Experiment experiment;
  experiment.series.push_back(series_of(test::declared_wire(65.0 * mm, 6.0 * mm), 0.0, 0.0, 1));
  try {
    (void)calibrate(experiment, {"wire.colour"});
    FAIL() << "an unknown key was accepted";
  } catch (const numerics::InputError& error) {
    EXPECT_EQ(error.problems().front().key, "fit.free");
    EXPECT_EQ(error.problems().front().value, "\"wire.colour\"");
  }
}

}  // namespace
}  // namespace snare::identification
