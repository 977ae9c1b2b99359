#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace snare::numerics {

/// What a cubic spline does at its upper end; at the lower end it is always "not a knot".
enum class SplineEnd {
  not_a_knot,  ///< the last two pieces are one cubic
  level        ///< slope zero: mirror symmetry
};

/// Matrix D with which the slopes of the interpolating C2 cubic spline at its knots are D v.  theory.md (R.3)
/// knots: strictly ascending, >= 1 of them; one knot has slope 0, two a straight line, three a parabola. Of
/// any unit.
[[nodiscard]] Eigen::MatrixXd spline_slopes(const std::vector<double>& knots,
                                            SplineEnd upper = SplineEnd::not_a_knot);

/// The cell [knots[i], knots[i+1]] that holds x, or the first or last where x is outside. One knot: 0. All of
/// any unit.
[[nodiscard]] inline std::size_t find_cell(const double* knots, std::size_t count, double x) noexcept {
  std::size_t low = 0;
  std::size_t high = count > 1 ? count - 1 : 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (x >= knots[middle] ? low : high) = middle;
  }
  return low;
}

/// A piecewise cubic with given values and slopes at its knots: C1. Abscissae x and values in whatever units
/// they have.
class HermiteCurve {
 public:
  HermiteCurve(std::vector<double> knots, std::vector<double> values, std::vector<double> slopes);
  /// Through values with the slopes of the C2 spline. Throws std::domain_error where knots lie too close for
  /// roundings.
  HermiteCurve(std::vector<double> knots, std::vector<double> values);

  /// The curve at x; beyond the ends the outermost cubic continues.
  [[nodiscard]] double value(double x) const noexcept;
  /// Its first derivative.
  [[nodiscard]] double slope(double x) const noexcept;
  /// Second derivative; it jumps at the knots.
  [[nodiscard]] double curvature(double x) const noexcept;
  /// Integral from the first knot to x, exact for the piecewise cubic.
  [[nodiscard]] double integral(double x) const noexcept;
  [[nodiscard]] const std::vector<double>& knots() const noexcept { return knots_; }
  [[nodiscard]] const std::vector<double>& slopes() const noexcept { return slopes_; }

 private:
  [[nodiscard]] std::size_t cell(double x) const noexcept {
    const double guess = (x - knots_.front()) * cells_per_x_;
    if (guess >= 0.0 && guess < static_cast<double>(knots_.size() - 1)) {
      const auto i = static_cast<std::size_t>(guess);
      if (x >= knots_[i] && x < knots_[i + 1]) return i;  // always so where the knots are evenly spread
    }
    return find_cell(knots_.data(), knots_.size(), x);
  }

  std::vector<double> knots_, values_, slopes_;
  std::vector<double> area_;  // integral up to each knot
  double cells_per_x_ = 0.0;
};

/// Slopes held to [0, 3 secants] where the values ascend, so that the cubic through them ascends too (Fritsch
/// and Carlson 1980); those at turns of the values become 0; elsewhere unchanged where they cannot overshoot.
/// Of any unit.
[[nodiscard]] std::vector<double> monotone_slopes(const std::vector<double>& knots,
                                                  const std::vector<double>& values,
                                                  std::vector<double> slopes);

}  // namespace snare::numerics
