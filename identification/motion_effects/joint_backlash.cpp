#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Play of the gear: the spring of a linear joint bears beyond half the gap only, (A.10).
std::vector<RecordEffect> joint_backlash_effects(const RecordModel& model) {
  std::vector<RecordEffect> effects;
  for (const JointPlace& joint : joint_places(model)) {
    const std::string key = joint.prefix + "half_gap_deg";
    const double declared = model.declared().number(key).value_or(0.0);
    if (model.declared().text(joint.prefix + "law").value_or("") != "linear") continue;
    RecordNumber number = number_at(key, declared, joint.use.slides ? 1e-3 : 0.01);
    number.lower = declared;
    // Without play the law is the linear one: the backlash law has no gap of zero.
    number.overrides = [key, law = joint.prefix + "law"](double gap, const StandingNumbers&) {
      if (!(gap > 0.0)) return std::vector<base::Override>{};
      return std::vector<base::Override>{{law, "backlash"}, {key, exact_text(gap)}};
    };
    effects.push_back(
        {.name = "joint_backlash",
         .place = joint.name,
         .channel = "joint",
         .meaning = "the gear has play",
         .numbers = {number},
         .plausible_upper = 1.0,
         .one_sided = true,
         .independent_check = "hold the motor and move the link by hand: the angle without resistance"});
  }
  return effects;
}

}  // namespace snare::identification
