#pragma once

namespace snare::identification {

/// log P of an interval and its derivatives by the squared mean q and by s = log sigma.
struct IntervalProbability {
  double log = 0.0;  ///< [-], <= 0; finite however far in a tail the interval lies
  double by_square = 0.0, by_scale = 0.0;
  double by_square_square = 0.0, by_square_scale = 0.0, by_scale_scale = 0.0;
};

/// Probability that the length |v + e| of a vector lies in an interval, e independent normal of standard
/// deviation sigma in every component: sigma times a noncentral chi variable.                theory.md (I.11)
///   f(t) = t^(k-1) 2^(1-k/2) / Gamma(k/2) exp(-(t^2 + m^2)/2) 0F1(; k/2; (m t)^2/4),
///     t = |v + e|/sigma, m = |v|/sigma
/// The logarithm is exact to 1e-6 relative in P, far in the tails as well.
/// lower, upper: of the length, 0 <= lower < upper, the upper one may be infinite, in the unit of sigma.
/// components: k >= 1.
/// square: |v|^2 >= 0. log_sigma: log of sigma, finite.
[[nodiscard]] IntervalProbability length_probability(double lower, double upper, double components,
                                                     double square, double log_sigma);

/// log f(t) [-] of the density above. t > 0, components >= 1, mean = m >= 0.
[[nodiscard]] double log_noncentral_chi(double t, double components, double mean);

}  // namespace snare::identification
