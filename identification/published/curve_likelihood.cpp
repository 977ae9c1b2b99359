#include "identification/published/curve_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace snare::identification {

namespace {

using Eigen::Index;
using Eigen::Vector3d;

/// Recorded forces of a zero: the coefficients of their parabola, and the part off it.
struct AtZero {
  Vector3d coefficients;
  double off = 0.0;  ///< q [N^2]
};

AtZero at_zero(const FitCell& cell, const TouchCurve& curve, double zero) {
  AtZero at{Vector3d::Zero(), 0.0};
  double squares = 0.0;
  for (Index i = 0; i < cell.basis.cols(); ++i) {
    const double f = curve.force.value(std::max(0.0, cell.travel[static_cast<std::size_t>(i)] - zero));
    at.coefficients += f * cell.basis.col(i);
    squares += f * f;
  }
  at.off = std::max(0.0, squares - at.coefficients.squaredNorm());
  return at;
}

/// The least zero for which the curve reaches to the end of the range.
double least_zero(const FitCell& cell, const TouchCurve& curve) {
  return std::max(-largest_zero, cell.travel.back() - curve.reach);
}

double distance(const FitCell& cell, const TouchCurve& curve, double zero) {
  return (cell.numbers.coefficients - at_zero(cell, curve, zero).coefficients).squaredNorm();
}

}  // namespace

double best_zero(const FitCell& cell, const TouchCurve& curve) {
  constexpr int steps = 64;
  const double low = least_zero(cell, curve), width = (largest_zero - low) / steps;
  int best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= steps; ++i) {
    const double d = distance(cell, curve, low + width * i);
    if (d < least) best = i, least = d;
  }
  double a = low + width * std::max(0, best - 1), b = low + width * std::min(steps, best + 1);
  const double ratio = std::numbers::phi - 1.0;
  double c = b - ratio * (b - a), d = a + ratio * (b - a);
  double at_c = distance(cell, curve, c), at_d = distance(cell, curve, d);
  for (int i = 0; i < 24; ++i) {  // golden section: to 1e-5 of a step
    if (at_c < at_d) {
      b = d, d = c, at_d = at_c;
      c = b - ratio * (b - a);
      at_c = distance(cell, curve, c);
    } else {
      a = c, c = d, at_c = at_d;
      d = a + ratio * (b - a);
      at_d = distance(cell, curve, d);
    }
  }
  return 0.5 * (a + b);
}

// The integrand is nearly normal about the best zero, with the width sigma / |d(Q^T F)/dz|: a trapezoidal rule a width wide is exact to 1e-8.
Eigen::ArrayXd log_likelihoods(const FitCell& cell, const TouchCurve& curve, const Eigen::ArrayXd& log_sigma) {
  constexpr double none = -std::numeric_limits<double>::infinity();
  Eigen::ArrayXd result = Eigen::ArrayXd::Constant(log_sigma.size(), none);
  const double low = least_zero(cell, curve);
  if (!(low < largest_zero)) return result;
  const double zero = best_zero(cell, curve), h = 1e-7;
  const double slope =
      (at_zero(cell, curve, zero + h).coefficients - at_zero(cell, curve, zero - h).coefficients).norm() / (2.0 * h);
  constexpr int half = 5;
  const auto components = static_cast<double>(cell.basis.cols() - 3);
  for (Index s = 0; s < log_sigma.size(); ++s) {
    const double sigma = std::exp(log_sigma[s]);
    const double width = std::min(sigma / std::max(slope, 1e-9), (largest_zero - low) / (2.0 * half));
    double largest = none, sum = 0.0;
    for (int j = -half; j <= half; ++j) {
      const double z = zero + width * j;
      if (z < low || z > largest_zero) continue;
      const AtZero at = at_zero(cell, curve, z);
      const double normal =
          -0.5 * (cell.numbers.coefficients - at.coefficients).squaredNorm() / (sigma * sigma) - 3.0 * log_sigma[s];
      if (normal < largest - 40.0) continue;  // P(R2) <= 1
      const double log =
          normal + length_probability(cell.numbers.lower, cell.numbers.upper, components, at.off, log_sigma[s]).log;
      if (log > largest) sum *= std::exp(largest - log), largest = log;
      sum += std::exp(log - largest);
    }
    if (!(sum > 0.0)) continue;
    result[s] = largest + std::log(sum * width / (2.0 * largest_zero)) + cell.log_scale -
                1.5 * std::log(2.0 * std::numbers::pi);
  }
  return result;
}

}  // namespace snare::identification
