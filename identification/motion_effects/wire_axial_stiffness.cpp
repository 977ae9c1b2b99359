#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Stiffness of a wire against stretching, where it is declared; of a rod that stands for a wire that of its
/// half.
std::vector<RecordEffect> wire_axial_stiffness_effects(const RecordModel& model) {
  const RecordEffect what{.name = "wire_axial_stiffness",
                          .channel = "wire",
                          .meaning = "the wire stretches more or less",
                          .independent_check = "pull the wire straight on a testing machine"};
  std::vector<RecordEffect> effects = other_wire_number(model, "axial_stiffness_N", what);
  for (RecordEffect& of_rod : other_wire_number(model, "rod.half_stiffness_N_m", what)) {
    of_rod.place += ".rod";
    effects.push_back(std::move(of_rod));
  }
  return effects;
}

}  // namespace snare::identification
