#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Bending of a link, in its first mode either way, about where its joint carries it: (A.19). It is tried at
/// what a torque of that joint bends by 0.01 deg.
std::vector<RecordEffect> link_flexibility_effects(const RecordModel& model) {
  constexpr double small = 2e-4, most = 0.1;  // [rad]
  std::vector<RecordEffect> effects;
  for (const JointPlace& joint : joint_places(model)) {
    if (joint.use.slides || !(joint.use.torque > 0.0)) continue;
    const std::string arm = joint.name.substr(0, joint.name.find("::"));
    const std::string key = "arms[" + arm + "].link." + joint.use.link + ".bending_compliance_rad_Nm";
    const double declared = model.declared().number(key).value_or(0.0);
    RecordNumber number = number_at(key, declared, small / joint.use.torque);
    number.unit = "rad/(N m)";
    number.lower = 0.0;
    effects.push_back(
        {.name = "link_flexibility",
         .place = arm + "::" + joint.use.link,
         .channel = "joint",
         .meaning = "the link bends",
         .numbers = {number},
         .plausible_upper = declared + most / joint.use.torque,
         .one_sided = declared == 0.0,
         .independent_check =
             "lock the joints, hang a known weight on the link's end and measure how far it bends"});
  }
  return effects;
}

}  // namespace snare::identification
