#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Friction of a shape on wires, where some is declared.
std::vector<RecordEffect> contact_friction_effects(const RecordModel& model) {
  return other_number(model, "shapes", "friction",
                      {.name = "contact_friction",
                       .channel = "contact",
                       .meaning = "shape and wires have another friction",
                       .independent_check = "pull a wire over the shape with a known weight on it"});
}

}  // namespace snare::identification
