#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Modulus of a wire: both its stiffnesses together.
std::vector<RecordEffect> wire_modulus_effects(const RecordModel& model) {
  return other_wire_number(model, "youngs_modulus_GPa",
                           {.name = "wire_modulus",
                            .channel = "wire",
                            .meaning = "the wire's material is stiffer or softer",
                            .independent_check = "pull the wire straight on a testing machine"});
}

}  // namespace snare::identification
