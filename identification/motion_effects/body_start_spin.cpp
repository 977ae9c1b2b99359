#include "identification/motion_effects/motion_effect.hpp"

namespace snare::identification {

/// Spin of a body at the start.
std::vector<MotionEffect> body_start_spin_effects(const MotionModel& model) {
  return other_body_vector(model, "spin_rad_s",
                           {.name = "body_start_spin",
                            .channel = "body",
                            .meaning = "the body began with another spin",
                            .independent_check = "measure the spin just before"},
                           1e-3);
}

}  // namespace snare::identification
