#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Viscous friction that is larger one way: (A.11), d_0.
std::vector<RecordEffect> joint_viscous_asymmetry_effects(const RecordModel& model) {
  std::vector<RecordEffect> effects;
  for (const JointPlace& joint : joint_places(model)) {
    const std::string key = joint.prefix + "viscous_asymmetry_Nms_rad";
    const double declared = model.declared().number(key).value_or(0.0);
    if (!(joint.use.rate > 0.0) || !(joint.use.torque > 0.0)) continue;
    const double viscous = model.declared().number(joint.prefix + "viscous_Nms_rad").value_or(0.0);
    if (!(viscous > 0.0)) continue;
    RecordNumber number = number_at(key, declared, 0.02 * viscous);
    effects.push_back(
        {.name = "joint_viscous_asymmetry",
         .place = joint.name,
         .channel = "joint",
         .meaning = "viscous friction differs with the direction",
         .numbers = {number},
         .one_sided = false,
         .independent_check =
             "turn the joint at several constant speeds in both directions: difference of the slopes"});
  }
  return effects;
}

}  // namespace snare::identification
