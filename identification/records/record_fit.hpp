#pragma once

#include "identification/records/record_data.hpp"

#include <vector>

namespace snare::identification {

/// Least squares of the free simulation: (I.20). Gauss-Newton (Levenberg-Marquardt, bounds) with differences
/// in parallel; or Nelder and Mead's simplex by NLopt, without derivatives on its way.
[[nodiscard]] RecordFit fit_motion(const RecordModel& model, const RecordData& data,
                                   std::vector<RecordSetting> start, const RecordFitOptions& options = {});

/// How derivatives are taken from simulations.
enum class Differences {
  central,  ///< two simulations a number: for scores and covariances
  forward   ///< one: for the way to a minimum, which they do not move
};

/// Derivatives of the stacked signal [-] by some numbers, each times the number's scale: differences of a
/// tenth of the scale, one-sided at a bound. A column whose simulations fail is zero. `base`: predictions at
/// `settings`; widen: factor of the steps, > 0.
[[nodiscard]] Eigen::MatrixXd signal_derivatives(const RecordModel& model, const RecordData& data,
                                                 const std::vector<RecordSetting>& settings,
                                                 const std::vector<RecordPrediction>& base,
                                                 const std::vector<RecordSetting>& fixed = {},
                                                 Differences differences = Differences::central,
                                                 double widen = 1.0);

}  // namespace snare::identification
