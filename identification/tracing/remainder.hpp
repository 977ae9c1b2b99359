#pragma once

#include "identification/fitting/least_squares.hpp"

namespace snare::identification {

/// What a fit leaves beside the noise: a smooth function of the travel, one a condition and leg.
///                                                                                            theory.md (I.9)
struct Remainder {
  double rmse = 0.0;        ///< of it, over the readings [N]
  double upper = 0.0;       ///< 95 %, one-sided [N]
  double p = 1.0;           ///< that the noise alone leaves as much
  double directions = 0.0;  ///< that the readings have for it, beside the fitted numbers
  double ratio = 1.0;       ///< of the variance in these directions to that of the noise
  /// That ratio where it is more than the noise's, else 1: by it the uncertainty of what was found grows.
  [[nodiscard]] double inflation() const;
};

/// Hats over the displacement of every leg of every condition, as many as the readings bear and at most
/// twelve, the fitted columns projected out: their share of the whitened residual, Q = |U^T r|^2, against d
/// F(d, nu), nu the degrees of freedom of the noise. The function itself is the hats' values with the fitted
/// numbers moved along; its root mean square is taken times sqrt((Q - d) / Q), its bound times sqrt(l / Q), l
/// the largest noncentrality that would leave as little as Q in one of twenty cases.
[[nodiscard]] Remainder remainder(const Model& model, const Data& data, const Fit& fit);

}  // namespace snare::identification
