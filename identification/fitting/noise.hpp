#pragma once

#include "identification/fitting/experiment.hpp"
#include "identification/fitting/published_likelihood.hpp"

#include <Eigen/Core>

#include <limits>
#include <string>
#include <vector>

namespace snare::identification {

/// Noise of the readings, and the whitening that makes it independent of unit variance.  theory.md (I.3)
///
/// Two readings of a series, i and j, have the covariance
///   w^2 [i = j] + h_i h_j exp(-|s_i - s_j| / length),   h_i^2 = a^2 + (b F_i)^2,
/// s the path that the pusher has travelled and F the computed force: independent noise, and specimens that
/// differ smoothly, by a force or by a share of it.
struct Noise {
  std::vector<double> sigma;  ///< of one reading, its root mean square over the series, one a series [N], > 0
  double smooth = 0.0;        ///< share of the variance that is correlated along the path, in [0, 1)
  double length = 0.0;    ///< of the correlation along the path [m], > 0 where replicates have a smooth part
  double readings = 0.0;  ///< correlation length of single records, in readings; 0: independent
  double dof =
      std::numeric_limits<double>::infinity();  ///< degrees of freedom of the estimate; infinite: declared
  std::string source;                           ///< "declared", "replicates" or "residual"

  /// One reading of a series in the recursion that whitens: see noise_filter.cpp.
  struct Step {
    double decay = 0.0;    ///< exp(-ds / length) since the reading before
    double height = 0.0;   ///< h_i [N]
    double gain = 0.0;     ///< of the smooth part's state, by a reading [1/N]
    double inverse = 0.0;  ///< 1 / standard deviation of the reading given those before [1/N]
  };
  std::vector<std::vector<Step>> filter;  ///< one a series; empty without correlation
  /// Series of which a fit was published, one a series; none for others. Empty where no series has one.
  ///                                                                                                   (I.11)
  std::vector<std::optional<PublishedRows>> published;
  PublishedScatter scatter = PublishedScatter::common;  ///< of published fits
  /// Standard deviations of published fits that are estimated with the fitted numbers.
  double estimated = 0.0;

  /// Whether only a fit was published of a series, so that it has four numbers and no readings.
  [[nodiscard]] bool summarised(std::size_t series) const { return !published.empty() && published[series]; }
  /// Whitened numbers of a series of `readings`.
  [[nodiscard]] Eigen::Index rows(std::size_t series, Eigen::Index readings) const {
    return summarised(series) ? PublishedRows::count : readings;
  }
  /// Sets the standard deviation of a lost reading of a series with a published fit [N], > 0.
  void set_published_sigma(std::size_t series, double sigma);

  /// L^-1 values [-], L L^T the covariance [N^2]. By columns of values [N]; as many operations as values. The
  /// last row of a published fit, which depends on the force itself, is zero: see PublishedRows.
  [[nodiscard]] Eigen::MatrixXd whiten(std::size_t series, const Eigen::MatrixXd& values) const;
  /// Mean standard deviation over all readings [N].
  [[nodiscard]] double mean_sigma(const std::vector<Series>& series) const;
};

/// The filter of readings at the coordinates `at`: independent noise of `white` [N], > 0, plus a smooth part
/// of the heights
/// `height` [N] whose correlation decays over `length`, in the unit of the coordinates.   theory.md (I.3)
[[nodiscard]] std::vector<Noise::Step> noise_filter(const std::vector<double>& at, double white,
                                                    double length, const std::vector<double>& height);

/// The noise that the file declares (every series has force_sigma_N or a law); else sigma is empty and none
/// is known before a fit. Published fits that declare none have the scatter about parabolas, an upper bound,
/// until a fit says more.
[[nodiscard]] Noise declared_noise(const std::vector<Series>& series,
                                   PublishedScatter scatter = PublishedScatter::common);

/// The noise from what a fit leaves: of replicates about each other, by restricted maximum likelihood (an
/// independent and a smooth part); without replicates from second differences,
///   sigma^2 = mean (r_{i-1} - 2 r_i + r_{i+1})^2 / 6 (Gasser, Sroka and Jennen-Steinmetz 1986),
/// all series together, whatever smooth misfit the fit has. Never 0: at least 1e-9 of the range of the
/// forces.
/// residuals, computed: measured less computed force and computed force, one vector a series [N].
///                                                                                            theory.md (I.3)
[[nodiscard]] Noise noise_from_residuals(const std::vector<Series>& series,
                                         const std::vector<Eigen::VectorXd>& residuals,
                                         const std::vector<Eigen::VectorXd>& computed);

}  // namespace snare::identification
