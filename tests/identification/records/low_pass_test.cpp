#include "identification/records/low_pass.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace snare::identification {
namespace {

Eigen::VectorXd wave(double frequency, double interval, Eigen::Index count) {
  Eigen::VectorXd values(count);
  for (Eigen::Index i = 0; i < count; ++i)
    values[i] = std::sin(2.0 * std::numbers::pi * frequency * interval * static_cast<double>(i));
  return values;
}

// Amplitude 1/(1 + (w/w_c)^8) with the frequencies warped by the bilinear transform, w = tan(pi f dt), and no
// delay: within 1e-6 in the middle, where the ends have died out.
TEST(LowPass, PassesTheShareOfButterworthWithoutDelay) {
  constexpr double interval = 1e-3, cutoff = 40.0;
  for (const double frequency : {0.5, 10.0, 30.0, 40.0, 60.0, 120.0}) {
    const Eigen::VectorXd in = wave(frequency, interval, 4001);
    const Eigen::VectorXd out = low_passed(in, interval, cutoff);
    const double ratio =
        std::tan(std::numbers::pi * frequency * interval) / std::tan(std::numbers::pi * cutoff * interval);
    const double share = 1.0 / (1.0 + std::pow(ratio, 8));
    const Eigen::VectorXd error = (out - share * in).segment(1000, 2001);
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-6) << frequency;
  }
}

// A straight line passes as it is, also at the ends.
TEST(LowPass, KeepsAStraightLine) {
  const Eigen::VectorXd line = Eigen::VectorXd::LinSpaced(300, 3.0, 9.0);
  EXPECT_LT((low_passed(line, 0.01, 5.0) - line).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(LowPass, TakesShortRecords) {
  const Eigen::VectorXd two = Eigen::VectorXd::LinSpaced(2, 1.0, 2.0);
  EXPECT_TRUE(low_passed(two, 0.01, 5.0).allFinite());
  EXPECT_EQ(low_passed(two.head(1), 0.01, 5.0)[0], 1.0);
}

}  // namespace
}  // namespace snare::identification
