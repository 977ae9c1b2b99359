#include "identification/motion_effects/motion_effect.hpp"

namespace snare::identification {

/// Stiffness of a bushing, as an attachment that gives: (M.22). Turning and shifting for themselves, all axes by one factor.
std::vector<MotionEffect> bushing_stiffness_effects(const MotionModel& model) {
  std::vector<MotionEffect> effects;
  for (const char* key : {"rotational_stiffness_Nm_rad", "translational_stiffness_N_m"}) {
    for (MotionEffect& e :
         other_number(model, "bushings", key,
                      {.name = "bushing_stiffness",
                      .channel = "bushing",
                      .meaning = "the attachment is stiffer or softer",
                      .independent_check = "load the attachment statically and measure how it gives"})) {
      e.place += std::string(".") + key;
      e.plausible_lower = 1e-5 * e.numbers.front().declared;  // a rigid one is declared by any large number
      e.numbers.front().lower = 1e-6 * e.numbers.front().declared;
      effects.push_back(std::move(e));
    }
  }
  return effects;
}

}  // namespace snare::identification
