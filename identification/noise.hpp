#pragma once

#include "identification/experiment.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace snare::identification {

/// Noise of the readings, and the whitening that makes it independent of unit variance.  theory.md (I.3)
struct Noise {
  std::vector<double> sigma;  ///< of one reading, one a series [N], > 0
  double correlation = 0.0;   ///< of neighbouring readings along the path, in [0, 1): first-order autoregression
  std::string source;         ///< "declared", "replicates" or "residual"

  /// (r_i - phi r_{i-1}) / (sigma sqrt(1 - phi^2)), the first r_0 / sigma. By columns.
  [[nodiscard]] Eigen::MatrixXd whiten(std::size_t series, const Eigen::MatrixXd& values) const;
  /// Mean standard deviation over all readings [N].
  [[nodiscard]] double mean_sigma(const std::vector<Series>& series) const;
};

/// Series that repeat each other: the same test and overlapping travel. Groups of two or more, as indices.
[[nodiscard]] std::vector<std::vector<std::size_t>> replicates(const std::vector<Series>& series);

/// The noise that the file declares (every series has force_sigma_N or a law), else that of replicates about their
/// mean, else (sigma empty) none is known before a fit.
[[nodiscard]] Noise known_noise(const std::vector<Series>& series);

/// Noise of records from the residuals of a fit, whatever smooth misfit they have: from second differences,
/// sigma^2 = mean (r_{i-1} - 2 r_i + r_{i+1})^2 / 6 (Gasser, Sroka and Jennen-Steinmetz 1986), all series together.
/// Never 0: at least 1e-9 of the range of the forces.
[[nodiscard]] Noise noise_from_residuals(const std::vector<Series>& series, const std::vector<Eigen::VectorXd>& residuals);

}  // namespace snare::identification
