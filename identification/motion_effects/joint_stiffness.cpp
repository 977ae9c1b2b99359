#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Stiffness of a linear gear: (A.10).
std::vector<RecordEffect> joint_stiffness_effects(const RecordModel& model) {
  return other_joint_number(
      model, "stiffness_Nm_rad",
      {.name = "joint_stiffness",
       .channel = "joint",
       .meaning = "the gear is stiffer or softer",
       .independent_check = "lock the motor, load the link statically, measure its angle"});
}

}  // namespace snare::identification
