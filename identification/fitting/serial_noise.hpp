#pragma once

#include "identification/fitting/least_squares.hpp"

#include <optional>

namespace snare::identification {

/// Noise of single records that resembles itself from reading to reading: independent noise beside a part that forgets
/// within `length` readings (of a record with times: within as many mean intervals),
///   covariance of two readings  sigma^2 [(1 - smooth) [i = j] + smooth exp(-|i - j| / length)].   theory.md (I.35)
struct SerialNoise {
  double sigma = 0.0;      ///< of one reading [N]
  double smooth = 0.0;     ///< share of the variance that is correlated, in (0, 1)
  double length = 0.0;     ///< of the correlation [readings]
  double effective = 0.0;  ///< independent readings that say as much as all
  double evidence = 0.0;   ///< by which -2 log of the restricted likelihood falls against independent noise
};

/// The serial noise of what a fit leaves, by restricted maximum likelihood over a grid of shares and lengths, all series
/// together; sigma free, or kept at `declared` of every series, one noise for all series. None where it does not fall by
/// more than two numbers are worth, and where there are published fits.
[[nodiscard]] std::optional<SerialNoise> serial_noise(const Model& model, const Data& data, const Fit& fit);

/// -2 log of the likelihood of what a fit leaves [-], of independent noise or beside a serial part, whichever is less with its
/// numbers counted as Schwarz (1978) does, sigma free; the fitted numbers counted, too. To compare models of the same readings.
[[nodiscard]] double serial_criterion(const Model& model, const Data& data, const Fit& fit);

/// The noise of the data with this correlation: of every series its share and its sigma; declared ones stay.
[[nodiscard]] Noise with_serial_part(const Model& model, const Noise& noise, const SerialNoise& serial);

}  // namespace snare::identification
