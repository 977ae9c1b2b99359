#pragma once

#include "coupling/dynamics/model/model.hpp"
#include "coupling/dynamics/model/result.hpp"
#include "scenario/placement.hpp"

#include <optional>
#include <string>
#include <vector>

namespace snare::scenario {

/// What counts as caught: the axis of a shaft passes through the space that the wires of a snare enclose, and
/// the shaft hardly moves against the snare, from some time to the end.                      theory.md (M.25)
struct CaptureTest {
  PlacedFrame shaft;       ///< z along its axis
  PlacedFrame snare;       ///< the fixed ring, z along its axis
  std::vector<int> wires;  ///< indices
  double sense = 1.0;      ///< of the turning ring about z
  double speed = 0.005;    ///< largest of the shaft's point in the snare's frame [m/s]
  double hold = 0.1;       ///< for so long [s]
};

/// How a capture ended.
struct CaptureOutcome {
  bool enclosed = false;               ///< at the end, by every wire
  bool caught = false;                 ///< and at rest for as long as asked
  std::optional<double> caught_since;  ///< [s]
  double speed = 0.0;                  ///< at the end [m/s]
  Eigen::Vector3d place =
      Eigen::Vector3d::Zero();  ///< of the shaft's axis in the plane of the snare's frame, at the end [m]
};
[[nodiscard]] CaptureOutcome outcome_of(const CaptureTest& test, const coupling::Motion& motion,
                                        const std::vector<coupling::MotionSample>& samples);

}  // namespace snare::scenario
