#include "identification/tracing/model_error.hpp"

#include "identification/effects/catalogue.hpp"
#include "identification/fitting/least_squares.hpp"
#include "tests/support/declared_wire.hpp"

#include <Eigen/LU>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace snare::identification {
namespace {

using test::mm;

constexpr double kSigma = 0.05;  // of a reading [N]
constexpr int kReadings = 40;

/// Readings at two places that differ from what is computed by noise alone, and an optimum of two numbers:
/// the axial stiffness, which both places tell, and one that the second tells `weak` times as well as the
/// first.
struct TwoPlaces {
  Model model;
  Data data;
  Fit fit;

  explicit TwoPlaces(double weak) : model(series(), solver()) {
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    fit.settings = {{&parameters().at("wire.axial_stiffness_N"), 0.0},
                    {&parameters().at("wire.length_mm"), 0.0}};
    fit.free = 2;
    for (std::size_t k = 0; k < 2; ++k) {
      Eigen::VectorXd computed = Eigen::VectorXd::LinSpaced(kReadings, 0.0, 40.0);
      Eigen::MatrixXd by(kReadings, 2);
      for (int i = 0; i < kReadings; ++i) {
        by(i, 0) = 1.0 + 0.1 * i;
        by(i, 1) = (k == 0 ? 1.0 : weak) * std::cos(0.3 * i);
      }
      Eigen::VectorXd measured = computed;
      for (double& f : measured) f += kSigma * normal(random);
      data.series.push_back(k);
      data.measured.push_back(measured);
      fit.evaluation.force.push_back(computed);
      fit.evaluation.by.push_back(by);
    }
    data.noise.sigma = {kSigma, kSigma};
    data.noise.source = "declared";
    // The optimum of this linear model: its numbers take their part of the noise.
    const Eigen::MatrixXd jacobian = data.jacobian(fit.evaluation);
    const Eigen::VectorXd step =
        covariance_of(jacobian) * (jacobian.transpose() * data.residual(fit.evaluation));
    for (std::size_t k = 0; k < 2; ++k) fit.evaluation.force[k] += fit.evaluation.by[k] * step;
    fit.residual = data.residual(fit.evaluation);
    fit.jacobian = jacobian;
  }

 private:
  static std::vector<Series> series() {
    std::vector<Series> result(2);
    for (std::size_t k = 0; k < 2; ++k) {
      result[k].test = test::declared_wire(k == 0 ? 40.0 * mm : 90.0 * mm, 6.0 * mm);
      for (int i = 1; i <= kReadings; ++i) result[k].test.travel.push_back(1.5 * mm * i / kReadings);
      result[k].readings = Readings{result[k].test.travel, std::vector<double>(kReadings, 0.0), {}};
    }
    return result;
  }
  static SolverSettings solver() {
    SolverSettings s;
    s.elements = 32;
    return s;
  }
};

// What a place tells of a number that it barely knows is not taken for a prediction of the other place.
TEST(LeftOut, ANumberThatOnePlaceAloneTellsIsNotPredictedFromTheOther) {
  for (const double weak : {0.0, 1e-7, 1e-5, 1e-3, 0.05}) {
    const TwoPlaces t(weak);
    EXPECT_NEAR(left_out_rmse(t.model, t.data, t.fit), kSigma, 0.2 * kSigma) << weak;
  }
}

// Where both tell both numbers, it is the fit to either place that is read at the other.
TEST(LeftOut, APlaceIsPredictedByAFitToTheOther) {
  const TwoPlaces t(0.7);
  double squares = 0.0;
  for (const Eigen::Index other : {0, 1}) {
    const auto in = static_cast<std::size_t>(other);
    const std::size_t out = 1 - in;
    const Eigen::VectorXd left = t.data.measured[in] - t.fit.evaluation.force[in];
    const Eigen::MatrixXd& by = t.fit.evaluation.by[in];
    const Eigen::VectorXd step = (by.transpose() * by).inverse() * (by.transpose() * left);
    squares +=
        (t.data.measured[out] - t.fit.evaluation.force[out] - t.fit.evaluation.by[out] * step).squaredNorm();
  }
  EXPECT_NEAR(left_out_rmse(t.model, t.data, t.fit), std::sqrt(squares / (2 * kReadings)), 1e-9);
}

// The directions are those in which the residual changes by one, and the covariance is made of them.
TEST(LeftOut, DirectionsAreOfUnitChangeAndLeaveOutWhatNothingTells) {
  Eigen::MatrixXd jacobian(5, 3);
  jacobian << 1e3, 2.0, 0.0, 2e3, 1.0, 0.0, 1e3, 4.0, 0.0, -1e3, 0.5, 0.0, 3e3, 1.0, 0.0;
  const Eigen::MatrixXd directions = unit_directions(jacobian);
  ASSERT_EQ(directions.cols(), 2);
  EXPECT_LT(
      (directions.transpose() * jacobian.transpose() * jacobian * directions - Eigen::Matrix2d::Identity())
          .norm(),
      1e-12);
  const Eigen::Matrix2d inverse = (jacobian.leftCols(2).transpose() * jacobian.leftCols(2)).inverse();
  const Eigen::MatrixXd covariance = covariance_of(jacobian);
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) EXPECT_NEAR(covariance(i, j), inverse(i, j), 1e-10 * std::abs(inverse(i, j)));
  }
  EXPECT_EQ(covariance(2, 2), 0.0);
}

}  // namespace
}  // namespace snare::identification
