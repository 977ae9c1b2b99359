#pragma once

#include "identification/fitting/published_likelihood.hpp"

#include <string>
#include <vector>

namespace snare::identification {

/// How far the published fits of all series may reach: what their paper does not print.
struct FitRange {
  enum class Kind {
    common,           ///< one range for all
    taut_from_touch,  ///< to where an inextensible wire is taut, counted from first touch
    taut_from_chord   ///< the same, counted from the chord
  };
  Kind kind = Kind::common;
  std::vector<double> to;  ///< one a series [m], > 0
};
[[nodiscard]] std::string to_string(FitRange::Kind kind);

/// What one published fit is, if it reaches so far and rests on so many evenly spread readings.
struct FitCell {
  std::vector<double> travel;  ///< [m]
  Eigen::MatrixXd basis;       ///< Q^T of quadratic_basis, (3, n)
  PublishedNumbers numbers;
  double log_scale =
      0.0;  ///< log |d(Q^T y)/d(A, B, C)|: the density of the printed numbers, from that of their projections
  double log_scatter = 0.0;  ///< log of the standard deviation about the printed parabola [N]
};

/// to: [m], > 0; readings: >= 4.
[[nodiscard]] FitCell fit_cell(const QuadraticLaw& law, double to, int readings);

/// Ranges and numbers of readings that are looked at, and the published fits under each.            theory.md (I.33)
class FitRanges {
 public:
  struct Options {
    double least = 2e-3, most = 18e-3;                              ///< common ranges [m]
    int ranges = 21;                                                ///< common ones, evenly in their logarithm, >= 2
    std::vector<int> readings{6, 9, 13, 20, 30, 45, 68, 101, 200};  ///< >= 4 each
  };
  /// series: with a law each; touch: heights over the chord at first touch [m], one a series.
  FitRanges(const std::vector<Series>& series, const std::vector<double>& touch, const Options& options);

  /// The same ranges and numbers of readings for other published fits, one a series.
  [[nodiscard]] FitRanges of(const std::vector<QuadraticLaw>& laws) const;

  /// Common ones in ascending order, then those that end where the wire is taut.
  [[nodiscard]] const std::vector<FitRange>& ranges() const { return ranges_; }
  /// Numbers of readings that are looked at, ascending.
  [[nodiscard]] const std::vector<int>& readings() const { return options_.readings; }
  /// Number of published fits.
  [[nodiscard]] std::size_t series() const { return series_; }
  /// A published fit at a range and a number of readings, by their indices.
  [[nodiscard]] const FitCell& cell(std::size_t range, std::size_t readings, std::size_t series) const {
    return cells_[(range * options_.readings.size() + readings) * series_ + series];
  }
  /// The longest range [m].
  [[nodiscard]] double longest() const;
  /// Prior mass of a range with one of the numbers of readings; all sum to 1. Numbers of readings share evenly. Half is of fits that end
  /// where the wire is taut, the rest of common ranges: even in their logarithm or, uniform, in themselves.
  [[nodiscard]] double mass(std::size_t range, bool uniform) const;

 private:
  void fill(const std::vector<QuadraticLaw>& laws);

  Options options_;
  std::size_t series_;
  std::vector<FitRange> ranges_;
  std::vector<FitCell> cells_;
};

}  // namespace snare::identification
