#include "identification/records/amplitude_spectrum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace snare::identification {
namespace {

constexpr double turn = 2.0 * std::numbers::pi;

// Two oscillations on a mean, each over whole cycles of the ten seconds that 2001 readings take.
TEST(AmplitudeSpectrum, FindsTheAmplitudesOfOscillations) {
  const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(2001, 0.0, 10.0);
  const Eigen::VectorXd x =
      (5.0 + 0.3 * (turn * 1.2 * t.array()).sin() + 0.1 * (turn * 7.0 * t.array()).cos()).matrix();
  const AmplitudeSpectrum s = amplitude_spectrum(t, x);
  ASSERT_EQ(s.frequencies.size(), 400);
  for (Eigen::Index k = 0; k < s.frequencies.size(); ++k) {
    EXPECT_NEAR(s.frequencies[k], 0.1 * static_cast<double>(k + 1), 1e-12);
    const double wanted = k == 11 ? 0.3 : k == 69 ? 0.1 : 0.0;
    EXPECT_NEAR(s.amplitudes[k], wanted, 2e-3)
        << s.frequencies[k];  // the last reading counts twice: 1/n of both
  }
}

// Readings at random times: an amplitude of one in 2000 of them is known to about sqrt(2/n).
TEST(AmplitudeSpectrum, TakesTimesThatAreNotEvenlySpaced) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> place(0.0, 20.0);
  std::vector<double> drawn(2000);
  for (double& t : drawn) t = place(engine);
  std::sort(drawn.begin(), drawn.end());
  const Eigen::VectorXd t = Eigen::Map<const Eigen::VectorXd>(drawn.data(), 2000);
  const Eigen::VectorXd x = (turn * 30.0 / (t[1999] - t[0]) * t.array()).sin().matrix();
  const AmplitudeSpectrum s = amplitude_spectrum(t, x);
  Eigen::Index largest = 0;
  EXPECT_NEAR(s.amplitudes.maxCoeff(&largest), 1.0, 0.1);
  EXPECT_EQ(largest, 29);
}

TEST(AmplitudeSpectrum, OfLittleIsNothing) {
  EXPECT_EQ(amplitude_spectrum(Eigen::VectorXd::LinSpaced(7, 0.0, 1.0), Eigen::VectorXd::Ones(7))
                .frequencies.size(),
            0);
  EXPECT_EQ(amplitude_spectrum(Eigen::VectorXd::Zero(9), Eigen::VectorXd::Ones(9)).frequencies.size(), 0);
}

}  // namespace
}  // namespace snare::identification
