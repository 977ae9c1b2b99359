#pragma once

#include "identification/fitting/experiment.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace snare::identification {

/// Noise of the readings, and the whitening that makes it independent of unit variance.  theory.md (I.3)
///
/// The covariance of two readings of a series is
///   sigma^2 ((1 - smooth) [i = j] + smooth exp(-|path_i - path_j| / length)),
/// the path being what the pusher has travelled: independent noise, and specimens that differ smoothly.
struct Noise {
  std::vector<double> sigma;            ///< of one reading, one a series [N], > 0
  double smooth = 0.0;                  ///< share of the variance that is correlated along the path, in [0, 1)
  double length = 0.0;                  ///< of the correlation [m], > 0 where smooth > 0
  std::string source;                   ///< "declared", "replicates" or "residual"
  std::vector<Eigen::MatrixXd> factor;  ///< Cholesky factor of the covariance, one a series; empty without correlation

  /// L^-1 values, L L^T the covariance. By columns.
  [[nodiscard]] Eigen::MatrixXd whiten(std::size_t series, const Eigen::MatrixXd& values) const;
  /// Mean standard deviation over all readings [N].
  [[nodiscard]] double mean_sigma(const std::vector<Series>& series) const;
};

/// Series that repeat each other: the same test and overlapping travel. Groups of two or more, as indices.
[[nodiscard]] std::vector<std::vector<std::size_t>> replicates(const std::vector<Series>& series);

/// The noise that the file declares (every series has force_sigma_N or a law), else that of replicates about their mean
/// (independent part from second differences, the rest smooth, its length where the correlation has fallen to 1/e;
/// records of more than 2000 readings count as independent), else (sigma empty) none is known before a fit.
[[nodiscard]] Noise known_noise(const std::vector<Series>& series);

/// Noise of records from the residuals of a fit, whatever smooth misfit they have: from second differences,
/// sigma^2 = mean (r_{i-1} - 2 r_i + r_{i+1})^2 / 6 (Gasser, Sroka and Jennen-Steinmetz 1986), all series together.
/// Never 0: at least 1e-9 of the range of the forces.
[[nodiscard]] Noise noise_from_residuals(const std::vector<Series>& series,
                                         const std::vector<Eigen::VectorXd>& residuals);

}  // namespace snare::identification
