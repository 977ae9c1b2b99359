#include "identification/effects/mount_compliance.hpp"

namespace snare::identification {

/// The right clamp alone gives in rotation like a spring.
Effect mount_rotational_compliance_right_effect() {
  Parameter compliance = rotational_compliance_of<1>();
  compliance.key = "mount_rotational_compliance_right.compliance_rad_Nm";
  compliance.unit = "rad/(N m)";
  return {.name = "mount_rotational_compliance_right",
          .channel = Channel::mount,
          .meaning = "the right clamp turns with the wire",
          .numbers = {{compliance, 0.0, 1000.0}},
          .one_sided = true,
          .sizes = sizes_beside_bending,
          .unobservable = needs_clamps,
          .independent_check = "glue a small mirror or pointer on the right clamp and read its rotation"};
}

}  // namespace snare::identification
