#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Damping of a linear gear: (A.10).
std::vector<RecordEffect> joint_damping_effects(const RecordModel& model) {
  return other_joint_number(model, "damping_Nms_rad",
                            {.name = "joint_damping",
                             .channel = "joint",
                             .meaning = "the gear damps more or less",
                             .independent_check = "lock the motor and let the link ring down"});
}

}  // namespace snare::identification
