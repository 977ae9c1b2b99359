#pragma once

#include "identification/fitting/least_squares.hpp"

namespace snare::identification {

/// Tests of what is left after a fit.                                                theory.md (I.3)
struct ResidualTests {
  double runs = 1.0;                ///< p of the number of runs of one sign
  double ljung_box = 1.0;           ///< p of the autocorrelations
  double lack_of_fit = 1.0;         ///< p of chi2 against the noise
  bool against_replicates = false;  ///< the noise is that of replicates, which differ smoothly themselves
  /// All three together at 0.2 %, so that a right answer is taken back once in five hundred; against
  /// replicates the lack of fit alone.
  [[nodiscard]] bool acceptable() const;
};

[[nodiscard]] ResidualTests test_residuals(const Data& data, const Fit& fit);

}  // namespace snare::identification
