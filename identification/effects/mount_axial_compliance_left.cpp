#include "identification/effects/mount_compliance.hpp"

namespace snare::identification {

/// The left mount alone gives along the chord like a spring.
Effect mount_axial_compliance_left_effect() {
  Parameter compliance = axial_compliance_of<0>();
  compliance.key = "mount_axial_compliance_left.compliance_m_N";
  compliance.unit = "m/N";
  return {.name = "mount_axial_compliance_left",
          .channel = Channel::mount,
          .meaning = "the left mount gives way along the wire",
          .numbers = {{compliance, 0.0, 1e-4}},
          .one_sided = true,
          .sizes = sizes_beside_stretching,
          .unobservable = needs_mounts,
          .independent_check = "put a dial gauge against the left mount and read how it moves under tension"};
}

}  // namespace snare::identification
