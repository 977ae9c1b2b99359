// Autocorrelated noise of single records, in linear models where generalised least squares is exact.

#include "identification/fitting/serial_noise.hpp"

#include "identification/effects/catalogue.hpp"
#include "identification/fitting/statistics.hpp"
#include "tests/support/declared_wire.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace snare::identification {
namespace {

using test::mm;

/// Two series of `readings`, a straight line in each with one common slope, and AR(1) noise about it.
struct LinearRecords {
  Model model;
  Data data;
  Fit fit;

  LinearRecords(int readings, double decay, double sigma, std::mt19937& random)
      : model(series(readings), {}) {
    std::normal_distribution<double> normal;
    fit.settings = {{&parameters().at("wire.axial_stiffness_N"), 0.0}};
    fit.free = 1;
    for (std::size_t k = 0; k < 2; ++k) {
      data.series.push_back(k);
      Eigen::VectorXd noise(readings), slope(readings);
      double last = normal(random);
      for (int i = 0; i < readings; ++i) {
        if (i > 0) last = decay * last + std::sqrt(1.0 - decay * decay) * normal(random);
        noise[i] = sigma * last;
        slope[i] = static_cast<double>(i) / readings;
      }
      data.measured.push_back(noise);
      data.noise.sigma.push_back(1.0);
      fit.evaluation.force.emplace_back(Eigen::VectorXd::Zero(readings));
      fit.evaluation.by.emplace_back(slope);
    }
    data.noise.source = "residual";
  }

  static std::vector<Series> series(int readings) {
    std::vector<Series> all(2);
    for (Series& s : all) {
      s.name = "s" + std::to_string(&s - all.data());
      s.test = test::declared_wire(90.0 * mm, 0.0);
      s.readings = Readings{};
      for (int i = 0; i < readings; ++i) s.readings->displacement.push_back(0.1 * mm * i);
      s.readings->force.assign(s.readings->displacement.size(), 0.0);
    }
    return all;
  }

  /// Whether the 95 % interval of the slope, by generalised least squares, holds 0.
  [[nodiscard]] bool holds() {
    const std::optional<SerialNoise> serial = serial_noise(model, data, fit);
    double dof = static_cast<double>(data.rows()) - 1.0;
    if (serial) {
      data.noise = with_serial_part(model, data.noise, *serial);
      dof = std::max(1.0, serial->effective - 1.0);
    }
    const Eigen::VectorXd g = data.jacobian(fit.evaluation);
    const Eigen::VectorXd r = data.residual(fit.evaluation);
    const double slope = g.dot(r) / g.squaredNorm();
    double deviation = 1.0 / g.norm();
    if (!serial) deviation *= std::sqrt((r - slope * g).squaredNorm() / dof);
    return std::abs(slope) < student_quantile(0.025, dof) * deviation;
  }
};

TEST(SerialNoise, OfIndependentNoiseIsNone) {
  std::mt19937 random(2);
  int found = 0;
  for (int k = 0; k < 100; ++k) {
    const LinearRecords records(40, 0.0, 0.2, random);
    found += serial_noise(records.model, records.data, records.fit) ? 1 : 0;
  }
  // The chi-square of two numbers exceeds 6 in 5 %; the standard error of 100 is 2 %.
  EXPECT_LE(found, 11);
}

TEST(SerialNoise, FindsSizeAndLength) {
  std::mt19937 random(3);
  const LinearRecords records(3000, 0.8, 0.2, random);
  const std::optional<SerialNoise> serial = serial_noise(records.model, records.data, records.fit);
  ASSERT_TRUE(serial);
  // AR(1): all of it is correlated, exp(-1 / length) = 0.8. The grid's steps are 1.4; 6,000 readings say as
  // much as 667.
  EXPECT_GT(serial->smooth, 0.9);
  EXPECT_NEAR(std::log(serial->length * -std::log(0.8)), 0.0, 0.35);
  EXPECT_NEAR(serial->sigma, 0.2, 0.02);
  EXPECT_NEAR(serial->effective, 667.0, 300.0);
}

// 95 % intervals hold in at least nine of ten sets, of which independent noise would give 35 to 65 %.
TEST(SerialNoise, IntervalsHold) {
  for (const double decay : {0.0, 0.5, 0.7, 0.9}) {
    std::mt19937 random(4);
    int held = 0;
    constexpr int sets = 200;
    for (int k = 0; k < sets; ++k) held += LinearRecords(60, decay, 0.2, random).holds() ? 1 : 0;
    EXPECT_GE(held, 0.9 * sets) << decay;
  }
}

}  // namespace
}  // namespace snare::identification
