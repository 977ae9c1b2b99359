#pragma once

#include "identification/fitting/least_squares.hpp"

#include <optional>

namespace snare::identification {

/// Autocorrelated noise of single records: independent noise plus a part whose correlation decays over
/// `length` readings (in a record with times: over as many mean intervals),
///   covariance of two readings  sigma^2 [(1 - smooth) [i = j] + smooth exp(-|i - j| / length)].
///                                                                                           theory.md (I.35)
struct SerialNoise {
  double sigma = 0.0;      ///< of one reading [N]
  double smooth = 0.0;     ///< share of the variance that is correlated, in (0, 1)
  double length = 0.0;     ///< of the correlation [readings]
  double effective = 0.0;  ///< independent readings that say as much as all
  double evidence = 0.0;   ///< by which -2 log of the restricted likelihood falls against independent noise
};

/// Rows of one series in units of sigma, made independent where the noise has this correlation: `smooth` in
/// [0, 1), `length` > 0 in readings, as in SerialNoise.
struct WhitenedRows {
  Eigen::MatrixXd rows;          ///< [-]
  double log_determinant = 0.0;  ///< of the covariance, in units of sigma^2
};
[[nodiscard]] WhitenedRows without_correlation(const Series& series, double smooth, double length,
                                               const Eigen::MatrixXd& rows);

/// The autocorrelated noise of a fit's residual, by restricted maximum likelihood over a grid of shares and
/// lengths, one for all series; sigma is estimated unless it is declared. None where -2 log of the likelihood
/// falls by less than two more numbers are worth, and where there are published fits, replicates or places
/// with a tolerance.
[[nodiscard]] std::optional<SerialNoise> serial_noise(const Model& model, const Data& data, const Fit& fit);

/// Schwarz's criterion of a fit [-]: -2 log of the likelihood of its residual with sigma free, plus log n for
/// every fitted number; with independent or with autocorrelated noise and its two numbers, whichever is less.
/// To compare models of the same readings.
[[nodiscard]] double serial_criterion(const Model& model, const Data& data, const Fit& fit);

/// The noise of the data with this correlation: of every series its share and its sigma; declared ones stay.
[[nodiscard]] Noise with_serial_part(const Model& model, const Noise& noise, const SerialNoise& serial);

}  // namespace snare::identification
