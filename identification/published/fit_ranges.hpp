#pragma once

#include "identification/fitting/published_likelihood.hpp"

#include <string>
#include <vector>

namespace snare::identification {

/// How far the published fits of all series may reach: what their paper does not print.
struct FitRange {
  enum class Kind {
    common,           ///< one range for all, somewhere in a bin
    own,              ///< of every series its own, even in its logarithm
    own_even,         ///< the same, even in itself
    taut_from_touch,  ///< to where an inextensible wire is taut, counted from first touch
    taut_from_chord   ///< the same, counted from the chord
  };
  Kind kind = Kind::common;
  std::vector<double> to;  ///< one a series [m], > 0; of a bin its upper edge, of own ranges the longest
  double from = 0.0;       ///< lower edge of a bin, shortest of own ranges [m]
};
[[nodiscard]] std::string to_string(FitRange::Kind kind);

/// What one published fit is, if it reaches so far and rests on so many evenly spread readings.
struct FitCell {
  std::vector<double> travel;  ///< [m]
  Eigen::MatrixXd basis;       ///< Q^T of quadratic_basis, (3, n)
  PublishedNumbers numbers;
  /// Log |d(Q^T y)/d(A, B, C)|: the density of the printed numbers, from that of their projections [-].
  double log_scale = 0.0;
  double log_scatter = 0.0;  ///< log of the standard deviation about the printed parabola [N]
};

/// to: [m], > 0; readings: >= 4.
[[nodiscard]] FitCell fit_cell(const QuadraticLaw& law, double to, int readings);

/// All published fits by every number of readings, if they reach so far.
struct FitCells {
  std::vector<double> to;      ///< one a series [m]
  std::vector<FitCell> cells;  ///< by number of readings, then by series
  [[nodiscard]] const FitCell& cell(std::size_t readings, std::size_t series) const {
    return cells[readings * to.size() + series];
  }
};

/// Ranges and numbers of readings that are looked at, and the published fits under each.     theory.md (I.33)
class FitRanges {
 public:
  struct Options {
    double least = 2e-3, most = 18e-3;  ///< common and own ranges [m]
    int bins = 20;                      ///< of common ranges, evenly in their logarithm, >= 1
    std::vector<int> readings{6, 9, 13, 20, 30, 45, 68, 101, 200};  ///< >= 4 each
  };
  /// series: with a law each; touch: heights over the chord at first touch [m], one a series.
  FitRanges(const std::vector<Series>& series, const std::vector<double>& touch, const Options& options);

  /// The same ranges and numbers of readings for other published fits, one a series.
  [[nodiscard]] FitRanges of(const std::vector<QuadraticLaw>& laws) const;

  /// Bins of common ranges in ascending order, own ranges (of two series or more) even in their logarithm and
  /// in themselves, then those that end where the wire is taut.
  [[nodiscard]] const std::vector<FitRange>& ranges() const { return ranges_; }
  /// Number of bins of common ranges, the first of ranges().
  [[nodiscard]] std::size_t bins() const { return static_cast<std::size_t>(options_.bins); }
  /// Numbers of readings that are looked at, ascending.
  [[nodiscard]] const std::vector<int>& readings() const { return options_.readings; }
  /// The published fits, one a series.
  [[nodiscard]] const std::vector<QuadraticLaw>& laws() const { return laws_; }
  /// Number of published fits.
  [[nodiscard]] std::size_t series() const { return laws_.size(); }
  /// The published fits at the edges of the bins, ascending.
  [[nodiscard]] const std::vector<FitCells>& edges() const { return edges_; }
  /// The published fits where the wire is taut: the last of ranges().
  [[nodiscard]] const std::vector<FitCells>& taut() const { return taut_; }
  /// Each published fit by itself; none where there is one only.
  [[nodiscard]] const std::vector<FitRanges>& single() const { return single_; }
  /// The published fits at any ranges, one a series [m].
  [[nodiscard]] FitCells at(const std::vector<double>& to) const;
  /// The same ranges [m] with one number of readings, by its index.
  [[nodiscard]] FitCells at(const std::vector<double>& to, std::size_t readings) const;
  /// The longest range [m].
  [[nodiscard]] double longest() const;
  /// Prior mass of a range with one of the numbers of readings; all sum to 1. Numbers of readings share
  /// evenly. Half is of fits that end where the wire is taut, the rest by halves of common ranges and of own
  /// ones: even in their logarithm or, uniform, in themselves.
  [[nodiscard]] double mass(std::size_t range, bool uniform) const;

 private:
  explicit FitRanges(const Options& options) : options_(options) {}
  void fill();

  Options options_;
  std::vector<QuadraticLaw> laws_;
  std::vector<FitRange> ranges_;
  std::vector<FitCells> edges_, taut_;
  std::vector<FitRanges> single_;
};

}  // namespace snare::identification
