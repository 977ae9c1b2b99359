#include "identification/effects/mount_compliance.hpp"

namespace snare::identification {

namespace {

/// Of each clamp.
Parameter rotational_compliance() {
  return {
      .key = "mount_rotational_compliance.compliance_rad_Nm",
      .unit = "rad/(N m)",
      .number = {
          [](const PushProblem& p, const ReadingModel&) { return compliance(p.mount.rotational_stiffness); },
          [](PushProblem& p, ReadingModel&, double v) { set_compliance(p.mount.rotational_stiffness, v); }},
      .limits = limits_in_rotation,
      .step = 1e-6};
}

}  // namespace

/// Both clamps give in rotation like springs.
Effect mount_rotational_compliance_effect() {
  return {.name = "mount_rotational_compliance",
          .channel = Channel::mount,
          .meaning = "the clamps turn with the wire",
          .numbers = {{rotational_compliance(), 0.0, 1000.0}},
          .one_sided = true,
          .sizes = sizes_beside_bending,
          .unobservable = needs_clamps,
          .independent_check = "glue a small mirror or pointer on a clamp and read its rotation"};
}

}  // namespace snare::identification
