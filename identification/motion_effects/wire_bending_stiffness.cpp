#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Stiffness of a wire against bending, where it is declared.
std::vector<RecordEffect> wire_bending_stiffness_effects(const RecordModel& model) {
  return other_wire_number(model, "bending_stiffness_Nm2",
                           {.name = "wire_bending_stiffness",
                            .channel = "wire",
                            .meaning = "the wire bends more or less easily",
                            .independent_check = "bend the wire on two supports"});
}

}  // namespace snare::identification
