#include "identification/effects/catalogue.hpp"

#include <algorithm>
#include <iterator>

namespace snare::identification {

// The list: one line an effect, NAME of NAME.cpp, in the order in which equals are listed.
#define SNARE_EFFECTS(EFFECT)               \
  EFFECT(bending_stiffness)                 \
  EFFECT(axial_stiffness)                   \
  EFFECT(wire_diameter)                     \
  EFFECT(wire_length)                       \
  EFFECT(span)                              \
  EFFECT(contact_position)                  \
  EFFECT(push_misalignment)                 \
  EFFECT(mount_slip)                        \
  EFFECT(mount_slip_right)                  \
  EFFECT(clamp_slide)                       \
  EFFECT(clamp_slide_right)                 \
  EFFECT(clamp_slide_both)                  \
  EFFECT(mount_axial_compliance)            \
  EFFECT(mount_axial_compliance_left)       \
  EFFECT(mount_axial_compliance_right)      \
  EFFECT(mount_rotational_compliance)       \
  EFFECT(mount_rotational_compliance_left)  \
  EFFECT(mount_rotational_compliance_right) \
  EFFECT(contact_friction)                  \
  EFFECT(pusher_compliance)                 \
  EFFECT(displacement_offset)               \
  EFFECT(force_offset)                      \
  EFFECT(force_gain)                        \
  EFFECT(load_cell_nonlinearity)            \
  EFFECT(travel_nonlinearity)               \
  EFFECT(force_drift)                       \
  EFFECT(creep)                             \
  EFFECT(data_lag)                          \
  EFFECT(pusher_play)                       \
  EFFECT(natural_curvature)                 \
  EFFECT(strand_hysteresis)                 \
  EFFECT(plasticity)                        \
  EFFECT(gravity)                           \
  EFFECT(rate_viscosity)

#define SNARE_DECLARE(name) Effect name##_effect();
SNARE_EFFECTS(SNARE_DECLARE)
#undef SNARE_DECLARE

namespace {

/// Messages list the numbers in this order, by what they belong to; others follow.
constexpr std::string_view order_in_messages[] = {"wire.bending_stiffness_Nm2",
                                                  "wire.axial_stiffness_N",
                                                  "wire.length_mm",
                                                  "wire.diameter_mm",
                                                  "wire.youngs_modulus_GPa",
                                                  "wire.density_kg_m3",
                                                  "wire.natural_curvature_1_m",
                                                  "mount.span_mm",
                                                  "mount.support_radius_mm",
                                                  "mount_axial_compliance.compliance_m_N",
                                                  "mount_axial_compliance_left.compliance_m_N",
                                                  "mount_axial_compliance_right.compliance_m_N",
                                                  "mount_rotational_compliance.compliance_rad_Nm",
                                                  "mount_rotational_compliance_left.compliance_rad_Nm",
                                                  "mount_rotational_compliance_right.compliance_rad_Nm",
                                                  "mount_slip.tension_N",
                                                  "mount_slip_right.tension_N",
                                                  "clamp_slide.tension_N",
                                                  "clamp_slide_right.tension_N",
                                                  "clamp_slide_both.tension_N",
                                                  "pusher.radius_mm",
                                                  "contact_position.shift_mm",
                                                  "pusher.misalignment_deg",
                                                  "pusher.friction",
                                                  "pusher.compliance_m_N",
                                                  "strand_hysteresis.extra_stiffness_Nm2",
                                                  "strand_hysteresis.slip_curvature_1_m",
                                                  "strand_hysteresis.slip_breadth",
                                                  "plasticity.yield_stress_MPa",
                                                  "plasticity.hardening_ratio",
                                                  "gravity.along_bulge_m_s2",
                                                  "reading.displacement_offset_mm",
                                                  "reading.force_offset_N",
                                                  "reading.force_gain",
                                                  "load_cell_nonlinearity.at_half_range",
                                                  "travel_nonlinearity.at_half_range",
                                                  "force_drift.rate_N_s",
                                                  "creep.share",
                                                  "creep.time_s",
                                                  "data_lag.time_s",
                                                  "pusher_play.width_mm",
                                                  "rate_viscosity.relaxation_time_s"};

std::vector<const Parameter*> numbers_of_all() {
  std::vector<const Parameter*> all;
  for (const Effect& e : catalogue()) {
    for (const EffectNumber& n : e.numbers) all.push_back(&n.parameter);
  }
  for (const Parameter& p : construction_numbers()) all.push_back(&p);
  const auto place = [](const Parameter* p) {
    return std::find(std::begin(order_in_messages), std::end(order_in_messages), p->key);
  };
  std::stable_sort(all.begin(), all.end(),
                   [&](const Parameter* a, const Parameter* b) { return place(a) < place(b); });
  return all;
}

}  // namespace

const std::vector<Effect>& catalogue() {
#define SNARE_CALL(name) name##_effect(),
  static const std::vector<Effect> all{SNARE_EFFECTS(SNARE_CALL)};
#undef SNARE_CALL
  return all;
}

const Effect* find_effect(std::string_view name) {
  const auto& all = catalogue();
  const auto at = std::find_if(all.begin(), all.end(), [name](const Effect& e) { return e.name == name; });
  return at == all.end() ? nullptr : &*at;
}

const ParameterSet& parameters() {
  static const ParameterSet all(numbers_of_all());
  return all;
}

}  // namespace snare::identification
