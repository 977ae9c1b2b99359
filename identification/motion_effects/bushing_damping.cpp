#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Damping of a bushing: (M.22).
std::vector<RecordEffect> bushing_damping_effects(const RecordModel& model) {
  std::vector<RecordEffect> effects;
  for (const char* key : {"rotational_damping_Nms_rad", "translational_damping_Ns_m"}) {
    for (RecordEffect& e : other_number(model, "bushings", key,
                                        {.name = "bushing_damping",
                                        .channel = "bushing",
                                        .meaning = "the attachment damps more or less",
                                        .independent_check = "let the attachment ring down"})) {
      e.place += std::string(".") + key;
      effects.push_back(std::move(e));
    }
  }
  return effects;
}

}  // namespace snare::identification
