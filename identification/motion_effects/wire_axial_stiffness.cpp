#include "identification/motion_effects/motion_effect.hpp"

namespace snare::identification {

/// Stiffness of a wire against stretching, where it is declared.
std::vector<MotionEffect> wire_axial_stiffness_effects(const MotionModel& model) {
  return other_number(model, "wires", "axial_stiffness_N",
                      {.name = "wire_axial_stiffness",
                       .channel = "wire",
                       .meaning = "the wire stretches more or less",
                       .independent_check = "pull the wire straight on a testing machine"});
}

}  // namespace snare::identification
