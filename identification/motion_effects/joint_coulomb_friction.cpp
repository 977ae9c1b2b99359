#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Dry friction of a motor with its gear, or of a bearing: (A.11), T_c.
std::vector<RecordEffect> joint_coulomb_friction_effects(const RecordModel& model) {
  std::vector<RecordEffect> effects;
  for (const JointPlace& joint : joint_places(model)) {
    const std::string key = joint.prefix + "coulomb_Nm";
    const double declared = model.declared().number(key).value_or(0.0);
    if (!(joint.use.rate > 0.0) || !(joint.use.torque > 0.0)) continue;
    RecordNumber number = number_at(key, declared, 0.02 * joint.use.torque);
    number.lower = 0.0;
    effects.push_back({.name = "joint_coulomb_friction",
                       .place = joint.name,
                       .channel = "joint",
                       .meaning = "dry friction resists the motion with a constant torque",
                       .numbers = {number},
                       .one_sided = declared == 0.0,
                       .independent_check = "turn the joint slowly at constant speed in both directions: "
                                            "half the difference of the torques"});
  }
  return effects;
}

}  // namespace snare::identification
