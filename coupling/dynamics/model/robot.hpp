#pragma once

#include <vector>

namespace snare::coupling {

/// A robot that moves its body, without turning it, as a free body would move under the force that a sensor
/// on the robot measures: a test with
/// hardware in the loop. What it has measured comes to effect late:  v(t) = v(0) + 1/m (integral of F up to t
/// - tau).
///                                                                                           theory.md (M.32)
struct MotionRobot {
  double mass = 1.0;   ///< m, of the body that it plays [kg], > 0
  double delay = 0.0;  ///< tau [s], > 0
  /// One of the contacts whose force on the body is measured.
  struct Measured {
    int contact = 0;  ///< index as Motion::contact_names counts them
    /// of the force on the body over that which results give: -1 where they give that on the other side
    double sign = 1.0;
  };
  std::vector<Measured> measured;
};

}  // namespace snare::coupling
