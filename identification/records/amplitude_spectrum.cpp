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
  // A frequency on turns every reading by its own angle once more.
  const Eigen::ArrayXd angle = 2.0 * std::numbers::pi / length * (times.array() - times[0]);
  Eigen::ArrayXcd turn(n), turned = (values.array() - values.mean()).cast<std::complex<double>>();
  turn.real() = angle.cos();
  turn.imag() = angle.sin();
  for (Eigen::Index k = 0; k < count; ++k) {
    turned *= turn;
    spectrum.amplitudes[k] = 2.0 / static_cast<double>(n) * std::abs(turned.sum());
  }
  return spectrum;
}

}  // namespace snare::identification
