#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Place of a body at the start.
std::vector<RecordEffect> body_start_position_effects(const RecordModel& model) {
  return other_body_vector(model, "position_mm",
                           {.name = "body_start_position",
                            .channel = "body",
                            .meaning = "the body began in another place",
                            .independent_check = "measure the place just before"},
                           1.0);
}

}  // namespace snare::identification
