#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// Inertia of a rotor on the side of the output: (A.9).
std::vector<RecordEffect> motor_inertia_effects(const RecordModel& model) {
  return other_joint_number(model, "motor_inertia_kg_m2",
                            {.name = "motor_inertia",
                             .channel = "joint",
                             .meaning = "the motor, with what it drives rigidly, has another inertia",
                             .independent_check = "accelerate the motor without the link"});
}

}  // namespace snare::identification
