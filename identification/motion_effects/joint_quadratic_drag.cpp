#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Drag that grows with the square of the speed, as of air: (A.11), d2.
std::vector<RecordEffect> joint_quadratic_drag_effects(const RecordModel& model) {
  std::vector<RecordEffect> effects;
  for (const JointPlace& joint : joint_places(model)) {
    const std::string key = joint.prefix + "quadratic_Nms2_rad2";
    const double declared = model.declared().number(key).value_or(0.0);
    if (!(joint.use.rate > 0.0) || !(joint.use.torque > 0.0)) continue;
    RecordNumber number =
        number_at(key, declared, 0.02 * joint.use.torque / (joint.use.rate * joint.use.rate));
    number.lower = 0.0;
    effects.push_back(
        {.name = "joint_quadratic_drag",
         .place = joint.name,
         .channel = "joint",
         .meaning = "drag grows with the square of the speed",
         .numbers = {number},
         .one_sided = declared == 0.0,
         .independent_check =
             "turn the joint at several constant speeds: curvature of the torque; or repeat in vacuum"});
  }
  return effects;
}

}  // namespace snare::identification
