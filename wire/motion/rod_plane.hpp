#pragma once

#include <array>

namespace snare::wire {

/// A plane in which a rod stays, across an axis of the world.                                theory.md (M.36)
struct RodPlane {
  int normal = 2;                    ///< the axis: 0, 1, 2
  std::array<int, 2> axes = {0, 1};  ///< the other two, which turn left about it
  int bending = 0;                   ///< which of the two curvatures is in the plane; the other one vanishes
  double sign = 1.0;                 ///< 1 or -1: of that curvature where the rod turns left
  [[nodiscard]] int odd() const { return 1 - bending; }
};

}  // namespace snare::wire
