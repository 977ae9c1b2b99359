#pragma once

#include "identification/fitting/experiment.hpp"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace snare::identification {

/// Variance of independent noise from second differences of residuals.
struct Roughness {
  double variance = 0.0;  ///< [N^2]
  double dof = 0.0;       ///< of it: 18 n / 35 for n readings, since its relative variance is 35 / (9 n)
};

/// sigma^2 = mean (r_{i-1} - 2 r_i + r_{i+1})^2 / 6 of residuals [N] over all series; zero where none has
/// three readings.
[[nodiscard]] Roughness roughness_of(const std::vector<Eigen::VectorXd>& residuals);

/// How replicates scatter about each other.                                              theory.md (I.3)
struct ReplicateScatter {
  double white = 0.0;   ///< of independent noise [N]
  double height = 0.0;  ///< a, of the smooth part where there is no force [N]
  double share = 0.0;   ///< b, of the smooth part as a share of the force
  double length = 0.0;  ///< of its correlation along the path [m]; 0 without a smooth part
  double dof = 0.0;     ///< degrees of freedom of the smooth part's variance, of all without one

  /// sqrt(a^2 + (b F)^2) at every computed force [N].
  [[nodiscard]] std::vector<double> heights(const Eigen::VectorXd& computed) const;
};

/// The scatter of the replicates among `series`, by restricted maximum likelihood: residuals are averaged
/// over cells of the path that all replicates of a condition have, their mean over the replicates taken out
/// whatever it is. None where no condition has two series with four cells in common. residuals, computed: one
/// vector a series [N].
[[nodiscard]] std::optional<ReplicateScatter> replicate_scatter(const std::vector<Series>& series,
                                                                const std::vector<Eigen::VectorXd>& residuals,
                                                                const std::vector<Eigen::VectorXd>& computed,
                                                                const Roughness& roughness);

}  // namespace snare::identification
