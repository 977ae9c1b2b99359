#pragma once

#include "identification/effects/effect.hpp"

#include <optional>
#include <string>
#include <vector>

namespace snare::identification {

/// Where a refit with an effect may begin.
struct RefitStart {
  std::vector<double> coordinates;  ///< of the effect's numbers [SI units; -]
  /// By how much the fitted numbers' coordinates move beside it, to first order [likewise]; zero beside a
  /// threshold.
  Eigen::VectorXd shift;
};

/// Score test of one effect against a fitted model.                                  theory.md (I.4)
struct Score {
  const Effect* effect = nullptr;
  std::string unobservable;        ///< why these data cannot show it; empty when they can
  bool absorbed = false;           ///< the numbers already fitted change the curves in the same way
  double z = 0.0;                  ///< normal deviate of the best trial; >= 0 for one-sided effects
  double p = 1.0;                  ///< of the score, trials counted
  double adjusted_p = 1.0;         ///< by Holm, over the observable effects
  std::vector<RefitStart> starts;  ///< best first
  Eigen::VectorXd direction;  ///< whitened change of the forces, fitted columns projected out, unit length
  /// By how much the coordinates of the fitted numbers move, a unit of z, when the effect is added, to first
  /// order (in their units).
  Eigen::VectorXd shift;
  /// Smallest size of the first number (in its unit, as a change from the declared value for shifts and
  /// ratios) that these data would show in nine of ten cases at this significance; absent when no trial would
  /// do.
  std::optional<double> detectable;
};

/// Score (Lagrange multiplier) tests of every effect of the catalogue that is not among the fitted numbers:
///   z = g . r / |g|, r the whitened residual, g the whitened change of the forces with the fitted columns
///   projected out,
/// a derivative at null or, for effects without one, the change at each of a grid of finite amplitudes (the
/// largest z, its p times the number of trials). significance: after Holm, for Score::detectable.
[[nodiscard]] std::vector<Score> score_effects(const Model& model, const Data& data, const Fit& current,
                                               double significance);

/// One mesh of few edges: its error is in changed curves as in unchanged ones, and drops out of changes.
[[nodiscard]] SolverSettings few_edges(const SolverSettings& asked);

/// What the trials of effects depend on.
[[nodiscard]] TrialContext trial_context(const Model& model, const Fit& current);

}  // namespace snare::identification
