#include "identification/effects/mount_compliance.hpp"

namespace snare::identification {

/// The left clamp alone gives in rotation like a spring.
Effect mount_rotational_compliance_left_effect() {
  Parameter compliance = rotational_compliance_of<0>();
  compliance.key = "mount_rotational_compliance_left.compliance_rad_Nm";
  compliance.unit = "rad/(N m)";
  return {.name = "mount_rotational_compliance_left",
          .channel = Channel::mount,
          .meaning = "the left clamp turns with the wire",
          .numbers = {{compliance, 0.0, 1000.0}},
          .one_sided = true,
          .sizes = sizes_beside_bending,
          .unobservable = needs_clamps,
          .independent_check = "glue a small mirror or pointer on the left clamp and read its rotation"};
}

}  // namespace snare::identification
