#include "identification/published/curve_likelihood.hpp"

#include "identification/published/importance_sampling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

namespace snare::identification {

namespace {

using Eigen::Index;
using Eigen::Vector3d;

/// Recorded forces of a zero: the coefficients of their parabola, how they change with the zero if that is
/// asked for, and the part off it.
struct AtZero {
  Vector3d coefficients, change;
  double off = 0.0;  ///< q [N^2]
};

AtZero at_zero(const FitCell& cell, const TouchCurve& curve, double zero, bool with_change = false) {
  AtZero at{Vector3d::Zero(), Vector3d::Zero()};
  double squares = 0.0;
  for (Index i = 0; i < cell.basis.cols(); ++i) {
    const double travel = cell.travel[static_cast<std::size_t>(i)] - zero;
    const double f = curve.force.value(std::max(0.0, travel));
    at.coefficients += f * cell.basis.col(i);
    if (with_change && travel > 0.0) at.change -= curve.force.slope(travel) * cell.basis.col(i);
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

/// The best zero by steps of the least distance from an estimate, if they come to an end.
std::optional<double> zero_near(const FitCell& cell, const TouchCurve& curve, double zero) {
  constexpr int most = 8;
  constexpr double enough = 1e-3;  // of the standard deviation of the zero
  const double low = least_zero(cell, curve), sigma = std::exp(cell.log_scatter);
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most; ++i) {
    const AtZero at = at_zero(cell, curve, zero, true);
    const Vector3d missing = cell.numbers.coefficients - at.coefficients;
    const double slope = at.change.squaredNorm();
    if (!(missing.squaredNorm() <= last) || !(slope > 0.0)) return std::nullopt;
    last = missing.squaredNorm();
    const double next = std::clamp(zero + at.change.dot(missing) / slope, low, largest_zero);
    if (std::abs(next - zero) * std::sqrt(slope) < enough * sigma) return next;
    zero = next;
  }
  return std::nullopt;
}

double zero_anywhere(const FitCell& cell, const TouchCurve& curve) {
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

/// Coefficients and part off the parabola about a zero: quadratic in it within `half` either way, where the
/// curve is computed there.
class NearZero {
 public:
  NearZero(const FitCell& cell, const TouchCurve& curve, double zero, double half)
      : cell_(cell), curve_(curve), zero_(zero), half_(half), at_(at_zero(cell, curve, zero)) {
    constexpr double short_way = 0.3e-3;  // over which a curve hardly bends [m]
    short_ = half < short_way && zero - half >= least_zero(cell, curve) && zero + half <= largest_zero;
    if (!short_) return;
    below_ = at_zero(cell, curve, zero - half);
    above_ = at_zero(cell, curve, zero + half);
  }
  [[nodiscard]] bool is_short() const { return short_; }
  [[nodiscard]] AtZero operator()(double zero) const {
    if (!short_) return at_zero(cell_, curve_, zero);
    const double x = (zero - zero_) / half_, up = 0.5 * x * (x + 1.0), down = 0.5 * x * (x - 1.0);
    AtZero at{down * below_.coefficients + (1.0 - x * x) * at_.coefficients + up * above_.coefficients,
              at_.change};
    at.off = std::max(0.0, down * below_.off + (1.0 - x * x) * at_.off + up * above_.off);
    return at;
  }

 private:
  const FitCell& cell_;
  const TouchCurve& curve_;
  double zero_, half_;
  bool short_ = false;
  AtZero at_, below_, above_;
};

double log_constant(const FitCell& cell) {
  return cell.log_scale - 1.5 * std::log(2.0 * std::numbers::pi);
}

}  // namespace

double best_zero(const FitCell& cell, const TouchCurve& curve, std::optional<double> near) {
  if (!(least_zero(cell, curve) < largest_zero)) return -largest_zero;
  const std::optional<double> found = near ? zero_near(cell, curve, *near) : std::nullopt;
  return found ? *found : zero_anywhere(cell, curve);
}

Eigen::ArrayXd most_likelihoods(const FitCell& cell, const TouchCurve& curve, double zero,
                                const Eigen::ArrayXd& log_sigma) {
  if (!(least_zero(cell, curve) < largest_zero))
    return Eigen::ArrayXd::Constant(log_sigma.size(), impossible);
  const double least = distance(cell, curve, zero);
  return -0.5 * least * (-2.0 * log_sigma).exp() - 3.0 * log_sigma + log_constant(cell);
}

namespace {

/// Nodes and logarithms of weights for integrals over a standard normal variable: Gauss and Hermite's rule of
/// five points.
struct NormalRule {
  std::array<double, 5> at, log_weight;
};
NormalRule normal_rule() {
  const double inner = std::sqrt(5.0 - std::sqrt(10.0)), outer = std::sqrt(5.0 + std::sqrt(10.0));
  const double w1 = std::log((7.0 + 2.0 * std::sqrt(10.0)) / 60.0),
               w2 = std::log((7.0 - 2.0 * std::sqrt(10.0)) / 60.0);
  return {{0.0, -inner, inner, -outer, outer}, {std::log(8.0 / 15.0), w1, w1, w2, w2}};
}

}  // namespace

// The integrand is nearly normal about the best zero, with the width sigma / |d(Q^T F)/dz|. Where the ends of
// the zeros or of the curve are near, a trapezoidal rule a width wide takes the place of Gauss and Hermite's.
Eigen::ArrayXd log_likelihoods(const FitCell& cell, const TouchCurve& curve, double zero,
                               const Eigen::ArrayXd& log_sigma) {
  Eigen::ArrayXd result = Eigen::ArrayXd::Constant(log_sigma.size(), impossible);
  const double low = least_zero(cell, curve);
  if (!(low < largest_zero) || log_sigma.size() == 0) return result;
  static const NormalRule rule = normal_rule();
  constexpr int half = 5;
  const double slope = std::max(at_zero(cell, curve, zero, true).change.norm(), 1e-9);
  const NearZero near(cell, curve, zero, half * std::exp(log_sigma.maxCoeff()) / slope);
  const auto components = static_cast<double>(cell.basis.cols() - 3);
  for (Index s = 0; s < log_sigma.size(); ++s) {
    const double sigma = std::exp(log_sigma[s]);
    const double width = std::min(sigma / slope, (largest_zero - low) / (2.0 * half));
    std::vector<double> terms;
    const auto add = [&](double z, double log_weight) {
      const AtZero at = near(z);
      const double normal =
          -0.5 * (cell.numbers.coefficients - at.coefficients).squaredNorm() / (sigma * sigma);
      const double r2 =
          length_probability(cell.numbers.lower, cell.numbers.upper, components, at.off, log_sigma[s]).log;
      terms.push_back(normal + r2 + log_weight);
    };
    if (near.is_short()) {
      const double whole = std::log(width) + 0.5 * std::log(2.0 * std::numbers::pi);
      for (std::size_t j = 0; j < rule.at.size(); ++j)
        add(zero + width * rule.at[j], whole + rule.log_weight[j] + 0.5 * rule.at[j] * rule.at[j]);
    } else {
      for (int j = -half; j <= half; ++j)
        if (const double z = zero + width * j; z >= low && z <= largest_zero) add(z, std::log(width));
    }
    result[s] = log_sum(terms) - 3.0 * log_sigma[s] - std::log(2.0 * largest_zero) + log_constant(cell);
  }
  return result;
}

}  // namespace snare::identification
