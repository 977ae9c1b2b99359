#include "identification/effects/mount_compliance.hpp"

namespace snare::identification {

std::string needs_clamps(const std::vector<Series>& series) {
  for (const Series& s : series) {
    if (s.test.wire.yielding || s.test.wire.strand_friction)
      return "clamps that give are not computed together with sections that slip or yield";
  }
  for (const Series& s : series) {
    if (s.test.mount.kind == wire::MountKind::clamped) return "";
  }
  return "only clamps hold the wire's direction";
}

std::vector<double> sizes_beside_bending(const PushProblem& declared) {
  const double turn = declared.wire.length / declared.wire.bending_stiffness();
  return {0.01 * turn, 0.1 * turn, turn};
}

std::vector<double> sizes_beside_stretching(const PushProblem& declared) {
  const double stretch = declared.wire.length / declared.wire.axial_stiffness();
  return {stretch, 10.0 * stretch, 100.0 * stretch};
}

Limits limits_in_rotation(const PushProblem& declared) {
  return between(0.0, 100.0 * declared.wire.length / declared.wire.bending_stiffness());
}

Limits limits_along_chord(const PushProblem& declared) {
  return between(0.0, 1000.0 * declared.wire.length / declared.wire.axial_stiffness());
}

}  // namespace snare::identification
