#pragma once

#include <Eigen/Core>

namespace snare::identification {

/// Amplitudes at frequencies. Both of one size, frequencies ascending.
struct AmplitudeSpectrum {
  Eigen::VectorXd frequencies;  ///< whole multiples of one over the length of the signal [Hz]
  Eigen::VectorXd amplitudes;   ///< in the unit of the signal
};

/// The spectrum of values less their mean, at times that need not be evenly spaced:          theory.md (I.31)
///   a_k = 2/n |sum_i (x_i - mean) exp(-2 pi i f_k t_i)|,  f_k = k/(t_n - t_1).
/// times: (n) [s], ascending. Up to half a cycle a reading, at most 400 frequencies, of a million readings
/// 40. Nothing of fewer than eight readings, or where all times are one.
[[nodiscard]] AmplitudeSpectrum amplitude_spectrum(const Eigen::VectorXd& times,
                                                   const Eigen::VectorXd& values);

}  // namespace snare::identification
