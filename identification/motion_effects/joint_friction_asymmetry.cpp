#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Dry friction that is larger one way, or a torque that the drive gives unasked: (A.11), T_0. Constant
/// against turning forward.
std::vector<RecordEffect> joint_friction_asymmetry_effects(const RecordModel& model) {
  std::vector<RecordEffect> effects;
  for (const JointPlace& joint : joint_places(model)) {
    const std::string key = joint.prefix + "offset_Nm";
    const double declared = model.declared().number(key).value_or(0.0);
    if (!(joint.use.rate > 0.0) || !(joint.use.torque > 0.0)) continue;
    RecordNumber number = number_at(key, declared, 0.02 * joint.use.torque);
    effects.push_back({.name = "joint_friction_asymmetry",
                       .place = joint.name,
                       .channel = "joint",
                       .meaning = "friction differs with the direction, or the drive has an offset",
                       .numbers = {number},
                       .one_sided = false,
                       .independent_check =
                           "turn the joint slowly at constant speed in both directions: the mean of "
                           "the torques; then at rest with the drive off"});
  }
  return effects;
}

}  // namespace snare::identification
