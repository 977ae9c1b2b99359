#include "identification/effects/effect.hpp"

namespace snare::identification {

namespace {

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
  Effect e;
  e.name = "mount_rotational_compliance";
  e.channel = Channel::mount;
  e.meaning = "the clamps turn with the wire";
  e.numbers = {{"mount_rotational_compliance.compliance_rad_Nm", 0.0, 10.0}};
  e.one_sided = true;
  e.unobservable = needs_clamps;
  e.independent_check = "glue a small mirror or pointer on a clamp and read its rotation";
  return e;
}

}  // namespace snare::identification
