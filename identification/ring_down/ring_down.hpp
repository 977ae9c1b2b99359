#pragma once

#include "identification/ring_down/estimate.hpp"
#include "numerics/report.hpp"

#include <Eigen/Core>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace snare::identification {

/// The displacement of one point of a freely vibrating wire.
struct RingDown {
  std::string name;
  Eigen::VectorXd time;          ///< [s], rising
  Eigen::VectorXd displacement;  ///< [m], as long
  int modes = 1;                 ///< to look for, 1 to 6
  bool friction = true;          ///< whether the largest mode may lose amplitude to friction besides
};

/// One decaying oscillation  e(t) (C cos w t + S sin w t),  e = exp(-s t), of the largest with friction
///   e(t) = max(0, exp(-s t) - g (1 - exp(-s t))/s),                               theory.md (I.10)
/// the solution of da/dt = -s a - f, f = g a(0): besides the viscous decay the amplitude falls by f a second.
struct RingDownMode {
  Estimate frequency;      ///< w/2 pi, of the damped oscillation [Hz]
  Estimate decay;          ///< s [1/s]
  Estimate damping_ratio;  ///< s/sqrt(w^2 + s^2) [-]
  Estimate amplitude;      ///< at the first reading [m]
  /// sqrt(w^2 + s^2), of the undamped oscillation [rad/s].
  [[nodiscard]] double natural() const;
  /// Larger than five standard errors, with a frequency and a decay that the readings determine.
  [[nodiscard]] bool significant() const {
    return amplitude.value > 5.0 * amplitude.error && std::isfinite(frequency.error) &&
           std::isfinite(decay.error);
  }
};

/// What is found in one record; usable or not says its report.
struct RingDownFit {
  std::vector<RingDownMode> modes;   ///< by frequency
  Eigen::MatrixXd decay_covariance;  ///< of their decays, a row and a column a mode [1/s^2]
  std::size_t largest = 0;           ///< index of the mode of the largest amplitude
  std::optional<Estimate>
      friction;               ///< f of the largest mode [m/s]; absent: not asked for, or not in the data
  double friction_bic = 0.0;  ///< BIC without friction less that with it; kept above 10
  Eigen::VectorXd fitted;     ///< [m]
  double rmse = 0.0;          ///< [m]
  double nrmse = 0.0;         ///< over the range of the readings [-]
  double runs_p = 1.0;        ///< p of the number of runs of one sign of the residual
  double ljung_box_p = 1.0;   ///< p of its autocorrelations
  numerics::SolveReport report;
  /// The residual looks like noise; where it does not, the standard errors are too small.
  [[nodiscard]] bool noise_only() const { return runs_p > 1e-3 && ljung_box_p > 1e-3; }
};

/// What is wrong with the readings for this purpose, or empty: fewer than 20, no motion, times that do not
/// rise.
[[nodiscard]] std::string ring_down_problem(const RingDown& data);

/// Fits decaying oscillations by least squares (Ceres): frequencies from peaks of the spectrum one after the
/// other, then all numbers together. The noise is what is left. The data must have no ring_down_problem.
[[nodiscard]] RingDownFit fit_ring_down(const RingDown& data);

}  // namespace snare::identification
