#pragma once

#include <limits>

namespace snare::study {

/// Distribution of one number of a case, cut off outside [lower, upper] where these are finite.
///                                                                                            theory.md (S.1)
///   uniform      a, b: ends, a < b
///   normal       a: mean, b > 0: standard deviation
///   lognormal    a: mean, b > 0: standard deviation of the logarithm
///   triangular   a, b: ends, c: mode, a <= c <= b, a < b
/// Numbers are in the unit of the key, those of a logarithm without one [-].
struct Distribution {
  enum class Shape { uniform, normal, lognormal, triangular };

  Shape shape = Shape::uniform;
  double a = 0.0;
  double b = 1.0;
  double c = 0.0;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

/// P(X <= x) [-], x in the unit of the distribution.
[[nodiscard]] double probability_below(const Distribution& d, double x);

/// The x, in the unit of the distribution, with P(X <= x) = p, 0 < p < 1; inside [lower, upper].
[[nodiscard]] double quantile(const Distribution& d, double p);

/// Whether what is inside [lower, upper] can be drawn: it has a probability above 1e-9.
[[nodiscard]] bool drawable(const Distribution& d);

/// Distribution function of the standard normal [-], and its inverse for 0 < p < 1.
[[nodiscard]] double normal_probability(double z);
[[nodiscard]] double normal_quantile(double p);

}  // namespace snare::study
