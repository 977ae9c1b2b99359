#pragma once

#include "identification/fitting/experiment.hpp"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace snare::identification {

/// A published fit F = A d^2 + B d + C is a summary of lost readings: their projection on (d^2, d, 1).  theory.md (I.11)

/// Q^T, (3, n): an orthonormal basis of the quadratics over these travels [m], n >= 3, as rows. Of readings
/// y = F(d) + e, e of variance sigma^2, Q^T y has the covariance sigma^2 I.
[[nodiscard]] Eigen::MatrixXd quadratic_basis(const std::vector<double>& travel);

/// The published numbers of one series beside those that a computed curve would have given.
struct FitComparison {
  std::array<double, 3> published{};  ///< A [N/m^2], B [N/m], C [N]
  std::array<double, 3> computed{};   ///< of the same fit to the computed curve
  std::array<double, 3> deviation{};  ///< standard deviations of the published ones
  double chi2 = 0.0;                  ///< of the three
  double published_r2 = 0.0;
  double computed_r2 = 0.0;  ///< expected of the computed curve with the common scatter [-]
  double scatter = 0.0;      ///< of one lost reading, from R^2, less what the curve has beside a parabola, but a
                             ///< quarter of its squares at least [N]
};

/// Published fits of all series against the computed curves.                                        theory.md (I.11)
struct SummaryStatistics {
  double chi2 = 0.0;          ///< of three coefficients a series, each by its own scatter, and of the scatters [-]
                              ///< about a common one
  double coefficients = 0.0;  ///< the coefficients' part
  double dof = 0.0;
  std::size_t numbers = 0;  ///< fitted; the common scatter is one more
  double p = 1.0;           ///< that chi2 would be as large, by F: the scatters are estimates themselves
  double scatter = 0.0;     ///< common to all [N]
  std::vector<FitComparison> series;
};

/// P of SummaryStatistics below which the numbers do not do. Of a few published fits no more can be told.
inline constexpr double least_published_p = 0.01;

/// Compares the published fits of `series` with computed forces [N] at their travels, one vector a series; series
/// without a law are left out. As many lost readings are assumed as there are travels, placed as they are.
[[nodiscard]] SummaryStatistics summary_statistics(const std::vector<Series>& series,
                                                   const std::vector<std::vector<double>>& force, std::size_t numbers);

}  // namespace snare::identification
