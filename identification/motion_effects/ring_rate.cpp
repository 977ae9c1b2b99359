#include "identification/motion_effects/motion_effect.hpp"

namespace snare::identification {

/// Rate at which a ring closes, of a course in the list of drives or in a phase.
std::vector<MotionEffect> ring_rate_effects(const MotionModel& model) {
  const MotionEffect what{.name = "ring_rate",
                          .channel = "ring",
                          .meaning = "the ring closes faster or slower",
                          .independent_check = "read the ring's angle over time without a fixture"};
  std::vector<MotionEffect> effects = other_number(model, "drives", "rate_deg_s", what);
  for (const std::string& phase : model.declared().names("phases")) {
    for (MotionEffect& e : other_number(model, "phases[" + phase + "].drives", "rate_deg_s", what)) {
      e.place = phase + "." + e.place;
      effects.push_back(std::move(e));
    }
  }
  return effects;
}

}  // namespace snare::identification
