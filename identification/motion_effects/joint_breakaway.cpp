#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Dry friction that is larger at rest and falls off with the speed: (A.11), T_s - T_c beside the dry
/// friction that the model has. Where no speed is declared at which it has fallen off, a fifth of the rms
/// along the first record.
std::vector<RecordEffect> joint_breakaway_effects(const RecordModel& model) {
  constexpr double share_of_rate = 0.2;
  std::vector<RecordEffect> effects;
  for (const JointPlace& joint : joint_places(model)) {
    if (!(joint.use.rate > 0.0) || !(joint.use.torque > 0.0)) continue;
    const std::string dry = joint.prefix + "coulomb_Nm", key = joint.prefix + "breakaway_Nm",
                      falls_off = joint.prefix + "stribeck_velocity_rad_s";
    const auto beside = [dry, key](const auto& record) {
      const double coulomb = record.number(dry).value_or(0.0);
      return record.number(key).value_or(coulomb) - coulomb;
    };
    const double declared = beside(model.declared());
    RecordNumber number = number_at(joint.prefix + "breakaway_excess_Nm", declared, 0.02 * joint.use.torque);
    number.unit = unit_of_key(key);
    number.overrides = [=](double value, const StandingNumbers& record) {
      const double more = value + (beside(record) - declared);
      std::vector<base::Override> set{{key, exact_text(more)}};
      if (!record.number(falls_off)) set.push_back({falls_off, exact_text(share_of_rate * joint.use.rate)});
      return set;
    };
    number.above = dry;
    number.lower = 0.0;
    effects.push_back({.name = "joint_breakaway",
                       .place = joint.name,
                       .channel = "joint",
                       .meaning = "dry friction is larger at rest and falls off with the speed",
                       .numbers = {number},
                       .one_sided = declared == 0.0,
                       .independent_check =
                           "turn the joint at several small constant speeds: the torque falls with "
                           "the speed; and the torque at which it breaks away from rest"});
  }
  return effects;
}

}  // namespace snare::identification
