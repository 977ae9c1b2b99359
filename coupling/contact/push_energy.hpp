#pragma once

#include "coupling/contact/force_table.hpp"
#include "numerics/cubic_spline.hpp"

#include <vector>

namespace snare::coupling {

/// The energy of a table's wire at one slack, of which the table's force is the slope along the travel.
///                                                                                    theory.md (R.2), (M.27)
///   U(d, s) = integral of F(x, s) dx from 0 to d
/// exact for the table, whose force at one slack is a bicubic of travel and position. Beyond the travel the
/// force continues along a straight line, beyond the positions as at the outermost.
class PushEnergy {
 public:
  /// slack: within the table's range, to which it is held [m].
  PushEnergy(const ForceTable& table, double slack);

  /// U [J] and its derivatives by travel d and position s.
  struct Value {
    double energy = 0.0;                          ///< [J]
    double by_travel = 0.0, by_position = 0.0;    ///< [N]
    double by_travels = 0.0, by_positions = 0.0;  ///< second ones, [N/m]
    double by_both = 0.0;                         ///< [N/m]
  };
  /// travel [m], position from the first mount [m]. Without contact (travel < 0) nothing.
  [[nodiscard]] Value at(double travel, double position) const;

 private:
  /// Force and its slope along the position, along the travel at one knot of the position.
  struct Line {
    numerics::HermiteCurve force, slope;
  };
  std::vector<double> positions_;  // [m], ascending
  std::vector<Line> lines_;
};

}  // namespace snare::coupling
