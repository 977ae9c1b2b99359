#include "identification/records/amplitude_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace snare::identification {

AmplitudeSpectrum amplitude_spectrum(const Eigen::VectorXd& times, const Eigen::VectorXd& values) {
  constexpr Eigen::Index fewest = 8, most_frequencies = 400, least_frequencies = 20, most_terms = 40'000'000;
  const Eigen::Index n = values.size();
  AmplitudeSpectrum spectrum;
  if (n < fewest || !(times[n - 1] > times[0])) return spectrum;
  const double length = times[n - 1] - times[0];
  const Eigen::Index affordable = std::max(least_frequencies, most_terms / n);
  const Eigen::Index count = std::min({(n - 1) / 2, most_frequencies, affordable});
  spectrum.frequencies = Eigen::VectorXd::LinSpaced(count, 1.0, static_cast<double>(count)) / length;
  spectrum.amplitudes.resize(count);
  const Eigen::ArrayXd beside = values.array() - values.mean();
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::ArrayXd phase = 2.0 * std::numbers::pi * spectrum.frequencies[k] * (times.array() - times[0]);
    const std::complex<double> sum((beside * phase.cos()).sum(), (beside * phase.sin()).sum());
    spectrum.amplitudes[k] = 2.0 / static_cast<double>(n) * std::abs(sum);
  }
  return spectrum;
}

}  // namespace snare::identification
