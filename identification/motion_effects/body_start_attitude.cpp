#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Attitude of a body at the start, by its rotation vector.
std::vector<RecordEffect> body_start_attitude_effects(const RecordModel& model) {
  return other_body_vector(model, "rotation_deg",
                           {.name = "body_start_attitude",
                            .channel = "body",
                            .meaning = "the body began turned otherwise",
                            .independent_check = "measure the attitude just before"},
                           0.1);
}

}  // namespace snare::identification
