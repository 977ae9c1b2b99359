#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Rate at which a ring closes, of a course in the list of drives or in a phase.
std::vector<RecordEffect> ring_rate_effects(const RecordModel& model) {
  const RecordEffect what{.name = "ring_rate",
                          .channel = "ring",
                          .meaning = "the ring closes faster or slower",
                          .independent_check = "read the ring's angle over time without a fixture"};
  std::vector<RecordEffect> effects = other_number(model, "drives", "rate_deg_s", what);
  for (const std::string& phase : model.declared().names("phases")) {
    for (RecordEffect& e : other_number(model, "phases[" + phase + "].drives", "rate_deg_s", what)) {
      e.place = phase + "." + e.place;
      effects.push_back(std::move(e));
    }
  }
  return effects;
}

}  // namespace snare::identification
