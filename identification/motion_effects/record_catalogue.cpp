#include "identification/motion_effects/record_effect.hpp"

namespace snare::identification {

/// The list: a line an effect.
#define SNARE_MOTION_EFFECTS(EFFECT) \
  EFFECT(joint_coulomb_friction)     \
  EFFECT(joint_friction_asymmetry)   \
  EFFECT(joint_viscous_friction)     \
  EFFECT(joint_viscous_asymmetry)    \
  EFFECT(joint_quadratic_drag)       \
  EFFECT(joint_breakaway)            \
  EFFECT(joint_backlash)             \
  EFFECT(joint_stiffness)            \
  EFFECT(joint_damping)              \
  EFFECT(joint_back_drive)           \
  EFFECT(motor_inertia)              \
  EFFECT(link_flexibility)           \
  EFFECT(servo_gain)                 \
  EFFECT(body_mass)                  \
  EFFECT(wire_length)                \
  EFFECT(wire_axial_stiffness)       \
  EFFECT(wire_bending_stiffness)     \
  EFFECT(wire_damping)               \
  EFFECT(contact_friction)           \
  EFFECT(wire_modulus)               \
  EFFECT(bushing_stiffness)          \
  EFFECT(bushing_damping)            \
  EFFECT(body_inertia)               \
  EFFECT(body_centre_of_mass)        \
  EFFECT(body_start_velocity)        \
  EFFECT(body_start_spin)            \
  EFFECT(body_start_position)        \
  EFFECT(body_start_attitude)        \
  EFFECT(ring_rate)                  \
  EFFECT(ring_delay)                 \
  EFFECT(sensor_bias)                \
  EFFECT(sensor_gain)                \
  EFFECT(sensor_drift)               \
  EFFECT(sensor_delay)               \
  EFFECT(sensor_lag)                 \
  EFFECT(record_clock)

#define SNARE_DECLARE(name) std::vector<RecordEffect> name##_effects(const RecordModel&);
SNARE_MOTION_EFFECTS(SNARE_DECLARE)
#undef SNARE_DECLARE

std::vector<RecordEffect> motion_effects(const RecordModel& model) {
  std::vector<RecordEffect> all;
#define SNARE_ADD(name) \
  for (RecordEffect & effect : name##_effects(model)) all.push_back(std::move(effect));
  SNARE_MOTION_EFFECTS(SNARE_ADD)
#undef SNARE_ADD
  return all;
}

const std::vector<std::string>& motion_effect_names() {
  static const std::vector<std::string> names{
#define SNARE_NAME(name) #name,
      SNARE_MOTION_EFFECTS(SNARE_NAME)
#undef SNARE_NAME
  };
  return names;
}

}  // namespace snare::identification
