#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Proportional gain of a servo.
std::vector<RecordEffect> servo_gain_effects(const RecordModel& model) {
  return other_joint_number(
      model, "proportional_Nm_rad",
      {.name = "servo_gain",
       .channel = "joint",
       .meaning = "the servo holds stiffer or softer",
       .independent_check = "read the gain out of the controller; deflect the held joint by a known torque"});
}

}  // namespace snare::identification
