#include "identification/effects/effect.hpp"

#include <algorithm>

namespace snare::identification {

std::string to_string(Channel channel) {
  switch (channel) {
    case Channel::wire: return "wire";
    case Channel::mount: return "mount";
    case Channel::contact: return "contact";
    case Channel::pusher: return "pusher";
    case Channel::sensor: return "sensor";
    case Channel::geometry: return "geometry";
  }
  return "unknown";
}

const std::vector<Effect>& catalogue() {
  static const std::vector<Effect> all{
      bending_stiffness_effect(),     axial_stiffness_effect(),
      wire_length_effect(),           span_effect(),
      contact_position_effect(),      push_misalignment_effect(),
      mount_slip_effect(),            mount_axial_compliance_effect(),
      mount_rotational_compliance_effect(), contact_friction_effect(),
      pusher_compliance_effect(),     displacement_offset_effect(),
      force_offset_effect(),          force_gain_effect(),
      natural_curvature_effect(),     strand_hysteresis_effect(),
      plasticity_effect(),            gravity_effect(),
      rate_viscosity_effect()};
  return all;
}

const Effect* find_effect(std::string_view name) {
  const auto& all = catalogue();
  const auto at = std::find_if(all.begin(), all.end(), [name](const Effect& e) { return e.name == name; });
  return at == all.end() ? nullptr : &*at;
}

std::string needs_mounts(const std::vector<Series>& series) {
  for (const Series& s : series) {
    if (s.test.mount.kind != wire::MountKind::supports) return "";
  }
  return "a wire that rests on supports is not held by mounts";
}

}  // namespace snare::identification
