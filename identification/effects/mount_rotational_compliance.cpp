#include "identification/effects/effect.hpp"

namespace snare::identification {

namespace {

/// Of each clamp.
Parameter rotational_compliance() {
  return {.key = "mount_rotational_compliance.compliance_rad_Nm",
          .unit = "rad/(N m)",
          .number = {[](const PushProblem& p, const ReadingModel&) { return compliance(p.mount.rotational_stiffness); },
                     [](PushProblem& p, ReadingModel&, double v) { set_compliance(p.mount.rotational_stiffness, v); }},
          .limits = [](const PushProblem&) { return between(0.0, 10.0); },
          .step = 1e-6};
}

std::string needs_clamps(const std::vector<Series>& series) {
  for (const Series& s : series) {
    if (s.test.wire.yielding || s.test.wire.strand_friction) {
      return "clamps that give are not computed together with sections that slip or yield";
    }
  }
  for (const Series& s : series) {
    if (s.test.mount.kind == wire::MountKind::clamped) return "";
  }
  return "only clamps hold the wire's direction";
}

}  // namespace

/// Both clamps give in rotation like springs.
Effect mount_rotational_compliance_effect() {
  return {.name = "mount_rotational_compliance",
          .channel = Channel::mount,
          .meaning = "the clamps turn with the wire",
          .numbers = {{rotational_compliance(), 0.0, 10.0}},
          .one_sided = true,
          .unobservable = needs_clamps,
          .independent_check = "glue a small mirror or pointer on a clamp and read its rotation"};
}

}  // namespace snare::identification
