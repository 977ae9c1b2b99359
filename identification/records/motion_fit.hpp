#pragma once

#include "identification/records/motion_data.hpp"

#include <vector>

namespace snare::identification {

/// Least squares of the free simulation: (I.20). Gauss-Newton (Levenberg-Marquardt, bounds) with differences in parallel;
/// or Nelder and Mead's simplex by NLopt, without derivatives on its way.
[[nodiscard]] MotionFit fit_motion(const MotionModel& model, const MotionData& data, std::vector<MotionSetting> start,
                                   const MotionFitOptions& options = {});

/// How derivatives are taken from simulations.
enum class Differences {
  central,  ///< two simulations a number: for scores and covariances
  forward   ///< one: for the way to a minimum, which they do not move
};

/// Derivatives of the stacked signal [-] by some numbers, each times the number's scale: differences of a tenth of the scale, one-sided
/// at a bound. A column whose simulations fail is zero. `base`: predictions at `settings`.
[[nodiscard]] Eigen::MatrixXd signal_derivatives(const MotionModel& model, const MotionData& data,
                                                 const std::vector<MotionSetting>& settings,
                                                 const std::vector<RecordPrediction>& base,
                                                 const std::vector<MotionSetting>& fixed = {},
                                                 Differences differences = Differences::central);

}  // namespace snare::identification
