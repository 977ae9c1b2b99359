#pragma once

#include "coupling/dynamics/model/arm.hpp"
#include "coupling/dynamics/model/sensed.hpp"
#include "multibody/spatial.hpp"

#include <array>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace snare::coupling {

/// A number of a motion that a phase may wait for. Indices count within the lists of the motion.
struct MotionSignal {
  enum class Kind {
    /// sum of the normal forces of a contact, a spring or a pair of wires, as results count them [N]
    contact_force,
    wire_tension,  ///< of a wire, from its mean strain [N]
    joint_torque,  ///< size of the torque in the spring of an arm's joint [N m]
    joint_angle,   ///< of an arm's joint, on the link's side [rad]
    distance,      ///< of the origins of two frames [m]
    speed          ///< of two frames' origins relative to each other, size [m/s]
  };
  Kind kind = Kind::contact_force;
  int index = 0;  ///< of the contact or the wire, or of the arm
  int joint = 0;  ///< of the arm
  /// Frames on carriers, and where they stand at the start.
  std::array<MotionCarrier, 2> carriers;
  std::array<multibody::Pose, 2> poses;
};

/// A signal on one side of a bound.
struct SignalBound {
  MotionSignal signal;
  bool above = true;   ///< must be at least the bound; false: at most
  double bound = 0.0;  ///< in the signal's unit
};

/// What a motor does from a phase on, made when it begins: at a time [s] and with the motor at an angle
/// [rad].
struct PhaseDrive {
  int arm = 0, joint = 0;
  std::function<multibody::Drive(double time, double angle)> make;
};

/// A stretch of time that begins at a time or on what happens, and changes drives. Phases begin one after the
/// other, in their order; several may begin at once.                                         theory.md (M.23)
struct MotionPhase {
  std::string name = "phase";
  double not_before = 0.0;          ///< [s], from the start of the motion
  double after_previous = 0.0;      ///< least time from the beginning of the phase before [s], >= 0
  std::vector<SignalBound> bounds;  ///< all must hold, and all of the next; none: the times decide
  std::vector<SensedBound> sensed;  ///< of the readings that have come
  double hold = 0.0;                ///< for so long without a break [s], >= 0
  std::vector<PhaseDrive> drives;
  bool ends_run = false;  ///< the run is over where it begins
};

}  // namespace snare::coupling
