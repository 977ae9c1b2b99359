#pragma once

#include "coupling/dynamics/model/model.hpp"
#include "coupling/dynamics/model/result.hpp"
#include "coupling/dynamics/model/sensed.hpp"
#include "scenario/placement.hpp"

#include <string>
#include <vector>

namespace snare::scenario {

/// What a sensor tells of a motion.
/// docs/scenario_file.md
struct Sensor {
  enum class Kind {
    position,       ///< of a frame's origin in another frame [m], three
    attitude,       ///< rotation vector of a frame in another [rad], three
    velocity,       ///< of a frame's origin relative to another's, in that one's axes [m/s], three
    rate,           ///< angular, in the axes of the frame itself, as a gyroscope [rad/s], three
    joint_angle,    ///< of the link behind an elastic joint [rad], of one that slides [m]
    motor_angle,    ///< [rad], [m]
    motor_rate,     ///< [rad/s], [m/s]
    joint_torque,   ///< in the spring of a joint [N m], [N]
    drive_torque,   ///< of the drive on the motor [N m], [N]
    contact_force,  ///< normal [N]
    tension,        ///< of a wire, the smaller of the pulls of its mounts [N]
    mount_force     ///< size of the force on a mount, of the wire's first end [N]
  };
  std::string name;
  Kind kind = Kind::position;
  PlacedFrame frame, relative_to;
  int index = 0;          ///< of the arm, the contact or the wire
  int joint = 0;          ///< of the arm
  bool slides = false;    ///< the joint's coordinate is a length
  double interval = 0.0;  ///< between two readings, a whole multiple of that of the output [s]
  double delay = 0.0;     ///< age of what a reading tells [s]
  double noise = 0.0;     ///< standard deviation of a reading, in the unit of its column
  unsigned seed = 1;

  /// Numbers a reading has, and columns: three of a vector, else one.
  [[nodiscard]] int components() const;
  /// SI units in one unit of its columns, 1e-3 for mm.
  [[nodiscard]] double unit() const;
  /// Unit in which it reads, as names of columns and keys have it: "mm", "deg_s".
  [[nodiscard]] std::string unit_name() const;
  /// Names of its columns, with units.
  [[nodiscard]] std::vector<std::string> columns() const;
};

/// What the sensor tells phases while the motion runs: the readings of `read_off`, in the unit of its
/// columns.
[[nodiscard]] coupling::SensedSignal sensed_by(const Sensor& sensor);

/// Readings of a sensor, in the units of its columns.
struct Readings {
  std::vector<double> times;                ///< [s]
  std::vector<std::vector<double>> values;  ///< of every component
};

/// What a sensor reads along the samples of a motion; between two samples, where the delay falls there,
/// straight.
[[nodiscard]] Readings read_off(const Sensor& sensor, const coupling::Motion& motion,
                                const std::vector<coupling::MotionSample>& samples);

}  // namespace snare::scenario
