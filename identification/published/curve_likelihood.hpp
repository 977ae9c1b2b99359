#pragma once

#include "identification/published/fit_ranges.hpp"
#include "numerics/cubic_spline.hpp"

namespace snare::identification {

/// Computed force over true travel from first touch, of one series.
struct TouchCurve {
  numerics::HermiteCurve force;  ///< [N] over [m], from 0
  double reach = 0.0;            ///< travel up to which it was computed [m]
};

/// The zero of the recorded travel is unknown, evenly within so much either way [m].
inline constexpr double largest_zero = 4e-3;

/// Scatters that are looked at: log sigma - FitCell::log_scatter, evenly spread.
inline constexpr double first_scatter = -1.5, scatter_step = 0.25;
inline constexpr Eigen::Index scatters = 13;

/// log p(A, B, C, R2 | curve, sigma) of a published fit in SI units [-], the zero z of the travel integrated out, one a scatter:
///   p = integral dz / (2 largest_zero) N(Q^T y; Q^T F(d - z), sigma^2 I) |d(Q^T y)/d(A, B, C)| P(R2 | q(z), sigma)
/// with q = |(I - H) F|^2. log_sigma: [log N]. Minus infinity where the curve does not reach far enough.   theory.md (I.33)
[[nodiscard]] Eigen::ArrayXd log_likelihoods(const FitCell& cell, const TouchCurve& curve,
                                             const Eigen::ArrayXd& log_sigma);

/// Zero of the travel at which the parabola of the computed curve is nearest to the published one [m].
[[nodiscard]] double best_zero(const FitCell& cell, const TouchCurve& curve);

}  // namespace snare::identification
