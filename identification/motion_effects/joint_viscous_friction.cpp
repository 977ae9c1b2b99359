#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Friction in proportion to the speed: (A.11), d.
std::vector<RecordEffect> joint_viscous_friction_effects(const RecordModel& model) {
  std::vector<RecordEffect> effects;
  for (const JointPlace& joint : joint_places(model)) {
    const std::string key = joint.prefix + "viscous_Nms_rad";
    const double declared = model.declared().number(key).value_or(0.0);
    if (!(joint.use.rate > 0.0) || !(joint.use.torque > 0.0)) continue;
    RecordNumber number =
        number_at(key, declared, declared > 0.0 ? 0.02 * declared : 0.02 * joint.use.torque / joint.use.rate);
    number.lower = 0.0;
    effects.push_back(
        {.name = "joint_viscous_friction",
         .place = joint.name,
         .channel = "joint",
         .meaning = "friction in proportion to the speed is another",
         .numbers = {number},
         .one_sided = declared == 0.0,
         .independent_check = "turn the joint at several constant speeds: slope of the torque"});
  }
  return effects;
}

}  // namespace snare::identification
