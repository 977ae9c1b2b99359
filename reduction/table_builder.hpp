#pragma once

#include "coupling/contact/force_table.hpp"
#include "reduction/curve_store.hpp"

#include <memory>
#include <string>
#include <vector>

namespace snare::reduction {

/// How far a table is from the full wire, from points that are not its nodes.
struct TableError {
  double force_range = 0.0;        ///< of the full wire over the asked range [N]
  double largest = 0.0;            ///< |table - full wire| at the points of the check [N]
  double rms = 0.0;                ///< [N]
  double largest_stiffness = 0.0;  ///< of dF/dd [N/m]
  double rms_stiffness = 0.0;      ///< [N/m]
  double largest_energy = 0.0;     ///< of the integral from first touch [J]
  double discretisation = 0.0;     ///< of the full wire itself: largest estimate over its curves [N]
  double bound = 0.0;              ///< stated: bound_factor * largest + discretisation [N]
  std::size_t points = 0;          ///< of the check
  CurvePlace worst;                ///< where the largest error is [m]
  double worst_travel = 0.0;       ///< [m]
};

/// A table's stated bound over the largest error found in the middles of its cells, where a cubic's error is
/// largest: one half more, for what lies between.
inline constexpr double bound_factor = 1.5;

/// A table with its error. `report` is not usable where the sampling ended early; then there is no table.
struct BuiltTable {
  std::unique_ptr<coupling::ForceTable> loading;
  /// From the end of the travel; null where nothing dissipates.
  std::unique_ptr<coupling::ForceTable> unloading;
  TableError loading_error, unloading_error;
  int rounds = 0;          ///< of refinement
  std::size_t curves = 0;  ///< of the full wire behind it, with those of the check
  numerics::SolveReport report;
};

/// Travels [m] at which curves are solved: evenly spread, four for every knot of the largest table; knots are
/// taken from these and the others check them.
[[nodiscard]] std::vector<double> sampling_travel(const WireCase& wire, const DistilSettings& settings);

/// Places knots where a cubic spline through them errs most, along pilot lines through the range; solves the
/// nodes; checks in the middle of every cell, of its faces and of its edges; adds knots while the bound is
/// above the tolerance and the largest number of knots allows.                          theory.md (R.2)-(R.5)
[[nodiscard]] BuiltTable build_table(CurveStore& store, const DistilSettings& settings,
                                     const SamplingObserver& observer = {});

/// Knots, of any unit, for functions given on candidates: ends first, then one at a time where the spline
/// through the knots is farthest from a function. lines: each as long as candidates. Returns ascending
/// indices, `count` of them or all.
[[nodiscard]] std::vector<std::size_t> place_knots(const std::vector<double>& candidates,
                                                   const std::vector<std::vector<double>>& lines,
                                                   std::size_t count);

}  // namespace snare::reduction
