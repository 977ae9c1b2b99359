#include "study/distribution.hpp"

#include <boost/math/distributions/lognormal.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/triangular.hpp>

#include <algorithm>
#include <cmath>

namespace snare::study {

namespace {

using Shape = Distribution::Shape;

double uncut_probability(const Distribution& d, double x) {
  switch (d.shape) {
    case Shape::uniform:
      return std::clamp((x - d.a) / (d.b - d.a), 0.0, 1.0);
    case Shape::normal:
      return normal_probability((x - d.a) / d.b);
    case Shape::lognormal:
      return x > 0.0 ? normal_probability((std::log(x) - d.a) / d.b) : 0.0;
    case Shape::triangular:
      if (x <= d.a) return 0.0;
      if (x >= d.b) return 1.0;
      return boost::math::cdf(boost::math::triangular_distribution<>(d.a, d.c, d.b), x);
  }
  return 0.0;
}

double uncut_quantile(const Distribution& d, double p) {
  switch (d.shape) {
    case Shape::uniform:
      return d.a + p * (d.b - d.a);
    case Shape::normal:
      return d.a + d.b * normal_quantile(p);
    case Shape::lognormal:
      return std::exp(d.a + d.b * normal_quantile(p));
    case Shape::triangular:
      return boost::math::quantile(boost::math::triangular_distribution<>(d.a, d.c, d.b), p);
  }
  return 0.0;
}

/// Probabilities of the uncut distribution at the cuts.
struct Cut {
  double below, inside;
};
Cut cut_of(const Distribution& d) {
  const double below = std::isfinite(d.lower) ? uncut_probability(d, d.lower) : 0.0;
  const double above = std::isfinite(d.upper) ? uncut_probability(d, d.upper) : 1.0;
  return {below, above - below};
}

}  // namespace

double probability_below(const Distribution& d, double x) {
  const Cut cut = cut_of(d);
  return std::clamp((uncut_probability(d, x) - cut.below) / cut.inside, 0.0, 1.0);
}

double quantile(const Distribution& d, double p) {
  constexpr double nearest = 0x1p-53;  // to 0 and 1, where the quantile may be infinite
  const Cut cut = cut_of(d);
  const double x = uncut_quantile(d, std::clamp(cut.below + p * cut.inside, nearest, 1.0 - nearest));
  return std::clamp(x, d.lower, d.upper);
}

bool drawable(const Distribution& d) {
  constexpr double least = 1e-9;  // below it the roundings of probabilities near 1 show
  return cut_of(d).inside > least;
}

double normal_probability(double z) {
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

double normal_quantile(double p) {
  return boost::math::quantile(boost::math::normal_distribution<>(), p);
}

}  // namespace snare::study
