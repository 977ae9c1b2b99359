#pragma once

#include "multibody/arm/course.hpp"

#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace snare::multibody {

/// What holds a motor.
enum class DriveMode {
  locked,  ///< a brake: the motor does not turn
  servo,   ///< torque = clamp(kp (r - qm) + kd (s r' - qm'), +-limit)
  limp,    ///< no torque; the gear is driven back by the load
  torque,  ///< a torque over time, whatever the motor does
  course   ///< the motor runs its course whatever it takes: qm' = r'
};

/// One motor's drive: a mode and the numbers of that mode.
struct Drive {
  DriveMode mode = DriveMode::limp;
  double proportional = 0.0;                               ///< kp [N m/rad], >= 0
  double derivative = 0.0;                                 ///< kd [N m s/rad], >= 0
  double limit = std::numeric_limits<double>::infinity();  ///< [N m], > 0
  double rate_share = 1.0;  ///< s: of the course's rate that kd sees [-], 0 to 1
  Course course;
  /// Of a torque: straight between values at times from 0 on [s, N m], and the last one held. At least one.
  struct Torque {
    std::vector<double> times, values;
    std::vector<double> stops;  ///< where the integration must stop
  };
  std::shared_ptr<const Torque> given;
  double begin = 0.0;  ///< time at which a given torque begins [s]; none before

  /// The brake holds the motor where it is.
  [[nodiscard]] static Drive locked();
  /// No torque at all.
  [[nodiscard]] static Drive limp();
  /// A torque over time: values [N m] at times [s] from `begin` on, see Torque; strictly ascending.
  [[nodiscard]] static Drive with_torque(double begin, std::vector<double> times, std::vector<double> values);
  /// The motor runs this course [rad, s].
  [[nodiscard]] static Drive on_course(const Course& course);
  /// A servo that holds an angle [rad], with its gains kp [N m/rad] and kd [N m s/rad] and its limit [N m].
  [[nodiscard]] static Drive holding(double angle, double proportional, double derivative,
                                     double limit = std::numeric_limits<double>::infinity());

  /// Whether the motor moves as told, whatever acts on it.
  [[nodiscard]] bool rules() const { return mode == DriveMode::locked || mode == DriveMode::course; }
  /// Torque of the servo before its limit, or the given one [N m].
  [[nodiscard]] double demand(double time, double angle, double rate) const;
  /// The first time after a time at which the integration must stop [s]; infinity where there is none.
  [[nodiscard]] double next_break(double time) const;
};

/// All drives change at a time, or when the torque of a joint's spring first exceeds a size after that time.
struct DriveSwitch {
  double time = 0.0;          ///< [s]
  int joint = -1;             ///< -1: at the time itself
  double torque = 0.0;        ///< [N m], > 0, with a joint
  std::vector<Drive> drives;  ///< one an elastic joint
};

}  // namespace snare::multibody
