#pragma once

#include "identification/fitting/least_squares.hpp"
#include "identification/tracing/remainder.hpp"

namespace snare::identification {

/// Tests of what is left after a fit.                                                theory.md (I.3), (I.9)
struct ResidualTests {
  double runs = 1.0;                ///< p of the number of runs of one sign
  double ljung_box = 1.0;           ///< p of the autocorrelations
  double lack_of_fit = 1.0;         ///< p of chi2 against the noise; against replicates of the smooth part alone
  bool against_replicates = false;  ///< the noise is that of replicates, which differ smoothly themselves
  double rmse = 0.0;                ///< of the residual [N]
  double noise = 0.0;               ///< of a reading [N]
  Remainder left{};                 ///< the smooth part of what is left

  /// All three together at 0.2 %, so that a right answer is taken back once in five hundred; against
  /// replicates the lack of fit alone.
  [[nodiscard]] bool like_noise() const;
  /// At most this much is left, with 95 % confidence [N].
  [[nodiscard]] bool within(double tolerance) const { return left.upper <= tolerance; }
  /// Nothing worth naming is left: it is like noise, smaller than the noise, or within the tolerance [N].
  [[nodiscard]] bool acceptable(double tolerance) const { return like_noise() || rmse <= noise || within(tolerance); }
};

/// All tests of what this fit leaves in the fitted series.
[[nodiscard]] ResidualTests test_residuals(const Model& model, const Data& data, const Fit& fit);

}  // namespace snare::identification
