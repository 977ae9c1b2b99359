#pragma once

#include "identification/published/fit_ranges.hpp"
#include "numerics/cubic_spline.hpp"

#include <limits>
#include <optional>

namespace snare::identification {

/// log p of what cannot be.
inline constexpr double impossible = -std::numeric_limits<double>::infinity();

/// Computed force over true travel from first touch, of one series.
struct TouchCurve {
  numerics::HermiteCurve force;  ///< [N] over [m], from 0
  double reach = 0.0;            ///< travel up to which it was computed [m]
};

/// The zero of the recorded travel is unknown, evenly within so much either way [m].
inline constexpr double largest_zero = 4e-3;

/// Scatters that are looked at: log sigma - FitCell::log_scatter from here on, to the nearest steps.
inline constexpr double first_scatter = -1.5, scatter_step = 0.25;
inline constexpr Eigen::Index scatters = 13;

/// Zero of the travel at which the parabola of the computed curve is nearest to the published one [m]. near:
/// an estimate from which the search begins; none: all zeros are searched. -largest_zero where the curve does
/// not reach far enough.
[[nodiscard]] double best_zero(const FitCell& cell, const TouchCurve& curve,
                               std::optional<double> near = std::nullopt);

/// log p(A, B, C, R2 | curve, sigma) of a published fit in SI units [-], the zero z of the travel integrated
/// out, one a scatter:
///   p = integral dz / (2 largest_zero) N(Q^T y; Q^T F(d - z), sigma^2 I) |d(Q^T y)/d(A, B, C)| P(R2 | q(z),
///     sigma)
/// with q = |(I - H) F|^2. zero: of best_zero; log_sigma: ascending [log N]. Minus infinity where the curve
/// does not reach far enough.
///                                                                                           theory.md (I.33)
[[nodiscard]] Eigen::ArrayXd log_likelihoods(const FitCell& cell, const TouchCurve& curve, double zero,
                                             const Eigen::ArrayXd& log_sigma);

/// What log_likelihoods is at most [-], one a scatter [log N]: the curve's parabola at its best zero, with
/// P(R2) = 1.
[[nodiscard]] Eigen::ArrayXd most_likelihoods(const FitCell& cell, const TouchCurve& curve, double zero,
                                              const Eigen::ArrayXd& log_sigma);

}  // namespace snare::identification
