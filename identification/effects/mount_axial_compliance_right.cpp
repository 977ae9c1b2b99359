#include "identification/effects/mount_compliance.hpp"

namespace snare::identification {

/// The right mount alone gives along the chord like a spring.
Effect mount_axial_compliance_right_effect() {
  Parameter compliance = axial_compliance_of<1>();
  compliance.key = "mount_axial_compliance_right.compliance_m_N";
  compliance.unit = "m/N";
  return {
      .name = "mount_axial_compliance_right",
      .channel = Channel::mount,
      .meaning = "the right mount gives way along the wire",
      .numbers = {{compliance, 0.0, 1e-4}},
      .one_sided = true,
      .sizes = sizes_beside_stretching,
      .unobservable = needs_mounts,
      .independent_check = "put a dial gauge against the right mount and read how it moves under tension"};
}

}  // namespace snare::identification
