#pragma once

#include "identification/fitting/model.hpp"
#include "identification/fitting/published_likelihood.hpp"

#include <array>
#include <vector>

namespace snare::identification {

/// The published numbers of one series beside those that a computed curve would have given.
struct FitComparison {
  std::array<double, 3> published{};  ///< A [N/m^2], B [N/m], C [N]
  std::array<double, 3> computed{};   ///< of the same fit to the computed curve
  std::array<double, 3> deviation{};  ///< standard deviations of the published ones
  double chi2 = 0.0;                  ///< of the three
  double published_r2 = 0.0;
  double computed_r2 = 0.0;  ///< expected of the computed curve with this scatter [-]
  double scatter = 0.0;      ///< standard deviation of a lost reading of this series [N]
};

/// Published fits of all series against the curves that fit them best.                       theory.md (I.11)
struct SummaryStatistics {
  double chi2 = 0.0;  ///< deviance of coefficients and R2 [-]; may be negative
  double coefficients =
      0.0;           ///< |Q^T (y - F)|^2 / sigma^2 of all coefficients, by the corrected standard deviation
  double dof = 0.0;  ///< printed numbers less fitted ones and estimated standard deviations
  std::size_t numbers = 0;  ///< fitted ones
  double p = 1.0;  ///< that lost readings of this model give as large a misfit, by a parametric bootstrap
  double scatter = 0.0;               ///< common standard deviation of a lost reading, its bias corrected [N]
  std::vector<Setting> settings;      ///< of greatest likelihood: the fitted ones, then the fixed ones
  std::vector<FitComparison> series;  ///< those with a law, in their order
};

/// P of SummaryStatistics below which the model is rejected. A few published fits cannot support a finer
/// statement.
inline constexpr double least_published_p = 0.01;

/// Replicates of the bootstrap, and the least P that it can give.
inline constexpr int published_replicates = 999;
inline constexpr double least_bootstrap_p = 1.0 / (published_replicates + 1);

/// How the published fits of some of a model's series are compared with it.
struct SummaryOptions {
  PublishedScatter scatter = PublishedScatter::common;
  /// Of the bootstrap, >= 99; P is a multiple of 1 / (replicates + 1).
  int replicates = published_replicates;
  bool bootstrap = true;  ///< else p is 1 and the scatter is that of greatest likelihood
};

/// Fits the first `free` of `settings` to the published numbers by maximum likelihood, from where they are,
/// and finds how often such a misfit comes by chance. As many lost readings are assumed as a series has
/// travels, placed as they are. series: of the model, those that count; ones without a law are left out. The
/// same bits for the same input.
[[nodiscard]] SummaryStatistics summary_statistics(const Model& model, const std::vector<std::size_t>& series,
                                                   const std::vector<Setting>& settings, std::size_t free,
                                                   const SummaryOptions& options = {});

/// P that a set of lost readings of the curves at `best` gives a misfit as large, by a parametric bootstrap
/// with linear curves, which need no solves; sigma, corrected: the standard deviation is divided by its own
/// bias first.
struct BootstrapResult {
  double p = 1.0;
  double bias = 1.0;  ///< mean of the estimated variance over the true one [-]
};
[[nodiscard]] BootstrapResult published_bootstrap(const PublishedDeviance& deviance,
                                                  const PublishedDeviance::Point& best, int replicates);

}  // namespace snare::identification
