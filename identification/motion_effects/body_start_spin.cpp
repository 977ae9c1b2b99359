#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Spin of a body at the start.
std::vector<RecordEffect> body_start_spin_effects(const RecordModel& model) {
  return other_body_vector(model, "spin_rad_s",
                           {.name = "body_start_spin",
                            .channel = "body",
                            .meaning = "the body began with another spin",
                            .independent_check = "measure the spin just before"},
                           1e-3);
}

}  // namespace snare::identification
