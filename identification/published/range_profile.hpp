#pragma once

#include "identification/published/curve_likelihood.hpp"

namespace snare::identification {

/// log p of published fits at given ranges and one number of readings by every scatter, common to all series.
struct ByScatter {
  Eigen::ArrayXd log_sigma;  ///< whole multiples of scatter_step, ascending [log N]
  Eigen::ArrayXd log;        ///< [-]
  double most = 0.0;         ///< the largest that `log` can be
};
/// zeros: of the travel [m], one a series, replaced; the ones given are estimates. What is below `floor` is
/// not computed: impossible.
[[nodiscard]] ByScatter by_scatter(const FitCells& cells, std::size_t readings,
                                   const std::vector<TouchCurve>& curves,
                                   std::vector<std::optional<double>>& zeros, double floor);

/// What computed curves make of published fits over all ranges, zeros and scatter (even in its logarithm,
/// Jeffreys) integrated out.
struct RangeProfile {
  /// log p, by range and number of readings; of a bin the mean over it, even in the logarithm of the range;
  /// of own ranges the mean over them.
  std::vector<double> log;
  /// Likewise: the ranges there with the largest p, one a series [m]; empty where nothing is possible.
  std::vector<std::vector<double>> best_to;
  double largest = impossible;  ///< of p over all ranges and numbers of readings
};

/// The profile of curves, one a series; none (no curves): all is impossible. Bins are divided where p changes
/// by more than a factor e and matters: fits that rest on many readings know their range to a few parts in a
/// thousand. Below `floor` log p stands for what it is at most.
[[nodiscard]] RangeProfile range_profile(const FitRanges& ranges, const std::vector<TouchCurve>& curves,
                                         double floor);

}  // namespace snare::identification
