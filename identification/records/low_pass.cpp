#include "identification/records/low_pass.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace snare::identification {

namespace {

/// A section of the second order, y = H u, by the bilinear transform of 1/(1 + s/Q + s^2) with K = tan(pi f_c
/// dt); gain 1 at rest.
struct Section {
  double b0, b1, b2, a1, a2;

  Section(double warped, double quality) {
    const double k = warped, scale = 1.0 / (1.0 + k / quality + k * k);
    b0 = b2 = k * k * scale;
    b1 = 2.0 * b0;
    a1 = 2.0 * (k * k - 1.0) * scale;
    a2 = (1.0 - k / quality + k * k) * scale;
  }
  /// In place, from the state of rest at the first value.
  void run(Eigen::VectorXd& u) const {
    double first = (1.0 - b0) * u[0], second = (b2 - a2) * u[0];
    for (double& value : u) {
      const double y = b0 * value + first;
      first = b1 * value - a1 * y + second;
      second = b2 * value - a2 * y;
      value = y;
    }
  }
};

}  // namespace

Eigen::VectorXd low_passed(const Eigen::VectorXd& values, double interval, double cutoff) {
  const Eigen::Index n = values.size();
  if (n < 2) return values;
  // Poles of the fourth order at 22.5 and 67.5 degrees from the real axis: Q = 1/(2 cos).
  const double warped = std::tan(std::numbers::pi * cutoff * interval);
  const std::array<Section, 2> sections{Section(warped, 0.5 / std::cos(std::numbers::pi / 8.0)),
                                        Section(warped, 0.5 / std::cos(3.0 * std::numbers::pi / 8.0))};
  // of the cutoff: the ringing has died out to exp(-2 pi 6 cos 67.5 deg), a millionth
  constexpr double periods = 6.0;
  const Eigen::Index beyond =
      std::min(n - 1, static_cast<Eigen::Index>(std::ceil(periods / (cutoff * interval))));
  Eigen::VectorXd all(n + 2 * beyond);
  all.segment(beyond, n) = values;
  for (Eigen::Index k = 1; k <= beyond; ++k) {
    all[beyond - k] = 2.0 * values[0] - values[k];
    all[beyond + n - 1 + k] = 2.0 * values[n - 1] - values[n - 1 - k];
  }
  for (int way = 0; way < 2; ++way) {
    for (const Section& section : sections) section.run(all);
    all.reverseInPlace();
  }
  return all.segment(beyond, n);
}

}  // namespace snare::identification
