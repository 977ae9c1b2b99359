#include "identification/effects/effect.hpp"

namespace snare::identification {

namespace {

/// Of each mount along the chord.
Parameter axial_compliance() {
  return {
      .key = "mount_axial_compliance.compliance_m_N",
      .unit = "m/N",
      .number = {[](const PushProblem& p, const ReadingModel&) { return compliance(p.mount.translational_stiffness); },
                 [](PushProblem& p, ReadingModel&, double v) { set_compliance(p.mount.translational_stiffness, v); }},
      .limits = [](const PushProblem&) { return between(0.0, 1e-3); },
      .step = 1e-12,
      .mount_gives = true};
}

}  // namespace

/// Both mounts give along the chord like springs.
Effect mount_axial_compliance_effect() {
  return {.name = "mount_axial_compliance",
          .channel = Channel::mount,
          .meaning = "the mounts give way along the wire",
          .numbers = {{axial_compliance(), 0.0, 1e-4}},
          .one_sided = true,
          .unobservable = needs_mounts,
          .independent_check = "put a dial gauge between the mounts and read their approach under tension"};
}

}  // namespace snare::identification
