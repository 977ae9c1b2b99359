#pragma once

#include <cstddef>
#include <vector>

namespace snare::identification {

/// A stretch of a record in which the pusher goes one way.
struct Leg {
  std::size_t begin = 0, end = 0;  ///< readings [begin, end)
  double low = 0.0, high = 0.0;    ///< displacements [m]
  bool up = true;                  ///< the displacement grows
};

/// Indices at which a record of displacements [m] turns back by more than 2 % of its range, with its ends;
/// not empty.
[[nodiscard]] std::vector<std::size_t> turning_points(const std::vector<double>& displacement);

/// The legs of a record of displacements [m], one after the other. It turns where it goes back by more than 2
/// % of its range.
[[nodiscard]] std::vector<Leg> legs_of(const std::vector<double>& displacement);

}  // namespace snare::identification
