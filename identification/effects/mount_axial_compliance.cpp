#include "identification/effects/effect.hpp"

namespace snare::identification {

/// Both mounts give along the chord like springs.
Effect mount_axial_compliance_effect() {
  Effect e;
  e.name = "mount_axial_compliance";
  e.channel = Channel::mount;
  e.meaning = "the mounts give way along the wire";
  e.numbers = {{"mount_axial_compliance.compliance_m_N", 0.0, 1e-4}};
  e.one_sided = true;
  e.unobservable = needs_mounts;
  e.independent_check = "put a dial gauge between the mounts and read their approach under tension";
  return e;
}

}  // namespace snare::identification
