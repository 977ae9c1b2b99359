#include "identification/fitting/data.hpp"

#include "identification/effects/catalogue.hpp"
#include "identification/fitting/conditions.hpp"
#include "identification/fitting/least_squares.hpp"
#include "tests/support/declared_wire.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace snare::identification {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::mm;

constexpr double kPlace = 0.02 * mm;
constexpr int kReadings = 15;

/// Two records at 40 mm and one at 90 mm, with noise that hangs together, of a linear model of two numbers.
struct ThreeRecords {
  Model model;
  Data data;
  Fit fit;

  ThreeRecords() : model(series(), {}) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    const auto drawn = [&](double size) {
      VectorXd x(kReadings);
      for (double& v : x) v = size * normal(random);
      return x;
    };
    fit.settings = {{&parameters().at("wire.axial_stiffness_N"), 0.0},
                    {&parameters().at("wire.length_mm"), 0.0}};
    fit.free = 2;
    for (std::size_t k = 0; k < 3; ++k) {
      data.series.push_back(k);
      data.measured.push_back(drawn(0.3));
      fit.evaluation.force.emplace_back(VectorXd::Zero(kReadings));
      MatrixXd by(kReadings, 2);
      by << drawn(1.0), drawn(1.0);
      fit.evaluation.by.push_back(by);
      data.noise.sigma.push_back(0.1);
      std::vector<double> height;
      for (int i = 0; i < kReadings; ++i) height.push_back(0.02 * i);
      data.noise.filter.push_back(
          noise_filter(measured_displacement(model.series()[k]), 0.05, 0.5 * mm, height));
    }
    for (const std::vector<std::size_t>& group : tests(model.series())) {
      Placing placing{group, kPlace, {}};
      for (std::size_t i = 0; i < group.size(); ++i) placing.by.push_back(drawn(0.2 / kPlace));
      data.placings.push_back(placing);
    }
  }

  /// L^-1 of the noise alone.
  [[nodiscard]] MatrixXd white(const std::function<MatrixXd(std::size_t)>& forces,
                               Eigen::Index columns) const {
    Data noise = data;
    noise.placings.clear();
    return noise.whiten(forces, columns);
  }
  /// The columns of one placing, over all readings, times its standard deviation.
  [[nodiscard]] VectorXd change(const Placing& p) const {
    return white(
        [&](std::size_t k) -> MatrixXd {
          for (std::size_t i = 0; i < p.series.size(); ++i) {
            if (p.series[i] == k) return p.sigma * p.by[i];
          }
          return VectorXd::Zero(kReadings);
        },
        1);
  }

 private:
  static std::vector<Series> series() {
    std::vector<Series> result(3);
    for (std::size_t k = 0; k < 3; ++k) {
      result[k].name = "p" + std::to_string(k);
      result[k].test = test::declared_wire(k < 2 ? 40.0 * mm : 90.0 * mm, 6.0 * mm);
      for (int i = 1; i <= kReadings; ++i) result[k].test.travel.push_back(1.5 * mm * i / kReadings);
      result[k].readings = Readings{result[k].test.travel, std::vector<double>(kReadings, 0.0), {}};
      result[k].position_sigma = kPlace;
    }
    return result;
  }
};

// W V W^T = 1 with V = V_n + sum u u^T; in the coordinates in which the noise is white, V_n = 1.
TEST(Data, ErrorsOfPlacesAreWhitenedWithTheNoise) {
  const ThreeRecords r;
  const auto n = static_cast<Eigen::Index>(3 * kReadings);
  ASSERT_EQ(r.data.placings.size(), 2);
  EXPECT_EQ(r.data.placings[0].series, (std::vector<std::size_t>{0, 1}));
  const MatrixXd unit = MatrixXd::Identity(n, n);
  const auto forces = [&](std::size_t k) -> MatrixXd {
    return unit.middleRows(static_cast<Eigen::Index>(k) * kReadings, kReadings);
  };
  MatrixXd covariance = unit;
  for (const Placing& p : r.data.placings) covariance += r.change(p) * r.change(p).transpose();
  const MatrixXd of_noise = r.white(forces, n);
  const MatrixXd w = r.data.whiten(forces, n) * of_noise.inverse();
  EXPECT_LT((w * covariance * w.transpose() - unit).norm(), 1e-11);  // roundings
}

// The same from a regression in which every place is a number of its own with one reading more, that of its
// tolerance: chi2, the covariance of the numbers, the places and their errors.
TEST(Data, PlacesAreNumbersWithATolerance) {
  ThreeRecords r;
  const MatrixXd j = r.white([&](std::size_t k) { return r.fit.evaluation.by[k]; }, 2);
  const VectorXd y = r.white([&](std::size_t k) { return r.data.measured[k]; }, 1);
  MatrixXd all = MatrixXd::Zero(y.size() + 2, 4);
  all.topLeftCorner(y.size(), 2) = j;
  for (Eigen::Index c = 0; c < 2; ++c)
    all.col(2 + c).head(y.size()) = r.change(r.data.placings[static_cast<std::size_t>(c)]);
  all.bottomRightCorner(2, 2).setIdentity();
  VectorXd wanted = VectorXd::Zero(y.size() + 2);
  wanted.head(y.size()) = y;
  const MatrixXd covariance = (all.transpose() * all).inverse();
  const VectorXd found = covariance * (all.transpose() * wanted);

  r.fit.jacobian = r.data.jacobian(r.fit.evaluation);
  r.fit.covariance = covariance_of(r.fit.jacobian);
  EXPECT_LT((r.fit.covariance - covariance.topLeftCorner(2, 2)).norm(), 1e-11 * covariance.norm());
  const VectorXd numbers =
      r.fit.covariance * (r.fit.jacobian.transpose() * r.data.residual(r.fit.evaluation));
  EXPECT_LT((numbers - found.head(2)).norm(), 1e-11 * found.norm());
  for (std::size_t k = 0; k < 3; ++k) r.fit.evaluation.force[k] += r.fit.evaluation.by[k] * numbers;
  EXPECT_NEAR(r.data.residual(r.fit.evaluation).squaredNorm(), (all * found - wanted).squaredNorm(), 1e-10);

  const std::vector<PlaceEstimate> places = r.data.places(r.model, r.fit.evaluation, r.fit.covariance);
  ASSERT_EQ(places.size(), 2);
  EXPECT_EQ(places[0].series, (std::vector<std::string>{"p0", "p1"}));
  for (Eigen::Index c = 0; c < 2; ++c) {
    const PlaceEstimate& place = places[static_cast<std::size_t>(c)];
    EXPECT_NEAR(place.shift, kPlace * found[2 + c], 1e-11 * kPlace);
    EXPECT_NEAR(place.standard_error, kPlace * std::sqrt(covariance(2 + c, 2 + c)), 1e-11 * kPlace);
    EXPECT_EQ(place.sigma, kPlace);
  }
  // What is left as a force, in the coordinates of the noise: the readings less numbers and places.
  const std::vector<MatrixXd> left =
      r.data.placed([&](std::size_t k) { return r.data.measured[k] - r.fit.evaluation.force[k]; }, 1);
  const VectorXd white = r.white([&](std::size_t k) { return left[k]; }, 1);
  EXPECT_LT((white - (wanted - all * found).head(y.size())).norm(), 1e-10);
}

// The derivative by the place is that of the model's own curves.
TEST(Data, PlacingsAreThoseOfTheModel) {
  const ThreeRecords r;
  const Parameter& place = parameters().at(place_key);
  const std::vector<Placing> found = find_placings(r.model, {}, place);
  ASSERT_EQ(found.size(), 2);
  const double step = 1e-6;
  const Evaluation up = r.model.evaluate({{&place, step}});
  const Evaluation down = r.model.evaluate({{&place, -step}});
  ASSERT_TRUE(up.complete && down.complete);
  for (const Placing& p : found) {
    EXPECT_EQ(p.sigma, kPlace);
    for (std::size_t i = 0; i < p.series.size(); ++i) {
      const VectorXd difference = (up.force[p.series[i]] - down.force[p.series[i]]) / (2.0 * step);
      EXPECT_LT((p.by[i] - difference).norm(), 1e-4 * difference.norm());
    }
  }
  std::vector<Series> exact = r.model.series();
  for (Series& s : exact) s.position_sigma = 0.0;
  EXPECT_TRUE(find_placings(Model(exact, {}), {}, place).empty());
}

}  // namespace
}  // namespace snare::identification
