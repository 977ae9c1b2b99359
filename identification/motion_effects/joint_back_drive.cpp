#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Torque that a limp gear needs to be driven back, where one is declared: (A.11).
std::vector<RecordEffect> joint_back_drive_effects(const RecordModel& model) {
  return other_joint_number(
      model, "back_drive_Nm",
      {.name = "joint_back_drive",
       .channel = "joint",
       .meaning = "the limp gear takes another torque to be driven back",
       .independent_check = "drive the limp joint back from the link with a torque sensor"});
}

}  // namespace snare::identification
