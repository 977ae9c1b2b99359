#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Velocity of a body at the start.
std::vector<RecordEffect> body_start_velocity_effects(const RecordModel& model) {
  return other_body_vector(model, "velocity_m_s",
                           {.name = "body_start_velocity",
                            .channel = "body",
                            .meaning = "the body began with another velocity",
                            .independent_check = "measure the velocity just before"},
                           1e-3);
}

}  // namespace snare::identification
