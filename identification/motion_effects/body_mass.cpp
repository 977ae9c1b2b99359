#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Mass of a body.
std::vector<RecordEffect> body_mass_effects(const RecordModel& model) {
  return other_number(model, "bodies", "mass_kg",
                      {.name = "body_mass",
                       .channel = "body",
                       .meaning = "the body is heavier or lighter",
                       .independent_check = "weigh it, or push it with a known impulse"});
}

}  // namespace snare::identification
