#pragma once

#include <limits>
#include <string>
#include <vector>

namespace snare::multibody {

/// Where a motor is told to be: from one angle to another with a quintic course, at rest at both ends.
///   r(s) = from + (to - from) (10 s^3 - 15 s^4 + 6 s^5),  s = (t - begin)/duration      theory.md (A.12)
/// duration 0: a step. Before and after it stands.
struct Course {
  double from = 0.0, to = 0.0;         ///< [rad]
  double begin = 0.0, duration = 0.0;  ///< [s], duration >= 0

  [[nodiscard]] double angle(double time) const;
  [[nodiscard]] double rate(double time) const;
  /// `time` is where the course begins or ends and must be integrated up to, not across.
  [[nodiscard]] std::vector<double> breaks() const { return {begin, begin + duration}; }
};

/// What holds a motor.
enum class DriveMode {
  locked,  ///< a brake: the motor does not turn
  servo,   ///< torque = clamp(kp (r - qm) + kd (r' - qm'), +-limit)
  limp     ///< no torque; the gear is driven back by the load
};

struct Drive {
  DriveMode mode = DriveMode::limp;
  double proportional = 0.0;                               ///< kp [N m/rad], >= 0
  double derivative = 0.0;                                 ///< kd [N m s/rad], >= 0
  double limit = std::numeric_limits<double>::infinity();  ///< [N m], > 0
  Course course;

  [[nodiscard]] static Drive locked();
  [[nodiscard]] static Drive limp();
  [[nodiscard]] static Drive holding(double angle, double proportional, double derivative,
                                     double limit = std::numeric_limits<double>::infinity());

  /// Torque of the servo before its limit [N m].
  [[nodiscard]] double demand(double time, double angle, double rate) const;
};

/// All drives change at a time, or when the torque of a joint's spring first exceeds a size after that time.
struct DriveSwitch {
  double time = 0.0;          ///< [s]
  int joint = -1;             ///< -1: at the time itself
  double torque = 0.0;        ///< [N m], > 0, with a joint
  std::vector<Drive> drives;  ///< one an elastic joint
};

}  // namespace snare::multibody
