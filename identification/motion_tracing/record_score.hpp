#pragma once

#include "identification/motion_effects/record_effect.hpp"
#include "identification/records/coloured_noise.hpp"
#include "identification/records/record_fit.hpp"

#include <optional>
#include <string>
#include <vector>

namespace snare::identification {

/// Score test of one effect beside a fitted scenario.                                        theory.md (I.22)
struct RecordScore {
  std::size_t effect = 0;    ///< index in the list
  std::string unobservable;  ///< why the records cannot show it; empty: they can
  double p = 1.0;            ///< of the score, one-sided where the effect is
  double adjusted_p = 1.0;   ///< by Holm
  double z = 0.0;            ///< normal deviate of that p
  double fall = 0.0;         ///< of the sum of squares that it promises, to first order
  double chance = 0.0;       ///< fall that noise alone would bring, in the mean
  /// Of the effect's those that these records show, and that the others do not do as well.
  std::vector<std::size_t> numbers;
  std::vector<double> start;  ///< of these numbers, for a refit
  std::vector<double> scale;  ///< at which they were tried
  std::optional<double>
      detectable;           ///< size of the first number that would be seen in nine of ten cases, in its unit
  Eigen::MatrixXd whole;    ///< of the signal by the numbers over their scales
  Eigen::MatrixXd columns;  ///< the same, fitted columns out
};

/// What the tests of one round rest on.
struct RecordScores {
  std::vector<RecordScore> scores;
  /// Of what is left when all columns at once are taken out: of that no effect is a part.
  ColouredNoise noise;
};

/// Tests of all effects at a level `significance` (for what would be detected). The size of the trial follows
/// from what it changes: between a fiftieth of the residual and as much as it.
[[nodiscard]] RecordScores score_motion(const RecordModel& model, const RecordData& data,
                                        const RecordFit& fit, const std::vector<RecordSetting>& fixed,
                                        const std::vector<RecordEffect>& effects, double significance);

}  // namespace snare::identification
