#pragma once

#include "identification/fitting/least_squares.hpp"
#include "identification/fitting/published_fit.hpp"
#include "identification/tracing/remainder.hpp"

#include <optional>

namespace snare::identification {

/// Tests of what is left after a fit.                                                theory.md (I.3), (I.9)
struct ResidualTests {
  double runs = 1.0;         ///< p of the number of runs of one sign
  double ljung_box = 1.0;    ///< p of the autocorrelations
  double lack_of_fit = 1.0;  ///< p of chi2 against the noise; against replicates of the smooth part alone
  bool against_replicates = false;  ///< the noise is that of replicates, which differ smoothly themselves
  bool of_published = false;  ///< all series are published fits: lack_of_fit is that of their numbers (I.11)
  std::optional<SummaryStatistics> published{};  ///< of these
  double rmse = 0.0;                             ///< of the residual [N]
  double noise = 0.0;                            ///< of a reading [N]
  Remainder left{};                              ///< the smooth part of what is left

  /// P of all three together [-]; against replicates, and of published fits, of the lack of fit alone.
  [[nodiscard]] double p() const;
  /// At 0.2 %, so that a right answer is taken back once in five hundred; of published fits at 1 %.
  [[nodiscard]] bool like_noise() const;
  /// At most this much is left, with 95 % confidence [N].
  [[nodiscard]] bool within(double tolerance) const { return left.upper <= tolerance; }
  /// What is left is like noise, or smaller than the noise. Published fits must agree with the computed ones:
  /// of them there is no reading whose noise could hide anything.
  [[nodiscard]] bool within_noise() const { return like_noise() || (!of_published && rmse <= noise); }
  /// Nothing worth naming is left: it is within the noise or within the tolerance [N].
  [[nodiscard]] bool acceptable(double tolerance) const {
    return within_noise() || (!of_published && within(tolerance));
  }
  /// Nothing speaks against the model: what is left is like noise at 5 %, or within the tolerance [N].
  [[nodiscard]] bool agrees(double tolerance) const {
    return p() > 0.05 || (!of_published && within(tolerance));
  }
};

/// All tests of what this fit leaves in the fitted series.
[[nodiscard]] ResidualTests test_residuals(const Model& model, const Data& data, const Fit& fit);

}  // namespace snare::identification
